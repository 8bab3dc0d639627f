//! The volume quality: the six-dimensional volume of the hull of the wrenches.

use super::epsilon::QualityError;
use crate::contact::Contact;
use crate::convention::Convention;
use crate::hull::{ConvexHull, HullError};
use crate::wrench::wrenches;
use nalgebra::Point3;

/// The volume of Conv{w_ij}, whether or not the origin lies inside; 0 when the wrenches lie in a
/// hyperplane. Costs a full hull; polygonal cones only.
pub fn volume(
    contacts: &[Contact],
    centre: &Point3<f64>,
    convention: &Convention,
) -> Result<f64, QualityError> {
    match ConvexHull::new(&wrenches(contacts, centre, convention)?) {
        Ok(hull) => Ok(hull.volume()),
        Err(HullError::Flat) => Ok(0.0),
        Err(error) => Err(QualityError::Hull(error)),
    }
}
