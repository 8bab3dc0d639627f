//! How a cloud was taken apart.

use serde::{Deserialize, Serialize};

/// What was found in a cloud besides the object; lengths in metres, in the frame of the cloud.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneRecord {
    /// The plane on which the object stands; `null` where there is none.
    pub support: Option<SceneSupport>,
    /// Connected parts of the cloud without the support, the largest first.
    pub pieces: Vec<PieceRecord>,
    /// Rows of the cloud that are no part of the object, by reason.
    pub dropped: DroppedRecord,
}

/// The plane {x : normal · x = offset} on which an object stands, and how it is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneSupport {
    /// Unit normal, towards the object.
    pub normal: [f64; 3],
    /// Signed distance of the plane from the origin, metres.
    pub offset_m: f64,
    /// How the plane is known.
    pub source: SupportOrigin,
}

/// How a support plane is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SupportOrigin {
    /// Its points were in the cloud.
    Visible,
    /// No plane was seen: it goes through the lowest point of the object.
    Foot,
    /// The user gave it.
    Given,
}

/// A connected part of a cloud.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PieceRecord {
    /// Distinct points.
    pub points: usize,
    /// Their share of the points of all pieces, 0 to 1.
    pub share: f64,
    /// Their mean.
    pub centre_m: [f64; 3],
    /// Size of their bounding box along x, y and z.
    pub extent_m: [f64; 3],
    /// Whether it is the object.
    pub taken: bool,
}

/// Rows of a cloud that are no part of the object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DroppedRecord {
    /// Rows that repeat another row.
    pub repeated: usize,
    /// Rows at isolated points that are given three times or more.
    pub sentinels: usize,
    /// Points on the support plane that are not the foot of the object, or below it.
    pub support: usize,
    /// Points of groups that are too small for a piece.
    pub isolated: usize,
    /// Points of other pieces.
    pub other_pieces: usize,
}
