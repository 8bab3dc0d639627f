//! `grasps.json`: ranked grasps on one object, in the frame of the user's cloud.

use std::collections::BTreeMap;

use grasp::{CentreRule, Convention, EdgeNorm, Edges, TangentRule, TorqueLength};
use serde::{Deserialize, Serialize};

/// Version of the layout of `grasps.json`; additions with a default leave it as it is.
pub const GRASPS_VERSION: u32 = 1;

/// Why a text is no `grasps.json`.
#[derive(Debug, thiserror::Error)]
pub enum GraspsFileError {
    /// Not JSON, or not with these keys.
    #[error("not a grasps.json: {0}")]
    Json(#[from] serde_json::Error),
    /// Written by another version of the format.
    #[error("a grasps.json of version {found}; this program reads version {GRASPS_VERSION}")]
    Version {
        /// Version found.
        found: u32,
    },
}

/// The whole file. Lengths in metres, angles in radians, everything in the frame of the cloud.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraspsFile {
    /// [`GRASPS_VERSION`].
    pub version: u32,
    /// The object.
    pub object: ObjectRecord,
    /// How quality was measured.
    pub convention: ConventionRecord,
    /// Grasps by rank, the best first.
    pub grasps: Vec<GraspRecord>,
}

/// The object that is grasped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObjectRecord {
    /// Name of the object or of its cloud.
    pub name: String,
    /// Mean of the cloud.
    pub centre_m: [f64; 3],
    /// No point of the surface is nearer to the centre.
    pub r_min_certified_m: f64,
    /// No point of the surface is farther from the centre.
    pub r_max_certified_m: f64,
    /// Centroid of the enclosed solid.
    pub centre_of_mass_m: [f64; 3],
    /// Volume of the enclosed solid, cubic metres.
    pub volume_m3: f64,
}

/// A convention of quality, spelled out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConventionRecord {
    /// Its name.
    pub name: String,
    /// `unit_normal_component` or `unit_length`.
    pub edge_norm: String,
    /// The length that divides torques, metres; absent where the convention takes the largest
    /// distance of a contact from the centre.
    pub torque_length_m: Option<f64>,
    /// `cloud_mean`, `centre_of_mass`, `object_origin` or `given`.
    pub centre: String,
    /// Friction coefficient μ.
    pub friction: f64,
    /// Edges of the friction pyramid; absent for the round cone.
    pub edges: Option<usize>,
    /// What is reported for grasps that are not force-closed.
    pub not_closed: f64,
    /// Where the first edge of each pyramid points, as a projection onto the tangent plane:
    /// `least_aligned`, of the coordinate axis least aligned with the normal, or `projected`, of
    /// `tangent_axis`.
    #[serde(default = "least_aligned")]
    pub tangent: String,
    /// The projected vector, for `projected`.
    #[serde(default)]
    pub tangent_axis: Option<[f64; 3]>,
}

/// The rule of files from before the rule was written down.
fn least_aligned() -> String {
    "least_aligned".to_owned()
}

/// One grasp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraspRecord {
    /// 1 for the best.
    pub rank: usize,
    /// Quality under the file's convention.
    pub quality: f64,
    /// Contact points.
    pub contacts_m: Vec<[f64; 3]>,
    /// Unit normals at the contacts, into the object.
    pub inward_normals: Vec<[f64; 3]>,
    /// Where the grasp comes from.
    pub source: SourceRecord,
    /// How a hand takes it; null where no hand has been fitted to the contacts.
    pub hand: Option<HandRecord>,
}

/// Where a grasp comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SourceRecord {
    /// `transfer` or `synthesis`.
    pub kind: String,
    /// The library object, for a transfer.
    pub from: Option<String>,
    /// Distance of the library object's shape, metres, for a transfer.
    pub shape_distance_m: Option<f64>,
    /// Quality of the grasp on the library object, for a transfer.
    pub source_quality: Option<f64>,
}

/// A hand at a grasp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HandRecord {
    /// Name of the hand.
    pub name: String,
    /// The root link of the URDF, whose pose this is; empty in older files.
    #[serde(default)]
    pub palm_link: String,
    /// Pose of the palm in the frame of the cloud.
    pub object_from_palm: PoseRecord,
    /// Driven joints by name, radians (metres for those that slide).
    pub joints_rad: BTreeMap<String, f64>,
    /// The same before the fingers closed; empty in older files.
    #[serde(default)]
    pub pregrasp_joints_rad: BTreeMap<String, f64>,
    /// Largest distance from a contact that this hand makes to the grasp's own; 0 where the
    /// contacts are the hand's.
    pub contact_error_m: f64,
}

/// A rigid transform.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseRecord {
    /// Translation.
    pub translation_m: [f64; 3],
    /// Rotation as a unit quaternion, x y z w.
    pub quaternion_xyzw: [f64; 4],
}

impl From<&Convention> for ConventionRecord {
    fn from(convention: &Convention) -> Self {
        Self {
            name: convention.name.clone(),
            edge_norm: match convention.edge_norm {
                EdgeNorm::UnitNormalComponent => "unit_normal_component",
                EdgeNorm::UnitLength => "unit_length",
            }
            .to_owned(),
            torque_length_m: match convention.torque_length {
                TorqueLength::Metres(length) => Some(length),
                TorqueLength::MaxContactDistance => None,
            },
            centre: match convention.centre {
                CentreRule::CloudMean => "cloud_mean",
                CentreRule::CentreOfMass => "centre_of_mass",
                CentreRule::ObjectOrigin => "object_origin",
                CentreRule::Given => "given",
            }
            .to_owned(),
            friction: convention.friction,
            edges: match convention.edges {
                Edges::Polygon(count) => Some(count),
                Edges::Round { .. } => None,
            },
            not_closed: convention.not_closed,
            tangent: match convention.tangent {
                TangentRule::LeastAligned => least_aligned(),
                TangentRule::Projected(_) => "projected".to_owned(),
            },
            tangent_axis: match convention.tangent {
                TangentRule::LeastAligned => None,
                TangentRule::Projected(axis) => Some(axis.into()),
            },
        }
    }
}

impl GraspsFile {
    /// Reads the JSON text of a file of this version.
    pub fn from_json(text: &[u8]) -> Result<Self, GraspsFileError> {
        let file: Self = serde_json::from_slice(text)?;
        if file.version == GRASPS_VERSION {
            Ok(file)
        } else {
            Err(GraspsFileError::Version {
                found: file.version,
            })
        }
    }

    /// The JSON text, indented; a number that is not finite becomes `null`.
    pub fn to_json(&self) -> Result<Vec<u8>, serde_json::Error> {
        serde_json::to_vec_pretty(self)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn file() -> GraspsFile {
        let mut convention = Convention::named("frogger").unwrap();
        convention.tangent = TangentRule::Projected([1.2, 2.3, 3.4].into());
        GraspsFile {
            version: GRASPS_VERSION,
            object: ObjectRecord {
                name: "ball".to_owned(),
                centre_m: [0.1, 0.2, 0.3],
                r_min_certified_m: 0.03,
                r_max_certified_m: 0.04,
                centre_of_mass_m: [0.1, 0.2, 0.3],
                volume_m3: 1e-4,
            },
            convention: ConventionRecord::from(&convention),
            grasps: Vec::new(),
        }
    }

    #[test]
    fn comes_back_with_its_tangent_rule() {
        let read = GraspsFile::from_json(&file().to_json().unwrap()).unwrap();
        assert_eq!(read, file());
        assert_eq!(read.convention.tangent, "projected");
        assert_eq!(read.convention.tangent_axis, Some([1.2, 2.3, 3.4]));
    }

    #[test]
    fn files_from_before_the_tangent_rule_are_read() {
        let mut value = serde_json::to_value(file()).unwrap();
        let convention = value["convention"].as_object_mut().unwrap();
        convention.remove("tangent");
        convention.remove("tangent_axis");
        let read = GraspsFile::from_json(value.to_string().as_bytes()).unwrap();
        assert_eq!(read.convention.tangent, "least_aligned");
        assert_eq!(read.convention.tangent_axis, None);
    }

    #[test]
    fn another_version_is_refused() {
        let newer = GraspsFile {
            version: 2,
            ..file()
        };
        assert!(matches!(
            GraspsFile::from_json(&newer.to_json().unwrap()),
            Err(GraspsFileError::Version { found: 2 })
        ));
        assert!(matches!(
            GraspsFile::from_json(b"{}"),
            Err(GraspsFileError::Json(_))
        ));
    }
}
