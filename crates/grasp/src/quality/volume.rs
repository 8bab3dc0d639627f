//! The volume quality: the six-dimensional volume of the hull of the wrenches.

use super::epsilon::QualityError;
use crate::grasp_model::GraspModel;
use crate::hull::{ConvexHull, HullError};
use crate::wrenches::wrenches;

/// The volume of Conv{w_ij}, whether or not the origin lies inside; 0 when the wrenches lie in a
/// hyperplane. Costs a full hull; polygonal cones only.
pub fn volume(model: &GraspModel<'_>) -> Result<f64, QualityError> {
    match ConvexHull::new(&wrenches(model)?) {
        Ok(hull) => Ok(hull.volume()),
        Err(HullError::Flat) => Ok(0.0),
        Err(error) => Err(QualityError::Hull(error)),
    }
}
