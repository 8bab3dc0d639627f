//! The library of known objects: fitted shapes with their best grasps.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, UnitVector3, Vector3};
use serde::{Deserialize, Serialize};

use crate::envelope::{self, EnvelopeError, Kind};
use crate::shape_record::ShapeRecord;

/// The objects from which grasps are transferred.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LibraryRecord {
    /// Seed from which it was built.
    pub seed: u64,
    /// Name of the convention under which the grasps were ranked.
    pub convention: String,
    /// Name of the hand that made the grasps.
    pub hand: String,
    /// The objects, in the order of the catalogue.
    pub entries: Vec<LibraryEntry>,
}

/// One known object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LibraryEntry {
    /// Short identifier, such as `S5`.
    pub id: String,
    /// Readable name, such as "shampoo bottle".
    pub name: String,
    /// Its surface.
    pub shape: ShapeRecord,
    /// Its best grasps, the best first.
    pub grasps: Vec<LibraryGrasp>,
}

/// A grasp that the hand can make on its object, in the centred frame of that object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LibraryGrasp {
    /// Unit vectors from the origin towards the contacts: the point of (S²)^m.
    pub directions: Vec<[f64; 3]>,
    /// Quality under the library's convention.
    pub quality: f64,
    /// Position of the palm in the centred frame, metres.
    pub palm_translation_m: [f64; 3],
    /// Orientation of the palm in the centred frame, x y z w.
    pub palm_quaternion_xyzw: [f64; 4],
    /// Joint values in the order of the hand's driven joints: radians, or metres for prismatic
    /// joints.
    pub joints_rad: Vec<f64>,
}

/// One known object in its own file, as in a user's library folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LibraryObjectRecord {
    /// Digest of all inputs that the object was made from: equal digests give equal objects.
    pub made_from: String,
    /// The library that holds this one object.
    pub library: LibraryRecord,
}

impl LibraryObjectRecord {
    /// The bytes of the file.
    ///
    /// # Errors
    /// The record cannot be encoded, or is larger than 256 MiB.
    pub fn to_bytes(&self) -> Result<Vec<u8>, EnvelopeError> {
        envelope::encode(Kind::LibraryObject, self)
    }

    /// Reads the bytes of such a file; the numbers in it are not checked.
    ///
    /// # Errors
    /// The bytes are not a file of this kind of a version that is read, or are damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, EnvelopeError> {
        envelope::decode(Kind::LibraryObject, bytes)
    }
}

impl LibraryGrasp {
    /// Pose of the palm in the centred frame.
    ///
    /// A quaternion of length zero gives the identity rotation.
    pub fn centred_from_palm(&self) -> Isometry3<f64> {
        let [x, y, z, w] = self.palm_quaternion_xyzw;
        let turn = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9);
        Isometry3::from_parts(
            Translation3::from(Vector3::from(self.palm_translation_m)),
            turn.unwrap_or_else(UnitQuaternion::identity),
        )
    }

    /// The directions of the contacts; `None` if the length of a stored vector differs from 1 by
    /// more than 1e-6.
    pub fn directions(&self) -> Option<Vec<UnitVector3<f64>>> {
        self.directions
            .iter()
            .map(|&v| {
                let (direction, length) = UnitVector3::try_new_and_get(Vector3::from(v), 0.5)?;
                ((length - 1.0).abs() <= 1e-6).then_some(direction)
            })
            .collect()
    }
}

impl LibraryRecord {
    /// The bytes of a library file.
    ///
    /// # Errors
    /// The record cannot be encoded, or is larger than 256 MiB.
    pub fn to_bytes(&self) -> Result<Vec<u8>, EnvelopeError> {
        envelope::encode(Kind::Library, self)
    }

    /// Reads the bytes of a library file; the numbers in it are not checked.
    ///
    /// # Errors
    /// The bytes are not a library file of a version that is read, or are damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, EnvelopeError> {
        envelope::decode(Kind::Library, bytes)
    }
}
