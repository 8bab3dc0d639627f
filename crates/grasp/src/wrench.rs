//! Wrenches: force and scaled torque of the friction edges of a grasp.

use crate::contact::{self, Contact, ContactError};
use crate::convention::{Convention, ConventionError, Edges};
use crate::finger::FingerError;
use crate::friction::cone_edges_from;
use nalgebra::{Point3, UnitVector3, Vector3, Vector6};
use thiserror::Error;

/// A force and its torque divided by the torque length, in this order.
pub type Wrench = Vector6<f64>;

/// The wrench (f, (c − z) × f / length) of a force at a position c about the centre z.
pub fn wrench(
    force: &Vector3<f64>,
    position: &Point3<f64>,
    centre: &Point3<f64>,
    length: f64,
) -> Wrench {
    let torque = (position - centre).cross(force) / length;
    Wrench::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
}

/// The wrenches of all edges of all contacts, contact by contact, edge by edge.
///
/// m·k wrenches for m contacts and k edges. Round cones have no finite list and are refused.
pub fn wrenches(
    contacts: &[Contact],
    centre: &Point3<f64>,
    convention: &Convention,
) -> Result<Vec<Wrench>, WrenchError> {
    let mut out = Vec::new();
    wrenches_into(contacts, centre, convention, &mut out)?;
    Ok(out)
}

/// The same into a caller-owned buffer, which is cleared first.
pub fn wrenches_into(
    contacts: &[Contact],
    centre: &Point3<f64>,
    convention: &Convention,
    out: &mut Vec<Wrench>,
) -> Result<(), WrenchError> {
    fill(contacts, centre, convention, out, |contact| {
        convention.tangent.tangent(&contacts[contact].inward_normal)
    })
}

/// The same with the tangent of each contact given, for data that carries its own frames.
pub fn wrenches_with_tangents(
    contacts: &[Contact],
    tangents: &[UnitVector3<f64>],
    centre: &Point3<f64>,
    convention: &Convention,
) -> Result<Vec<Wrench>, WrenchError> {
    if tangents.len() != contacts.len() {
        return Err(WrenchError::Tangents {
            contacts: contacts.len(),
            tangents: tangents.len(),
        });
    }
    let mut out = Vec::new();
    fill(contacts, centre, convention, &mut out, |contact| {
        tangents[contact]
    })?;
    Ok(out)
}

fn fill(
    contacts: &[Contact],
    centre: &Point3<f64>,
    convention: &Convention,
    out: &mut Vec<Wrench>,
    tangent_of: impl Fn(usize) -> UnitVector3<f64>,
) -> Result<(), WrenchError> {
    contact::validate(contacts, centre)?;
    convention.validate()?;
    let Edges::Polygon(count) = convention.edges else {
        return Err(WrenchError::RoundCone);
    };
    let length = convention.torque_length.resolve(contacts, centre)?;
    out.clear();
    for (index, contact) in contacts.iter().enumerate() {
        let edges = cone_edges_from(
            &contact.inward_normal,
            &tangent_of(index),
            convention.friction,
            count,
            convention.edge_norm,
        );
        out.extend(edges.map(|f| wrench(&f, &contact.position, centre, length)));
    }
    Ok(())
}

/// Why a grasp has no wrenches.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum WrenchError {
    /// The contacts do not form a grasp.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// The convention is out of range.
    #[error(transparent)]
    Convention(#[from] ConventionError),
    /// The fingers do not fit the contacts.
    #[error(transparent)]
    Finger(#[from] FingerError),
    /// A round cone has no edges to list.
    #[error("a round friction cone has no finite list of wrenches")]
    RoundCone,
    /// Another number of tangents than of contacts.
    #[error("{contacts} contacts but {tangents} tangents")]
    Tangents {
        /// The contacts given.
        contacts: usize,
        /// The tangents given.
        tangents: usize,
    },
}
