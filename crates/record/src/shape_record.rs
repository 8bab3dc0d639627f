//! A fitted shape as it is stored.

use std::collections::BTreeMap;

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use crate::envelope::{self, EnvelopeError, Kind};
use crate::grasps::SupportRecord;

/// A radius function on the sphere, and the position of its cloud.
///
/// The surface is r(p) p in the centred frame, r(p) = Σ β_{l,m} Y_{l,m}(p), with real orthonormal
/// harmonics without the Condon–Shortley phase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapeRecord {
    /// Name of the object or of its cloud.
    pub name: String,
    /// β_{l,m} at position l² + l + m, metres.
    pub coefficients: Vec<f64>,
    /// Origin of the centred frame in the frame of the cloud, metres.
    pub centre_in_cloud_m: [f64; 3],
    /// Penalty λ of the fit; 0 for a fit without a penalty.
    pub lambda: f64,
    /// Root mean square residual of the fit, metres.
    pub rms_m: f64,
    /// Number of points fitted.
    pub points: u64,
    /// What else is known of the object. It follows the shape in a shape file of version 2, and is not
    /// stored in a library.
    #[serde(skip)]
    pub notes: ShapeNotes,
}

/// What is known of an object besides its surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeNotes {
    /// The plane on which the object stands, in the frame of the cloud.
    pub support: Option<SupportRecord>,
    /// How well the surface fits its cloud, by name.
    pub residuals: BTreeMap<String, f64>,
    /// What the user should know about the surface, a sentence each.
    pub warnings: Vec<String>,
}

impl ShapeRecord {
    /// Origin of the centred frame in the frame of the cloud, metres.
    pub fn centre_in_cloud(&self) -> Point3<f64> {
        Point3::from(self.centre_in_cloud_m)
    }

    /// The bytes of a shape file.
    ///
    /// # Errors
    /// The record cannot be encoded, or is larger than 256 MiB.
    pub fn to_bytes(&self) -> Result<Vec<u8>, EnvelopeError> {
        envelope::encode(Kind::Shape, &(self, &self.notes))
    }

    /// Reads the bytes of a shape file.
    ///
    /// The coefficients are not checked: they may have the wrong number, be NaN, or describe a
    /// radius that is not positive.
    ///
    /// # Errors
    /// The bytes are not a shape file of a version that is read, or are damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, EnvelopeError> {
        if envelope::version_of(bytes) == Some(1) {
            return envelope::decode_version(Kind::Shape, 1, bytes);
        }
        let (shape, notes): (Self, ShapeNotes) = envelope::decode(Kind::Shape, bytes)?;
        Ok(Self { notes, ..shape })
    }
}
