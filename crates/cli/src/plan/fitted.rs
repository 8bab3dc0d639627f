//! A surface to be grasped, from a cloud or from a shape file.

use std::path::Path;

use moduli::records::stored_shape;
use nalgebra::Point3;
use shape::{Fit, RadialShape};

use crate::failure::Failure;
use crate::input;

/// A surface, where its cloud stood and how well it fits.
pub(crate) struct Fitted {
    /// Centred frame.
    pub(crate) shape: RadialShape,
    /// Origin of the centred frame in the frame of the cloud, metres.
    pub(crate) centre_in_cloud: Point3<f64>,
    /// Root mean square residual, metres.
    pub(crate) rms: f64,
    /// Points that were fitted.
    pub(crate) points: usize,
}

impl Fitted {
    /// The fit of a cloud of `points` points.
    pub(crate) fn new(fit: Fit, points: usize) -> Self {
        Self {
            shape: fit.shape,
            centre_in_cloud: fit.centre_in_cloud,
            rms: fit.rms,
            points,
        }
    }

    /// A shape file, and the name that it carries.
    pub(crate) fn read(path: &Path) -> Result<(String, Self), Failure> {
        let record = input::shape_record(path)?;
        let fitted = Self {
            shape: stored_shape(&record).map_err(|e| Failure::input(path, e))?,
            centre_in_cloud: record.centre_in_cloud(),
            rms: record.rms_m,
            points: record.points as usize,
        };
        Ok((record.name, fitted))
    }

    /// Origin of the user's frame in the centred frame.
    pub(crate) fn object_origin(&self) -> Point3<f64> {
        Point3::from(-self.centre_in_cloud.coords)
    }
}
