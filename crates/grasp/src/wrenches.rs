//! The wrenches of all friction edges of a grasp.

use nalgebra::{UnitVector3, Vector3};

use crate::convention::Edges;
use crate::friction::cone_edges_from;
use crate::grasp_model::GraspModel;
use crate::wrench::{Wrench, WrenchError, wrench};

/// The wrenches of all edges of all contacts, contact by contact, edge by edge.
///
/// m·k wrenches for m point contacts and k edges; a patch has those of its four points in turn. A contact without friction has one edge; a soft
/// contact has two more wrenches, edges + 1 and + 2 of its contact, which are its normal force with
/// the largest torsion of either sign.
///
/// # Errors
/// Round cones have no finite list of wrenches and are refused.
pub fn wrenches(model: &GraspModel<'_>) -> Result<Vec<Wrench>, WrenchError> {
    list(model, |contact| {
        let rule = &model.convention.tangent;
        rule.tangent(&model.contacts[contact].inward_normal)
    })
}

/// The same with the tangent of each contact given, for data that carries its own frames.
///
/// # Errors
/// As [`wrenches`], and if there is another number of tangents than of contacts.
pub fn wrenches_with_tangents(
    model: &GraspModel<'_>,
    tangents: &[UnitVector3<f64>],
) -> Result<Vec<Wrench>, WrenchError> {
    if tangents.len() != model.contacts.len() {
        return Err(WrenchError::Tangents {
            contacts: model.contacts.len(),
            tangents: tangents.len(),
        });
    }
    list(model, |contact| tangents[contact])
}

fn list(
    model: &GraspModel<'_>,
    tangent_of: impl Fn(usize) -> UnitVector3<f64>,
) -> Result<Vec<Wrench>, WrenchError> {
    let length = model.validate()?;
    let Edges::Polygon(count) = model.convention.edges else {
        return Err(WrenchError::RoundCone);
    };
    let mut out = Vec::with_capacity(model.contacts.len() * count);
    for (index, contact) in model.contacts.iter().enumerate() {
        let (friction, torsion) = model.contact_model(index).limits();
        let edges = cone_edges_from(
            &contact.inward_normal,
            &tangent_of(index),
            friction,
            if friction > 0.0 { count } else { 1 },
            model.convention.edge_norm,
        );
        let of_force = |f: &Vector3<f64>| wrench(f, &contact.position, model.centre, length);
        let contact_model = model.contact_model(index);
        if contact_model.points() > 1 {
            let t = tangent_of(index).into_inner();
            let b = contact.inward_normal.cross(&t);
            for point in 0..contact_model.points() {
                let [along, across] = contact_model.place(point);
                let position = contact.position + t * along + b * across;
                out.extend(
                    edges
                        .clone()
                        .map(|f| wrench(&f, &position, model.centre, length)),
                );
            }
            continue;
        }
        out.extend(edges.map(|f| of_force(&f)));
        if torsion > 0.0 {
            let n = contact.inward_normal.into_inner() * model.edge_scale(index);
            let twist = n * (torsion / length);
            let twist = Wrench::new(0.0, 0.0, 0.0, twist.x, twist.y, twist.z);
            out.extend([of_force(&n) + twist, of_force(&n) - twist]);
        }
    }
    Ok(out)
}
