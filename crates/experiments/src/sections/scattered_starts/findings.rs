//! The qualities of both schemes.

use serde::{Deserialize, Serialize};
use space::PaperAscent;

use crate::paper;
use crate::run::Run;
use crate::statistics::share;

/// Standard deviation of the scatter of a contact, radians, in both tangent coordinates.
pub(super) const SPREAD: f64 = 0.3;
/// Margins of Q for which shares are reported.
const MARGINS: [f64; 3] = [0.0, 1e-3, 1e-2];

/// Amount of computation.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Numbers of the objects; `None` for all.
    pub objects: Option<Vec<usize>>,
    /// Number of hand poses from which Ĝ_i is selected.
    pub poses: usize,
    /// Number of grasps of Ĝ_i from which the sample is drawn.
    pub grasps: usize,
    /// Number of transfers in the sample.
    pub sample: usize,
    /// Number of runs of the paper's ascent per transfer.
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

/// One transfer and the ends of the runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// Id of the source.
    pub from: String,
    /// Id of the target.
    pub to: String,
    /// Rank of the grasp among those of its source, from 0.
    pub rank: usize,
    /// The runs of the paper's ascent.
    #[serde(flatten)]
    pub runs: Runs,
    /// Q of our transfer with default settings.
    pub ours: f64,
    /// Q of our transfer with thorough settings.
    pub thorough: f64,
    /// Number of qualities computed by the thorough transfer.
    pub thorough_evaluations: usize,
}

/// Ends of the paper's ascent from scattered starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Runs {
    /// Q at every end.
    pub ends: Vec<f64>,
    /// Number of qualities computed by all runs.
    pub evaluations: usize,
}

impl Runs {
    /// The largest Q of all ends.
    pub fn best(&self) -> f64 {
        self.ends.iter().copied().fold(0.0, f64::max)
    }
}

/// Share of our transfers that reach the best run's Q less a margin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtLeast {
    /// The margin of Q.
    pub margin: f64,
    /// Share of the default transfers.
    pub ours: Option<f64>,
    /// Share of the thorough transfers.
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
