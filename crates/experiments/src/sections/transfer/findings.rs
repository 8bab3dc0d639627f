//! The results of the transfers.

use serde::{Deserialize, Serialize};
use shape::RadialShape;
use space::PaperTransfer;
use sph::Direction;

use crate::paper;
use crate::run::Run;

/// Amount of computation.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Numbers of the objects; `None` for all.
    pub objects: Option<Vec<usize>>,
    /// Number of hand poses from which Ĝ_i is selected.
    pub poses: usize,
    /// Number of grasps of Ĝ_i that are transferred.
    pub grasps: usize,
    /// The paper's transfer.
    pub transfer: PaperTransfer,
}

impl Settings {
    /// The settings of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            // Two objects for which the paper reports unstable transfers, and a round one.
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
    /// Rank of the grasp among those of its source, from 0.
    pub rank: usize,
    /// The paper's transfer.
    #[serde(flatten)]
    pub paper: PaperCarried,
    /// Our transfer.
    pub ours: OurCarried,
}

/// The result of the paper's transfer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PaperCarried {
    /// Q on the source.
    pub initial: f64,
    /// Q on the target.
    pub last: f64,
    /// Q on the target after the naive transfer, which keeps θ and φ.
    pub naive: f64,
    /// Number of qualities computed.
    pub evaluations: usize,
}

/// The result of our transfer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OurCarried {
    /// Q on the target.
    pub last: f64,
    /// Number of qualities computed.
    pub evaluations: usize,
    /// Slope of Q that remains on the target, per radian.
    pub stationarity: Option<f64>,
}

/// Summary of the transfers from one source, or of all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Count {
    /// The source; "all" for the total.
    pub from: String,
    /// Number of transfers.
    pub transfers: usize,
    /// Number of grasps below the convention's threshold after the paper's transfer.
    pub unstable: usize,
    /// The same after the naive transfer.
    pub unstable_naive: usize,
    /// The paper's number at full scale; `None` for objects that are not in the paper.
    pub unstable_in_paper: Option<usize>,
    /// Mean of Q on the source.
    pub mean_initial: Option<f64>,
    /// Mean of Q on the target after the paper's transfer.
    pub mean_final: Option<f64>,
    /// The same after the naive transfer.
    pub mean_naive: Option<f64>,
    /// Number of grasps below the threshold after our transfer.
    pub unstable_ours: usize,
    /// Mean of Q on the target after our transfer.
    pub mean_ours: Option<f64>,
    /// Number of qualities of the paper's transfers divided by that of ours.
    pub evaluations_ratio: Option<f64>,
}

/// One transfer with its stations, for a figure.
pub struct DrawnTransfer {
    /// Source and target.
    pub title: String,
    /// The surface of each station, with the contacts and the quality at its end.
    pub stations: Vec<(RadialShape, Vec<Direction>, f64)>,
}
