//! The grasps of every object.

use serde::Serialize;
use serde_json::{Map, Value};
use sph::Direction;

use crate::paper;
use crate::run::Run;
use crate::statistics::Summary;

/// Amount of computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Number of hand poses per surface.
    pub poses: usize,
}

impl Settings {
    /// The settings of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            poses: run.scale.pick(150, paper::HAND_POSES),
        }
    }
}

/// The grasps of one object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectGrasps {
    /// The object.
    pub id: String,
    /// Number of poses.
    pub poses: usize,
    /// Number of grasps that exceed the convention's threshold of stability.
    pub stable: usize,
    /// Number of grasps that do not exceed it.
    pub unstable: usize,
    /// Number of rejected poses by reason.
    pub rejected: Map<String, Value>,
    /// Number of stable grasps, scaled to the paper's number of poses.
    pub stable_of_1400: f64,
    /// Number of stable grasps by pre-shape: parallel, spread.
    pub stable_by_preshape: Vec<usize>,
    /// Qualities of G_i, the 50 best grasps, in descending order.
    pub best_qualities: Vec<f64>,
    /// Contacts of the best grasp.
    #[serde(skip)]
    pub best_contacts: Option<Vec<Direction>>,
    /// Summary of G_i.
    pub best: Option<Summary>,
    /// Summary of Ĝ_i, the 10 best grasps.
    pub very_best: Option<Summary>,
    /// The same grasps under every convention.
    pub conventions: Vec<UnderConvention>,
}

/// The stable grasps of the run's convention, measured under another one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnderConvention {
    /// The convention.
    pub name: String,
    /// Summary of the qualities; a grasp that is not closed counts as 0.
    pub quality: Option<Summary>,
    /// Share of closed grasps.
    pub share_closed: Option<f64>,
    /// Spearman's rank correlation with the qualities of the run's convention.
    pub rank_correlation: Option<f64>,
}
