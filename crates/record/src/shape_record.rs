//! A fitted shape as it is stored.

use nalgebra::Point3;
use serde::{Deserialize, Serialize};
use shape::{Fit, RadialError, RadialShape};
use sph::{Coefficients, CoefficientsError};

use crate::envelope::{self, EnvelopeError, Kind};

/// A member of M^rad and where its cloud stood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapeRecord {
    /// Name of the object or of its cloud.
    pub name: String,
    /// β at position l²+l+m, metres.
    pub coefficients: Vec<f64>,
    /// Origin of the centred frame in the frame of the cloud, metres.
    pub centre_in_cloud_m: [f64; 3],
    /// λ of the fit; 0 without a penalty.
    pub lambda: f64,
    /// Root mean square residual of the fit, metres.
    pub rms_m: f64,
    /// Number of points fitted.
    pub points: u64,
}

/// Why a stored shape is not one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeRecordError {
    /// The bytes are not a shape record.
    #[error(transparent)]
    Envelope(#[from] EnvelopeError),
    /// The numbers are no coefficient vector.
    #[error(transparent)]
    Coefficients(#[from] CoefficientsError),
    /// The radius is not positive.
    #[error(transparent)]
    Radial(#[from] RadialError),
    /// The centre is not finite.
    #[error("the centre of the stored shape is not finite")]
    Centre,
}

impl ShapeRecord {
    /// What is worth keeping of a fit of `points` points.
    pub fn of_fit(name: &str, fit: &Fit, points: usize) -> Self {
        Self {
            name: name.to_owned(),
            coefficients: fit.shape.coefficients().as_slice().to_vec(),
            centre_in_cloud_m: fit.centre_in_cloud.into(),
            lambda: fit.lambda,
            rms_m: fit.rms,
            points: points as u64,
        }
    }

    /// β, checked.
    pub fn coefficients(&self) -> Result<Coefficients, ShapeRecordError> {
        Ok(Coefficients::new(self.coefficients.clone())?)
    }

    /// The shape, certified anew: a stored claim is not a proof.
    pub fn shape(&self) -> Result<RadialShape, ShapeRecordError> {
        if !self.centre_in_cloud_m.iter().all(|x| x.is_finite()) {
            return Err(ShapeRecordError::Centre);
        }
        Ok(RadialShape::new(self.coefficients()?)?)
    }

    /// Origin of the centred frame in the frame of the cloud, metres.
    pub fn centre_in_cloud(&self) -> Point3<f64> {
        Point3::from(self.centre_in_cloud_m)
    }

    /// The bytes of a shape file.
    pub fn to_bytes(&self) -> Result<Vec<u8>, EnvelopeError> {
        envelope::encode(Kind::Shape, self)
    }

    /// A shape file read back; [`ShapeRecord::shape`] checks the numbers.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, EnvelopeError> {
        envelope::decode(Kind::Shape, bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record() -> ShapeRecord {
        ShapeRecord {
            name: "ball".to_owned(),
            coefficients: Coefficients::constant(3, 0.04).as_slice().to_vec(),
            centre_in_cloud_m: [0.1, 0.2, 0.3],
            lambda: 1e-3,
            rms_m: 1e-4,
            points: 25_000,
        }
    }

    #[test]
    fn comes_back_and_is_certified_again() {
        let read = ShapeRecord::from_bytes(&record().to_bytes().unwrap()).unwrap();
        assert_eq!(read, record());
        assert!(read.shape().unwrap().radius_bounds().0 > 0.039);
    }

    #[test]
    fn stored_nonsense_is_refused() {
        let mut bad = record();
        bad.coefficients[2] = 1.0;
        assert!(matches!(bad.shape(), Err(ShapeRecordError::Radial(_))));
        bad.coefficients[2] = f64::NAN;
        assert!(matches!(
            bad.shape(),
            Err(ShapeRecordError::Coefficients(_))
        ));
        bad.coefficients.pop();
        assert!(matches!(
            bad.shape(),
            Err(ShapeRecordError::Coefficients(_))
        ));
        let mut lost = record();
        lost.centre_in_cloud_m[1] = f64::INFINITY;
        assert_eq!(lost.shape().unwrap_err(), ShapeRecordError::Centre);
    }
}
