//! `grasps.json`: ranked grasps on one object, in the frame of the user's cloud.

use std::collections::BTreeMap;

use grasp::{CentreRule, Convention, EdgeNorm, Edges, TorqueLength};
use serde::{Deserialize, Serialize};

/// Version of the layout of `grasps.json`.
pub const GRASPS_VERSION: u32 = 1;

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
    /// Pose of the palm, the root link of the URDF, in the frame of the cloud.
    pub object_from_palm: PoseRecord,
    /// Driven joints by name.
    pub joints_rad: BTreeMap<String, f64>,
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
        }
    }
}
