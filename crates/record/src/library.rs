//! The library of known objects: fitted shapes with their best grasps.

use hand::HandGrasp;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};
use sph::Direction;

use crate::envelope::{self, EnvelopeError, Kind};
use crate::shape_record::ShapeRecord;

/// Everything known, as it is stored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LibraryRecord {
    /// Seed from which it was built.
    pub seed: u64,
    /// Name of the convention under which the grasps were ranked.
    pub convention: String,
    /// Name of the hand that made the grasps.
    pub hand: String,
    /// The objects, in catalogue order.
    pub entries: Vec<LibraryEntry>,
}

/// One known object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LibraryEntry {
    /// Short identity, such as S5.
    pub id: String,
    /// What it is.
    pub name: String,
    /// Its surface.
    pub shape: ShapeRecord,
    /// Its best grasps, the best first.
    pub grasps: Vec<LibraryGrasp>,
}

/// A grasp that the hand can make on its object. Centred frame of that object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LibraryGrasp {
    /// Unit vectors towards the contacts: the point of (S²)^m.
    pub directions: Vec<[f64; 3]>,
    /// Quality under the library's convention.
    pub quality: f64,
    /// Palm position in the centred object frame, metres.
    pub palm_translation_m: [f64; 3],
    /// Palm orientation in the centred object frame, x y z w.
    pub palm_quaternion_xyzw: [f64; 4],
    /// Joint values in the order of the hand's driven joints, radians.
    pub joints_rad: Vec<f64>,
}

impl LibraryGrasp {
    /// What is worth keeping of a synthesized grasp.
    pub fn of_hand_grasp(grasp: &HandGrasp) -> Self {
        let pose = &grasp.object_from_palm;
        Self {
            directions: grasp
                .directions
                .iter()
                .map(|p| p.into_inner().into())
                .collect(),
            quality: grasp.quality,
            palm_translation_m: pose.translation.vector.into(),
            palm_quaternion_xyzw: pose.rotation.coords.into(),
            joints_rad: grasp.joints.clone(),
        }
    }

    /// Pose of the palm in the centred object frame; the identity turn for a quaternion of zeros.
    pub fn object_from_palm(&self) -> Isometry3<f64> {
        let [x, y, z, w] = self.palm_quaternion_xyzw;
        let turn = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9);
        Isometry3::from_parts(
            Translation3::from(Vector3::from(self.palm_translation_m)),
            turn.unwrap_or_else(UnitQuaternion::identity),
        )
    }

    /// The contacts' directions; `None` when a stored vector is not of unit length to 1e-6.
    pub fn directions(&self) -> Option<Vec<Direction>> {
        self.directions
            .iter()
            .map(|&v| {
                let (direction, length) = Direction::try_new_and_get(Vector3::from(v), 0.5)?;
                ((length - 1.0).abs() <= 1e-6).then_some(direction)
            })
            .collect()
    }
}

impl LibraryRecord {
    /// The bytes of a library file.
    pub fn to_bytes(&self) -> Result<Vec<u8>, EnvelopeError> {
        envelope::encode(Kind::Library, self)
    }

    /// A library file read back.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, EnvelopeError> {
        envelope::decode(Kind::Library, bytes)
    }
}
