//! The grasps of every object.

use serde::Serialize;
use serde_json::{Map, Value};
use sph::Direction;

use crate::paper;
use crate::run::Run;
use crate::statistics::Summary;

/// How much is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Hand poses per surface.
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
    /// Poses tried.
    pub poses: usize,
    /// Stable grasps, by the threshold of the convention.
    pub stable: usize,
    /// Grasps that were made and are not stable.
    pub unstable: usize,
    /// Rejected poses by reason.
    pub rejected: Map<String, Value>,
    /// Stable grasps scaled to the number of poses of the paper.
    pub stable_of_1400: f64,
    /// Stable grasps by pre-shape: parallel, spread.
    pub stable_by_preshape: Vec<usize>,
    /// Qualities of G_i, the best 50, best first.
    pub best_qualities: Vec<f64>,
    /// Contacts of the best grasp.
    #[serde(skip)]
    pub best_contacts: Option<Vec<Direction>>,
    /// Summary of G_i.
    pub best: Option<Summary>,
    /// Summary of Ĝ_i, the best 10.
    pub very_best: Option<Summary>,
    /// The same grasps under every convention.
    pub conventions: Vec<UnderConvention>,
}

/// The stable grasps of the run's convention, measured under another one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnderConvention {
    /// The convention.
    pub name: String,
    /// Quality of the stable grasps; 0 for a grasp that is not closed.
    pub quality: Option<Summary>,
    /// Share that is closed.
    pub share_closed: Option<f64>,
    /// Spearman's rank correlation with the qualities of the run's convention.
    pub rank_correlation: Option<f64>,
}
