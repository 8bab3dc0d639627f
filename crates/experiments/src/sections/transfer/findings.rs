//! Where the transfers ended.

use serde::{Deserialize, Serialize};
use shape::RadialShape;
use space::PaperTransfer;
use sph::Direction;

use crate::paper;
use crate::run::Run;

/// How much is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Numbers of the objects; all when absent.
    pub objects: Option<Vec<usize>>,
    /// Hand poses from which Ĝ_i is taken.
    pub poses: usize,
    /// Grasps of Ĝ_i that are transferred.
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

/// One grasp transferred from one object to another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Carried {
    /// Id of the source.
    pub from: String,
    /// Id of the target.
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
    /// Quality evaluations.
    pub evaluations: usize,
}

/// Where our transfer ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OurCarried {
    /// Q on the target.
    pub last: f64,
    /// Quality evaluations.
    pub evaluations: usize,
    /// Slope of Q left on the target, per radian.
    pub stationarity: Option<f64>,
}

/// Numbers over the transfers from one source, or over all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Count {
    /// The source; "all" for the sum.
    pub from: String,
    /// Transfers.
    pub transfers: usize,
    /// Grasps that are not stable after the paper's transfer, by the threshold of the convention.
    pub unstable: usize,
    /// Grasps that are not stable after the naive transfer.
    pub unstable_naive: usize,
    /// The paper's count at full scale; `None` for objects that are not in the paper.
    pub unstable_in_paper: Option<usize>,
    /// Mean of Q on the source.
    pub mean_initial: Option<f64>,
    /// Mean of Q on the target.
    pub mean_final: Option<f64>,
    /// Mean of Q on the target, naive.
    pub mean_naive: Option<f64>,
    /// Grasps that are not stable after our transfer.
    pub unstable_ours: usize,
    /// Mean of Q on the target, ours.
    pub mean_ours: Option<f64>,
    /// Quality evaluations of the paper's transfer per evaluation of ours.
    pub evaluations_ratio: Option<f64>,
}

/// One transfer with its stations, to be drawn.
pub struct DrawnTransfer {
    /// Source and target.
    pub title: String,
    /// The surface of each station, with the contacts and the quality at its end.
    pub stations: Vec<(RadialShape, Vec<Direction>, f64)>,
}
