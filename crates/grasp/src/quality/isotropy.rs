//! Qualities of the grasp map, the linear map from contact forces to wrenches.

use crate::grasp_model::GraspModel;
use crate::wrench::{WrenchError, wrench};
use nalgebra::{DMatrix, Matrix3};

/// The smallest singular value of the grasp map G: R³ᵐ → R⁶, (f_1 … f_m) ↦ Σ wrench(f_i).
///
/// In the torque length of the convention; friction plays no part. Zero where some wrench cannot be
/// made by contact forces at all.
pub fn smallest_singular_value(model: &GraspModel<'_>) -> Result<f64, WrenchError> {
    let length = model.validate()?;
    let identity = Matrix3::identity();
    let mut map = DMatrix::zeros(6, 3 * model.contacts.len());
    for (i, contact) in model.contacts.iter().enumerate() {
        for axis in 0..3 {
            let force = identity.column(axis).into_owned();
            let column = wrench(&force, &contact.position, model.centre, length);
            map.set_column(3 * i + axis, &column);
        }
    }
    Ok(map.singular_values().min())
}
