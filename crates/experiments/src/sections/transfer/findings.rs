//! Where the transfers ended.

use serde::{Deserialize, Serialize};
use shape::RadialShape;
use space::PaperTransfer;
use sph::Direction;

use crate::paper;
use crate::run::Run;

/// What is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Numbers of the objects; all when absent.
    pub objects: Option<Vec<usize>>,
    /// Hand poses from which Ĝ_i is taken.
    pub poses: usize,
    /// Grasps of Ĝ_i that are carried.
    pub grasps: usize,
    /// The transfer.
    pub transfer: PaperTransfer,
}

impl Settings {
    /// The settings of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            // Two objects from which the paper reports unstable transfers, and a round one.
            objects: run.scale.pick(Some(vec![2, 9, 11]), None),
            poses: run.scale.pick(150, paper::HAND_POSES),
            grasps: run.scale.pick(2, paper::VERY_BEST_GRASPS),
            transfer: PaperTransfer {
                intervals: paper::TRANSFER_STATIONS - 1,
                ascent: paper::ascent(run.scale.pick(40, paper::TRANSFER_STEPS)),
            },
        }
    }
}

/// One grasp carried from one object to another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Carried {
    /// Where it came from.
    pub from: String,
    /// Where it went.
    pub to: String,
    /// Its rank among the grasps of its source, from 0.
    pub rank: usize,
    /// The paper's transfer.
    #[serde(flatten)]
    pub paper: PaperCarried,
    /// Ours.
    pub ours: OurCarried,
}

/// Where the paper's transfer ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PaperCarried {
    /// Q on the source.
    pub initial: f64,
    /// Q on the target.
    pub last: f64,
    /// Q on the target with θ and φ kept.
    pub naive: f64,
    /// Qualities computed.
    pub evaluations: usize,
}

/// Where our transfer ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OurCarried {
    /// Q on the target.
    pub last: f64,
    /// Qualities computed.
    pub evaluations: usize,
    /// Slope of Q left on the target, per radian.
    pub stationarity: Option<f64>,
}

/// Transfers in short.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Count {
    /// The source; "all" for the sum.
    pub from: String,
    /// Transfers.
    pub transfers: usize,
    /// Unstable after the paper's transfer: quality below 0.01 (conventions other than the paper's: open).
    pub unstable: usize,
    /// Unstable after the naive transfer.
    pub unstable_naive: usize,
    /// What the paper counts at full scale; none for objects that it does not have.
    pub unstable_in_paper: Option<usize>,
    /// Mean of Q on the source.
    pub mean_initial: Option<f64>,
    /// Mean of Q on the target.
    pub mean_final: Option<f64>,
    /// Mean of Q on the target, naive.
    pub mean_naive: Option<f64>,
    /// Of quality below 0.01 after our transfer.
    pub unstable_ours: usize,
    /// Mean of Q on the target, ours.
    pub mean_ours: Option<f64>,
    /// Qualities that the paper's transfer computes for one of ours.
    pub evaluations_ratio: Option<f64>,
}

/// One grasp on its way, as it is to be drawn.
pub struct DrawnTransfer {
    /// From where to where.
    pub title: String,
    /// Surfaces with the contacts as they leave them, and the quality.
    pub stations: Vec<(RadialShape, Vec<Direction>, f64)>,
}
