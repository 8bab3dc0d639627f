//! A surface over the sphere as it is stored.

use serde::{Deserialize, Serialize};

use crate::envelope::{self, EnvelopeError, Kind};
use crate::shape_record::ShapeNotes;

/// A map of the sphere into space, and the position of its cloud.
///
/// The surface is f = (x, y, z) in the centred frame, each coordinate Σ β_{l,m} Y_{l,m}(p) with real
/// orthonormal harmonics without the Condon–Shortley phase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SphericalRecord {
    /// Name of the object or of its cloud.
    pub name: String,
    /// β_{l,m} of x, y and z at position l² + l + m, metres; all of one degree.
    pub coordinates: [Vec<f64>; 3],
    /// Origin of the centred frame in the frame of the cloud, metres.
    pub centre_in_cloud_m: [f64; 3],
    /// Penalty λ of the fit of x, y and z; 0 for a fit without a penalty.
    pub lambda: [f64; 3],
    /// Root mean square of the distances |f(pᵢ) − xᵢ|, metres.
    pub rms_m: f64,
    /// Number of points fitted.
    pub points: u64,
    /// What else is known of the object. It follows the shape in a file of version 2.
    #[serde(skip)]
    pub notes: ShapeNotes,
    /// Parts of the surface that close holes of the object. They follow the notes.
    #[serde(skip)]
    pub closed_holes: Vec<ClosedHoleRecord>,
}

/// A part of a surface that closes a hole of the object, such as that of a handle: no contact belongs
/// there, and no finger passes through it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClosedHoleRecord {
    /// Points of the middle of the closing slab, in the frame of the cloud, metres.
    pub places_m: Vec<[f64; 3]>,
    /// Points of the surface within this distance of one of the places belong to the part, metres.
    pub reach_m: f64,
    /// Area of one side, m².
    pub area_m2: f64,
}

impl SphericalRecord {
    /// The bytes of a file of this shape.
    ///
    /// # Errors
    /// The record cannot be encoded, or is larger than 256 MiB.
    pub fn to_bytes(&self) -> Result<Vec<u8>, EnvelopeError> {
        envelope::encode(Kind::Spherical, &(self, &self.notes, &self.closed_holes))
    }

    /// Reads the bytes of a file of this shape.
    ///
    /// The coefficients are not checked: they may have the wrong number, be NaN, or describe a map
    /// that is not an immersion.
    ///
    /// # Errors
    /// The bytes are not a spherical shape of a version that is read, or are damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, EnvelopeError> {
        if envelope::version_of(bytes) == Some(1) {
            return envelope::decode_version(Kind::Spherical, 1, bytes);
        }
        let (shape, notes, closed_holes): (Self, ShapeNotes, Vec<ClosedHoleRecord>) =
            envelope::decode(Kind::Spherical, bytes)?;
        Ok(Self {
            notes,
            closed_holes,
            ..shape
        })
    }
}
