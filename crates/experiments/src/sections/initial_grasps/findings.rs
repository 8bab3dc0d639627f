//! The grasps of every object.

use serde::Serialize;
use serde_json::{Map, Value};
use sph::Direction;

use crate::paper;
use crate::run::Run;
use crate::statistics::Summary;

/// What is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Poses a surface.
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
    /// Stable grasps: quality at least 0.01 under the paper's convention, force-closed under others.
    pub stable: usize,
    /// Closed on the object, but of less quality.
    pub unstable: usize,
    /// Rejected poses by reason.
    pub rejected: Map<String, Value>,
    /// Stable grasps to be expected of as many poses as in the paper.
    pub stable_of_1400: f64,
    /// Stable grasps by pre-shape: parallel, spread.
    pub stable_by_preshape: Vec<usize>,
    /// Qualities of G_i, the best 50, best first.
    pub best_qualities: Vec<f64>,
    /// Contacts of the best grasp.
    #[serde(skip)]
    pub best_contacts: Option<Vec<Direction>>,
    /// G_i in short.
    pub best: Option<Summary>,
    /// Ĝ_i, the best 10, in short.
    pub very_best: Option<Summary>,
    /// The same grasps under every convention.
    pub conventions: Vec<UnderConvention>,
}

/// What a convention says of the stable grasps that were ranked under the run's.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnderConvention {
    /// The convention.
    pub name: String,
    /// Quality of the stable grasps; 0 where it calls one open.
    pub quality: Option<Summary>,
    /// Share that it calls force-closed.
    pub share_closed: Option<f64>,
    /// Spearman's correlation of its ranking with the run's.
    pub rank_correlation: Option<f64>,
}
