//! The qualities that both schemes reach.

use serde::{Deserialize, Serialize};
use space::PaperAscent;

use crate::paper;
use crate::run::Run;
use crate::statistics::share;

/// Standard deviation of a contact's scatter, radians in both tangent coordinates.
pub(super) const SPREAD: f64 = 0.3;
/// Differences of Q that are told apart in the result.
const MARGINS: [f64; 3] = [0.0, 1e-3, 1e-2];

/// How much is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Numbers of the objects; all when absent.
    pub objects: Option<Vec<usize>>,
    /// Hand poses from which Ĝ_i is taken.
    pub poses: usize,
    /// Grasps of Ĝ_i that may be drawn.
    pub grasps: usize,
    /// Transfers that are drawn.
    pub sample: usize,
    /// Runs of the paper's ascent for each.
    pub runs: usize,
    /// The paper's ascent.
    pub ascent: PaperAscent,
}

impl Settings {
    /// The settings of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            objects: run.scale.pick(Some(vec![2, 9, 11]), None),
            poses: run.scale.pick(150, paper::HAND_POSES),
            grasps: run.scale.pick(2, paper::VERY_BEST_GRASPS),
            sample: run.scale.pick(6, 200),
            runs: run.scale.pick(3, 10),
            ascent: paper::ascent(run.scale.pick(100, paper::ASCENT_STEPS)),
        }
    }
}

/// One transfer, and what the runs reach.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// Id of the source.
    pub from: String,
    /// Id of the target.
    pub to: String,
    /// Its rank among the grasps of its source, from 0.
    pub rank: usize,
    /// The runs of the paper's ascent.
    #[serde(flatten)]
    pub runs: Runs,
    /// Our transfer with its defaults.
    pub ours: f64,
    /// Our transfer when asked to be thorough.
    pub thorough: f64,
    /// Quality evaluations of the thorough transfer.
    pub thorough_evaluations: usize,
}

/// Ends of the paper's ascent from scattered starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Runs {
    /// Q at every end.
    pub ends: Vec<f64>,
    /// Quality evaluations of all runs.
    pub evaluations: usize,
}

impl Runs {
    /// The greatest Q of all ends.
    pub fn best(&self) -> f64 {
        self.ends.iter().copied().fold(0.0, f64::max)
    }
}

/// Which share of ours is at least the best run less a margin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtLeast {
    /// The margin of Q.
    pub margin: f64,
    /// Of the default transfer.
    pub ours: Option<f64>,
    /// Of the thorough transfer.
    pub thorough: Option<f64>,
}

/// Shares by margin.
pub fn shares(compared: &[Compared]) -> Vec<AtLeast> {
    let of = |margin: f64, pick: fn(&Compared) -> f64| {
        let reached = |c: &&Compared| pick(c) >= c.runs.best() - margin;
        share(compared.iter().filter(reached).count(), compared.len())
    };
    MARGINS
        .iter()
        .map(|&margin| AtLeast {
            margin,
            ours: of(margin, |c| c.ours),
            thorough: of(margin, |c| c.thorough),
        })
        .collect()
}
