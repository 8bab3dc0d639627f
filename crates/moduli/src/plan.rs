//! The complete pipeline: transferred and synthesized grasps, with a hand, ranked.

use std::sync::atomic::{AtomicUsize, Ordering};

use hand::{Hand, OutcomeCounts};

use crate::carried::best;
use crate::error::Error;
use crate::grasp::{Grasp, ranked};
use crate::hands::give_hands;
use crate::library::{Library, Neighbour, TransferOptions, carry};
use crate::measure::Measure;
use crate::synthesis::Poses;

/// What is computed, and how many grasps are kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Options of the transfer from the library.
    pub transfer: TransferOptions,
    /// Options of the synthesis with the hand.
    pub poses: Poses,
    /// Number of best synthesized grasps that are kept.
    pub keep: usize,
}

impl Default for Plan {
    /// Default transfers, 700 hand poses, and at most twelve grasps of each kind.
    fn default() -> Self {
        Self {
            transfer: TransferOptions::default(),
            poses: Poses {
                count: 700,
                ..Poses::default()
            },
            keep: 12,
        }
    }
}

/// A stage of the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Transfer of grasps from known objects.
    Transfer,
    /// Search for a hand at the transferred grasps.
    Reach,
    /// Synthesis: closing the hand from sampled poses.
    Synthesis,
}

/// Progress of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The stage.
    pub stage: Stage,
    /// Number of completed steps.
    pub done: usize,
    /// Number of steps.
    pub total: usize,
}

/// The result of a plan.
#[derive(Clone, Debug)]
pub struct Planned {
    /// Force-closed grasps as [`ranked`] orders them: those with a hand first.
    pub grasps: Vec<Grasp>,
    /// Outcomes of the transfers.
    pub transferred: TransferCounts,
    /// Outcomes of the hand poses.
    pub outcomes: OutcomeCounts,
}

/// Outcomes of the transfers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TransferCounts {
    /// The known objects from which grasps were transferred: name, and distance of the shapes in
    /// metres.
    pub neighbours: Vec<(String, f64)>,
    /// Number of transferred grasps.
    pub all: usize,
    /// Number of these that are force-closed on the object.
    pub closed: usize,
    /// Number of kept grasps that have a hand.
    pub with_hand: usize,
    /// Number of these whose contacts the hand meets; for the others it makes contacts near them.
    pub met: usize,
    /// Number of grasps left out because their number of contacts differs from the hand's number of
    /// fingers.
    pub of_other_count: usize,
}

impl Plan {
    /// Transfers grasps from the library, closes the hand from sampled poses, and ranks all grasps
    /// by quality.
    ///
    /// `progress` is called after every step, from any thread. The result does not depend on the
    /// number of threads.
    ///
    /// # Errors
    /// The library is damaged, the surface is too rough for the hand's collision model, or a quality
    /// cannot be computed.
    pub fn run(
        &self,
        measure: &Measure<'_>,
        hand: &Hand,
        library: &Library,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Planned, Error> {
        let (mut grasps, transferred) = self.carry(measure, hand, library, progress)?;
        let step = counter(Stage::Synthesis, self.poses.count, progress);
        let mut found = measure.synthesize_watched(hand, &self.poses, &step)?;
        found.list.truncate(self.keep);
        grasps.extend(found.list);
        Ok(Planned {
            grasps: ranked(grasps),
            transferred,
            outcomes: found.outcomes.unwrap_or_default(),
        })
    }

    /// The grasps of the nearest known objects, the best ones with a hand if one is found.
    fn carry(
        &self,
        measure: &Measure<'_>,
        hand: &Hand,
        library: &Library,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<(Vec<Grasp>, TransferCounts), Error> {
        let options = &self.transfer;
        let neighbours = library.nearest(measure.object(), options.neighbours)?;
        let total = options.grasps * neighbours.len();
        let step = counter(Stage::Transfer, total, progress);
        let all = carry(measure, hand, &neighbours, options.grasps, &step)?;
        let mut counts = TransferCounts {
            neighbours: neighbours.iter().map(Neighbour::described).collect(),
            all: all.len(),
            closed: all.iter().filter(|c| c.grasp.quality() > 0.0).count(),
            ..TransferCounts::default()
        };
        let mut kept = best(all, options.keep);
        let tried = neighbours
            .iter()
            .map(|n| n.grasps.len().min(options.grasps));
        counts.of_other_count = tried.sum::<usize>() - counts.all;
        let step = counter(Stage::Reach, kept.len(), progress);
        give_hands(measure, hand, &mut kept, &options.search, &step)?;
        let grasps: Vec<Grasp> = kept.into_iter().map(|c| c.grasp).collect();
        let hands = || grasps.iter().filter_map(Grasp::hand);
        counts.with_hand = hands().count();
        counts.met = hands().filter(|h| h.met).count();
        Ok((grasps, counts))
    }
}

/// Counts the steps of a stage.
fn counter<'a>(
    stage: Stage,
    total: usize,
    progress: &'a (dyn Fn(Progress) + Sync),
) -> impl Fn() + Sync + 'a {
    let done = AtomicUsize::new(0);
    move || {
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        progress(Progress { stage, done, total });
    }
}
