//! Wrenches: a force and its scaled torque.

use crate::contact::ContactError;
use crate::contact_model::ContactModelError;
use crate::convention::ConventionError;
use nalgebra::{Point3, Vector3, Vector6};
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

/// Why a grasp has no wrenches.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum WrenchError {
    /// The contacts do not form a grasp.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// The convention is out of range.
    #[error(transparent)]
    Convention(#[from] ConventionError),
    /// The contact models do not fit the contacts.
    #[error(transparent)]
    ContactModel(#[from] ContactModelError),
    /// A round cone has no edges to list.
    #[error("a round friction cone has no finite list of wrenches")]
    RoundCone,
    /// Another number of uncertainties than of contacts.
    #[error("{contacts} contacts but {given} uncertainties")]
    Uncertainties {
        /// The contacts given.
        contacts: usize,
        /// The uncertainties given.
        given: usize,
    },
    /// An uncertainty that is negative, not finite, or an angle beyond π.
    #[error(
        "contact {index}: uncertain by {position} in position and {normal} rad in normal; expected numbers from 0, the angle up to pi"
    )]
    Uncertainty {
        /// The contact, from 0.
        index: usize,
        /// The distance given.
        position: f64,
        /// The angle given.
        normal: f64,
    },
    /// Another number of tangents than of contacts.
    #[error("{contacts} contacts but {tangents} tangents")]
    Tangents {
        /// The contacts given.
        contacts: usize,
        /// The tangents given.
        tangents: usize,
    },
}
