//! A convention of quality with all its numbers.

use serde::{Deserialize, Serialize};

/// Tolerance of round cones in files that do not state it.
const OLDER_TOLERANCE: f64 = 1e-4;

/// A convention of quality: all rules and numbers that determine the quality of contacts.
///
/// In JSON `edges` is the number of edges of the friction pyramid, or `null` for the round cone;
/// `tolerance` is then the width that its intervals may have. `tangent` is `least_aligned` or
/// `projected`, the latter with the vector `tangent_axis`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Keys", into = "Keys")]
pub struct ConventionRecord {
    /// Its name.
    pub name: String,
    /// Normalisation of the edges of a friction cone.
    pub edge_norm: EdgeNormRecord,
    /// The length that divides torques, metres; `None` if the convention takes the largest distance
    /// of a contact from the centre.
    pub torque_length_m: Option<f64>,
    /// The point about which torques are taken.
    pub centre: CentreRecord,
    /// Friction coefficient μ.
    pub friction: f64,
    /// How a friction cone is represented.
    pub edges: EdgesRecord,
    /// The value reported for grasps that are not closed.
    pub not_closed: f64,
    /// The rule for the first edge of each friction pyramid.
    pub tangent: TangentRecord,
    /// Quality above which a grasp is stable; version 2.
    pub stable_above: Option<f64>,
    /// What a contact transmits besides friction; `None` for point contacts. Version 2.
    pub contact: Option<ContactModelRecord>,
}

/// A contact with a size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum ContactModelRecord {
    /// A soft finger: a disc under even pressure.
    Soft {
        /// Radius of the disc.
        radius_m: f64,
    },
    /// A stiff square pad.
    Patch {
        /// Distance of each corner from the contact.
        radius_m: f64,
    },
}

/// Normalisation of the edges of a friction cone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeNormRecord {
    /// The component along the normal is 1.
    UnitNormalComponent,
    /// The edge itself has length 1.
    UnitLength,
}

/// The point about which torques are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CentreRecord {
    /// The mean of the cloud.
    CloudMean,
    /// The centroid of the enclosed solid.
    CentreOfMass,
    /// The origin of the frame of the cloud.
    ObjectOrigin,
    /// A point given with each grasp.
    Given,
}

/// How a friction cone is represented.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgesRecord {
    /// A pyramid with this number of edges.
    Polygon(usize),
    /// The round cone.
    Round {
        /// Width at which the search for the quality may stop, in units of quality.
        tolerance: f64,
    },
}

/// The rule for the first edge of each friction pyramid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TangentRecord {
    /// Along the projection of the coordinate axis least aligned with the normal.
    LeastAligned,
    /// Along the projection of this vector.
    Projected([f64; 3]),
}

/// The keys of the file.
#[derive(Clone, Serialize, Deserialize)]
struct Keys {
    name: String,
    edge_norm: EdgeNormRecord,
    torque_length_m: Option<f64>,
    centre: CentreRecord,
    friction: f64,
    edges: Option<usize>,
    #[serde(default)]
    tolerance: Option<f64>,
    not_closed: f64,
    #[serde(default)]
    tangent: TangentName,
    #[serde(default)]
    tangent_axis: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    stable_above: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    contact: Option<ContactModelRecord>,
}

/// The default is the value of files that lack the key.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum TangentName {
    #[default]
    LeastAligned,
    Projected,
}

impl TryFrom<Keys> for ConventionRecord {
    type Error = &'static str;

    fn try_from(keys: Keys) -> Result<Self, Self::Error> {
        let tangent = match (keys.tangent, keys.tangent_axis) {
            (TangentName::LeastAligned, _) => TangentRecord::LeastAligned,
            (TangentName::Projected, Some(axis)) => TangentRecord::Projected(axis),
            (TangentName::Projected, None) => {
                return Err("`tangent` is `projected`; expected a vector `tangent_axis` beside it");
            }
        };
        let edges = match keys.edges {
            Some(count) => EdgesRecord::Polygon(count),
            None => EdgesRecord::Round {
                tolerance: keys.tolerance.unwrap_or(OLDER_TOLERANCE),
            },
        };
        Ok(Self {
            name: keys.name,
            edge_norm: keys.edge_norm,
            torque_length_m: keys.torque_length_m,
            centre: keys.centre,
            friction: keys.friction,
            edges,
            not_closed: keys.not_closed,
            tangent,
            stable_above: keys.stable_above,
            contact: keys.contact,
        })
    }
}

impl From<ConventionRecord> for Keys {
    fn from(record: ConventionRecord) -> Self {
        let (edges, tolerance) = match record.edges {
            EdgesRecord::Polygon(count) => (Some(count), None),
            EdgesRecord::Round { tolerance } => (None, Some(tolerance)),
        };
        let (tangent, tangent_axis) = match record.tangent {
            TangentRecord::LeastAligned => (TangentName::LeastAligned, None),
            TangentRecord::Projected(axis) => (TangentName::Projected, Some(axis)),
        };
        Self {
            name: record.name,
            edge_norm: record.edge_norm,
            torque_length_m: record.torque_length_m,
            centre: record.centre,
            friction: record.friction,
            edges,
            tolerance,
            not_closed: record.not_closed,
            tangent,
            tangent_axis,
            stable_above: record.stable_above,
            contact: record.contact,
        }
    }
}
