//! `grasps.json`: ranked grasps on one object, in the frame of the user's cloud.
//!
//! Version 1 is written. Versions 1 and 2 are read; the keys of version 2 are optional fields, so
//! that both versions have one type. Unknown keys are ignored.

mod contact;
mod convention;
mod hand;
mod scene;
mod source;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use contact::ContactRecord;
pub use convention::{
    CentreRecord, ContactModelRecord, ConventionRecord, EdgeNormRecord, EdgesRecord, TangentRecord,
};
pub use hand::{ExecutionRecord, HandRecord, JointRecord, JointUnit, PoseRecord};
pub use scene::{DroppedRecord, PieceRecord, SceneRecord, SceneSupport, SupportOrigin};
pub use source::SourceRecord;

/// The version of `grasps.json` that is written. Keys with a default may be added without a new
/// version.
pub const GRASPS_VERSION: u32 = 2;

/// The newest version that is read.
const NEWEST_VERSION: u32 = 2;

/// Why a text is not a `grasps.json`.
#[derive(Debug, thiserror::Error)]
pub enum GraspsFileError {
    /// The text is not JSON, or a key is missing or of the wrong type.
    #[error("not a grasps.json: {0}")]
    Json(#[from] serde_json::Error),
    /// The file has a version that is not read.
    #[error("a grasps.json of version {found}; versions 1 to {NEWEST_VERSION} are read")]
    Version {
        /// Version found.
        found: u64,
    },
    /// The lists of a grasp have different lengths.
    #[error(
        "grasp {grasp} has {contacts} entries in `contacts_m` and {other} in `{key}`; expected the same number"
    )]
    Lengths {
        /// Index of the grasp in the file, from 0.
        grasp: usize,
        /// Entries of `contacts_m`.
        contacts: usize,
        /// The list that differs.
        key: &'static str,
        /// Its entries.
        other: usize,
    },
}

/// The content of a `grasps.json`: lengths in metres, angles in radians, in the frame of the cloud.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraspsFile {
    /// Version of the layout; [`GRASPS_VERSION`] when written.
    pub version: u32,
    /// The object that is grasped.
    pub object: ObjectRecord,
    /// How quality was measured.
    pub convention: ConventionRecord,
    /// Grasps by rank, the best first.
    pub grasps: Vec<GraspRecord>,
}

/// The object that is grasped.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObjectRecord {
    /// Name of the object or of its cloud.
    pub name: String,
    /// Mean of the cloud: the origin of the centred frame.
    pub centre_m: [f64; 3],
    /// Proved lower bound of the distance of the surface from the centre; 0 for a surface that is not
    /// radial, of which none is proved.
    pub r_min_certified_m: f64,
    /// Proved upper bound of the distance of the surface from the centre.
    pub r_max_certified_m: f64,
    /// Centroid of the enclosed solid.
    pub centre_of_mass_m: [f64; 3],
    /// Volume of the enclosed solid, cubic metres.
    pub volume_m3: f64,
    /// How the surface is represented; version 2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<SurfaceModel>,
    /// Holes of the object that its surface closes; version 2.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub closed_holes: Vec<HoleRecord>,
    /// How well the surface fits its cloud, by name (`rms_m`, `surface_rms_m`, …); version 2.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub residuals: BTreeMap<String, f64>,
    /// The plane on which the object stands; version 2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub support: Option<SupportRecord>,
    /// How the cloud was taken apart; version 2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<SceneRecord>,
    /// What the user should know about the object, one sentence each; version 2.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

/// A hole of an object that its surface closes, such as that of a handle. No contact is there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HoleRecord {
    /// Middle of the closing membrane, in the frame of the cloud.
    pub centre_m: [f64; 3],
    /// Area of one side, square metres.
    pub area_m2: f64,
}

/// How a surface is represented.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceModel {
    /// A radius for every direction: a member of M^rad.
    Radial,
    /// A point for every direction: a member of M^sph.
    Spherical,
}

/// The plane {x : normal · x = offset} on which an object stands, in the frame of the cloud.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SupportRecord {
    /// Unit normal, towards the object.
    pub normal: [f64; 3],
    /// Signed distance of the plane from the origin of the cloud's frame, metres.
    pub offset_m: f64,
}

/// One grasp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraspRecord {
    /// Rank, 1 for the best.
    pub rank: usize,
    /// Quality under the file's convention.
    pub quality: f64,
    /// Positions of the contacts.
    pub contacts_m: Vec<[f64; 3]>,
    /// Unit normals at the contacts, into the object.
    pub inward_normals: Vec<[f64; 3]>,
    /// Unit vectors of the contacts on the sphere of parameters: the point of (S²)^m. For a radial
    /// surface they are the directions from the object's `centre_m` to the contacts. Empty in older
    /// files.
    #[serde(default)]
    pub directions: Vec<[f64; 3]>,
    /// Origin of the grasp.
    pub source: SourceRecord,
    /// The hand of the grasp; `null` if no hand has been fitted to the contacts.
    pub hand: Option<HandRecord>,
    /// The keys of version 2.
    #[serde(flatten)]
    pub assessment: AssessmentRecord,
}

/// Numbers that say how reliable a grasp is (version 2).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AssessmentRecord {
    /// Proved lower bound of the quality.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower: Option<f64>,
    /// Proved upper bound of the quality.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper: Option<f64>,
    /// Lower bound of the quality for all surfaces that agree with the evidence at the contacts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robust_quality: Option<f64>,
    /// Predicted probability, in [0, 1], that the grasp holds when it is executed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hold: Option<f64>,
    /// The numbers from which `hold` was computed, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub hold_parts: BTreeMap<String, f64>,
    /// The contacts, each with the evidence for it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<ContactRecord>,
}

/// The version of a file, read before its other keys.
#[derive(Deserialize)]
struct VersionOnly {
    version: u64,
}

impl GraspsFile {
    /// Reads the JSON text of a file.
    ///
    /// ```
    /// let text = br#"{"version": 3}"#;
    /// let error = record::GraspsFile::from_json(text).unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "a grasps.json of version 3; versions 1 to 2 are read",
    /// );
    /// ```
    ///
    /// # Errors
    /// The text is not JSON, a key is missing or of the wrong type, the version is not read, or the
    /// lists of a grasp have different lengths.
    pub fn from_json(text: &[u8]) -> Result<Self, GraspsFileError> {
        let found = serde_json::from_slice::<VersionOnly>(text)?.version;
        if !(1..=u64::from(NEWEST_VERSION)).contains(&found) {
            return Err(GraspsFileError::Version { found });
        }
        let file: Self = serde_json::from_slice(text)?;
        for (grasp, record) in file.grasps.iter().enumerate() {
            record.check_lengths(grasp)?;
        }
        Ok(file)
    }

    /// The JSON text, indented. A number that is not finite is written as `null`.
    ///
    /// # Errors
    /// The JSON writer fails.
    pub fn to_json(&self) -> Result<Vec<u8>, serde_json::Error> {
        serde_json::to_vec_pretty(self)
    }
}

impl GraspRecord {
    /// Checks that there are as many normals as contacts, and as many directions and evidence
    /// records if there are any.
    fn check_lengths(&self, grasp: usize) -> Result<(), GraspsFileError> {
        let contacts = self.contacts_m.len();
        let optional = [
            ("directions", self.directions.len()),
            ("contacts", self.assessment.contacts.len()),
        ];
        let given = optional.into_iter().filter(|(_, count)| *count > 0);
        let mut lists = std::iter::once(("inward_normals", self.inward_normals.len())).chain(given);
        match lists.find(|(_, count)| *count != contacts) {
            Some((key, other)) => Err(GraspsFileError::Lengths {
                grasp,
                contacts,
                key,
                other,
            }),
            None => Ok(()),
        }
    }
}
