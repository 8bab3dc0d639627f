//! The spec of a hand: a short TOML file beside its URDF.
//!
//! It contains names; [`crate::Hand::new`] resolves them against the model.

mod text;

use std::collections::BTreeMap;

use serde::Deserialize;
use thiserror::Error;

pub use text::exempt_pairs_text;

/// The largest TOML text accepted, in bytes.
pub(crate) const MAX_SPEC_BYTES: usize = 1 << 20;

/// Fingers, closing joints and pre-shapes of a hand.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandSpec {
    /// A short name, used in results.
    pub name: String,
    /// The palm: the root link of the URDF, or the link of an arm on which the fingers hang.
    pub palm: String,
    /// The direction in the palm frame in which the hand approaches; any length.
    pub approach_axis: [f64; 3],
    /// A point of the palm frame, in metres: the line through it along the approach axis
    /// is aimed at the object's origin.
    #[serde(default)]
    pub approach_point: [f64; 3],
    /// Least and greatest distance from the surface to the approach point of sampled
    /// poses, along the line of approach, in metres.
    pub standoff_m: [f64; 2],
    /// Whether the palm moves along the line between the tips of two fingers that the same joints
    /// close, until both touch, as a gripper on a compliant arm does. The default is true.
    #[serde(default)]
    pub compliant: Option<bool>,
    /// Radius of the contact area of a tip, metres: the disc of the soft contacts of a hand with
    /// two fingers.
    #[serde(default)]
    pub pad_radius_m: Option<f64>,
    /// Number of fingers that must touch in a grasp. The default is all.
    #[serde(default)]
    pub least_fingers: Option<usize>,
    /// Which links are not tested against each other.
    #[serde(default)]
    pub self_distance: SelfDistance,
    /// The fingers.
    pub finger: Vec<FingerSpec>,
    /// The pre-shapes.
    pub preshape: Vec<PreshapeSpec>,
}

/// The pairs of links that are exempt from the clearance between parts.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SelfDistance {
    /// Links joined by at most this many joints are exempt.
    #[serde(default = "two")]
    pub exempt_within_joints: usize,
    /// Further exempt pairs, by link name.
    #[serde(default)]
    pub exempt_pairs: Vec<[String; 2]>,
}

fn two() -> usize {
    2
}

impl Default for SelfDistance {
    fn default() -> Self {
        SelfDistance {
            exempt_within_joints: two(),
            exempt_pairs: Vec::new(),
        }
    }
}

/// One finger.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FingerSpec {
    /// Its name.
    pub name: String,
    /// The links of its tip, which may touch the object.
    pub tips: Vec<String>,
    /// The driven joints that close it, each with its rate (radians or metres per unit of closing;
    /// negative where closing lowers the value). Fingers that the same joints close have the same
    /// rates.
    pub closing: BTreeMap<String, f64>,
}

/// Joint values from which the fingers start to close.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PreshapeSpec {
    /// Its name.
    pub name: String,
    /// Values of driven joints by name; joints left out are at the value within their
    /// limits that is nearest to 0.
    pub joints: BTreeMap<String, f64>,
}

/// Why a TOML text is not a hand spec.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SpecTextError {
    /// The text is too long.
    #[error("the spec has {bytes} bytes, more than {MAX_SPEC_BYTES}")]
    TooLarge {
        /// Its length.
        bytes: usize,
    },
    /// The text is not TOML or has other keys.
    #[error("not a hand spec: {0}")]
    Toml(String),
}

impl HandSpec {
    /// Reads a spec from TOML text. Unknown keys are errors, so that misspelt keys are noticed.
    pub fn from_toml(text: &str) -> Result<Self, SpecTextError> {
        if text.len() > MAX_SPEC_BYTES {
            return Err(SpecTextError::TooLarge { bytes: text.len() });
        }
        toml::from_str(text).map_err(|e| SpecTextError::Toml(e.to_string()))
    }
}
