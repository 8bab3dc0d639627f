//! A contact and the evidence for it in the cloud.

use serde::{Deserialize, Serialize};

/// A contact, and the support for it in the cloud (version 2).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactRecord {
    /// Position, metres.
    pub point_m: [f64; 3],
    /// Unit normal, into the object.
    pub inward_normal: [f64; 3],
    /// Point of S² that the surface maps to the contact.
    pub direction: [f64; 3],
    /// Distance of the nearest points of the cloud from the surface, metres, at the scale of a
    /// fingertip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance_to_cloud_m: Option<f64>,
    /// Spread of the cloud's normals within a fingertip, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal_spread_deg: Option<f64>,
    /// Whether the cloud has points within the fingertip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seen: Option<bool>,
}
