//! The results of the ascents.

use serde::{Deserialize, Serialize};
use shape::RadialShape;
use space::PaperAscent;
use sph::Direction;

use crate::paper;
use crate::run::Run;
use crate::statistics::{mean, share};

/// Amount of computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Number of hand poses from which G_i is selected.
    pub poses: usize,
    /// Number of grasps of G_i from which ascents start.
    pub grasps: usize,
    /// The paper's ascent.
    pub ascent: PaperAscent,
}

impl Settings {
    /// The settings of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            poses: run.scale.pick(150, paper::HAND_POSES),
            grasps: run.scale.pick(4, paper::BEST_GRASPS),
            ascent: paper::ascent(run.scale.pick(200, paper::ASCENT_STEPS)),
        }
    }
}

/// Both ascents from one start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Climb {
    /// The paper's ascent.
    #[serde(flatten)]
    pub paper: PaperClimb,
    /// Our ascent from the same start.
    pub ours: OurClimb,
}

/// The result of the paper's ascent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PaperClimb {
    /// Q at the start.
    pub initial: f64,
    /// Q at the end.
    pub last: f64,
    /// The largest Q of all states.
    pub highest: f64,
    /// Number of qualities computed.
    pub evaluations: usize,
    /// Largest angle between the start and the end of a contact, radians.
    pub moved_rad: f64,
}

/// The result of our ascent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OurClimb {
    /// Q at the end.
    pub last: f64,
    /// Number of qualities computed.
    pub evaluations: usize,
    /// Slope of Q that remains at the end, per radian.
    pub stationarity: f64,
}

/// The ascents on one object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectClimbs {
    /// The object.
    pub id: String,
    /// Its ascents, by rank of the start.
    pub climbs: Vec<Climb>,
}

/// Summary of all ascents.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Overall {
    /// Number of ascents.
    pub climbs: usize,
    /// Share of the paper's ascents with a higher Q at the end.
    pub share_improved: Option<f64>,
    /// Share with a lower Q at the end.
    pub share_worsened: Option<f64>,
    /// Mean of Q at the starts.
    pub mean_initial: Option<f64>,
    /// Mean of Q at the ends.
    pub mean_final: Option<f64>,
    /// Mean change of Q.
    pub mean_change: Option<f64>,
    /// Mean decrease of Q from the highest state to the end, due to the fixed step length.
    pub mean_lost_from_highest: Option<f64>,
    /// Share of our ascents from the same starts with a higher Q at the end.
    pub ours_share_improved: Option<f64>,
    /// Number of our ascents with a lower Q at the end.
    pub ours_below_start: usize,
    /// Mean of Q at the ends of our ascents.
    pub ours_mean_final: Option<f64>,
    /// Largest remaining slope of Q at an end of our ascents, per radian.
    pub ours_largest_stationarity: f64,
    /// Number of qualities of the paper's ascent divided by that of ours.
    pub evaluations_ratio: Option<f64>,
}

/// Summarises all ascents.
pub fn overall(climbs: &[Climb]) -> Overall {
    let mean_of = |pick: fn(&Climb) -> f64| mean(&climbs.iter().map(pick).collect::<Vec<_>>());
    let share_of =
        |which: fn(&&Climb) -> bool| share(climbs.iter().filter(which).count(), climbs.len());
    let total = |pick: fn(&Climb) -> usize| climbs.iter().map(pick).sum::<usize>();
    let slopes = climbs.iter().map(|c| c.ours.stationarity);
    Overall {
        climbs: climbs.len(),
        share_improved: share_of(|c| c.paper.last > c.paper.initial),
        share_worsened: share_of(|c| c.paper.last < c.paper.initial),
        mean_initial: mean_of(|c| c.paper.initial),
        mean_final: mean_of(|c| c.paper.last),
        mean_change: mean_of(|c| c.paper.last - c.paper.initial),
        mean_lost_from_highest: mean_of(|c| c.paper.highest - c.paper.last),
        ours_share_improved: share_of(|c| c.ours.last > c.paper.initial),
        ours_below_start: climbs
            .iter()
            .filter(|c| c.ours.last < c.paper.initial)
            .count(),
        ours_mean_final: mean_of(|c| c.ours.last),
        ours_largest_stationarity: slopes.fold(0.0, f64::max),
        evaluations_ratio: share(
            total(|c| c.paper.evaluations),
            total(|c| c.ours.evaluations),
        ),
    }
}

/// The four largest improvements, for comparison with Fig. 8.
pub(super) fn examples(climbs: &[Climb]) -> Vec<(f64, f64)> {
    let mut sorted: Vec<&Climb> = climbs.iter().collect();
    let gain = |c: &Climb| c.paper.last - c.paper.initial;
    sorted.sort_by(|a, b| gain(b).total_cmp(&gain(a)));
    sorted
        .iter()
        .take(paper::ASCENT_EXAMPLES.len())
        .map(|c| (c.paper.initial, c.paper.last))
        .collect()
}

/// One ascent with its states, for a figure.
pub struct DrawnClimb {
    /// The object and the change of quality.
    pub label: String,
    /// The surface.
    pub shape: RadialShape,
    /// The contacts at every state.
    pub states: Vec<Vec<Direction>>,
}
