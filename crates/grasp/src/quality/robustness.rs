//! How far a grasp may move and stay closed.

use super::epsilon::{QualityError, epsilon};
use super::workspace::Workspace;
use crate::convention::TorqueLength;
use crate::grasp_model::GraspModel;
use crate::wrench::WrenchError;

/// The constant K of |Q(g) − Q(g′)| ≤ K·d(g, g′) for grasps about one centre.
///
/// K = |f| √(1 + (1+R)²/length²) with |f| the length of the longest edge, R the largest distance of a
/// contact from the centre and d the distance of Sec. III-C (`distance`). It holds for round cones,
/// and for pyramids whose frames are carried along; it supposes a fixed torque length and is None
/// under `TorqueLength::MaxContactDistance`.
pub fn lipschitz_constant(model: &GraspModel<'_>) -> Result<Option<f64>, WrenchError> {
    let length = model.validate()?;
    if model.convention.torque_length == TorqueLength::MaxContactDistance {
        return Ok(None);
    }
    let indices = 0..model.contacts.len();
    let force = indices
        .clone()
        .map(|i| model.edge_scale(i) * model.contact_model(i).limits().0.hypot(1.0))
        .fold(0.0, f64::max);
    // Torsion about the normal turns with it.
    let torsion = indices
        .map(|i| model.edge_scale(i) * model.contact_model(i).limits().1)
        .fold(0.0, f64::max);
    let radius = model
        .contacts
        .iter()
        .map(|c| (c.position - model.centre).norm())
        .fold(0.0, f64::max);
    let torque = (force * (1.0 + radius) + torsion) / length;
    Ok(Some(force.hypot(torque)))
}

/// The radius, in the distance of Sec. III-C, within which a grasp stays force-closed.
///
/// Every grasp about the same centre and nearer than Q/K is closed under round cones. 0 for an open
/// grasp; None where there is no constant (`lipschitz_constant`).
pub fn closed_radius(
    model: &GraspModel<'_>,
    workspace: &mut Workspace,
) -> Result<Option<f64>, QualityError> {
    let Some(constant) = lipschitz_constant(model)? else {
        return Ok(None);
    };
    Ok(Some(epsilon(model, workspace)?.lower / constant))
}
