//! Hands for transferred grasps: a pose and joint values that bring the tips to given contacts.

use grasp::QualityError;
use hand::{
    ClosingRules, CollisionObject, Hand, ImproveParams, ReachOutcome, ReachParams, Reached, Reacher,
};
use nalgebra::Isometry3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use crate::carried::CarriedGrasp;
use crate::error::Error;
use crate::grasp::{HandPlacement, Source};
use crate::measure::Measure;

impl Measure<'_> {
    /// Least height of a hand's links above the support, metres.
    pub(crate) fn clearance(
        &self,
        hand: &Hand,
        centred_from_palm: &Isometry3<f64>,
        joints: &[f64],
    ) -> Option<f64> {
        let seen = self.support()?.seen_from(centred_from_palm);
        let links = hand.model().root_from_links(joints).ok()?;
        hand.lowest_link(&seen, &links).map(|(_, height)| height)
    }
}

/// How hard a hand is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandSearch {
    /// Number of random starts of the search for a hand that meets the contacts.
    pub starts: usize,
    /// Number of trial closings around contacts that no hand meets.
    pub trials: usize,
    /// First move of the contacts in such a trial, metres.
    pub spread: f64,
    /// Seed of the search: the same seed gives the same hands on any number of threads.
    pub seed: u64,
}

impl Default for HandSearch {
    /// 60 starts, 40 trials within 4 mm, seed 0.
    fn default() -> Self {
        Self {
            starts: 60,
            trials: 40,
            spread: 4e-3,
            seed: 0,
        }
    }
}

/// Searches a hand for every grasp that has none, on rayon's thread pool; `done` is called once per
/// grasp. A grasp whose number of contacts differs from the hand's number of fingers is left
/// without a hand.
///
/// If no hand meets the contacts, the best grasp that the hand makes near them replaces the grasp,
/// provided that it is stable and at least as good as the naive transfer. Every grasp has its own
/// random generator, so the result does not depend on the number of threads.
pub(crate) fn give_hands(
    measure: &Measure<'_>,
    hand: &Hand,
    carried: &mut [CarriedGrasp],
    search: &HandSearch,
    done: &(dyn Fn() + Sync),
) -> Result<(), Error> {
    let fingers = hand.fingers().len();
    if carried.iter().all(|c| c.grasp.contacts().len() != fingers) {
        return Ok(());
    }
    let object =
        CollisionObject::new(measure.object().field()).map_err(hand::SynthesisError::from)?;
    let object = object.with_surroundings(measure.object().surroundings().clone());
    let reacher = Reacher::new(&object, hand);
    let params = ReachParams {
        starts: search.starts,
        friction: measure.convention().friction,
        rules: ClosingRules {
            support: measure.support(),
            ..ClosingRules::default()
        },
        ..ReachParams::default()
    };
    let finder = Finder {
        measure,
        hand,
        reacher: &reacher,
        params: &params,
        search,
    };
    carried
        .par_iter_mut()
        .enumerate()
        .filter(|(_, c)| c.grasp.hand().is_none())
        .try_for_each(|(i, carried)| {
            let mut generator = ChaCha8Rng::seed_from_u64(search.seed);
            // Streams of one seed are independent; stream 0 is that of the hand poses.
            generator.set_stream(1 + i as u64);
            finder.find(carried, &mut generator)?;
            done();
            Ok(())
        })
}

struct Finder<'a> {
    measure: &'a Measure<'a>,
    hand: &'a Hand,
    reacher: &'a Reacher<'a>,
    params: &'a ReachParams,
    search: &'a HandSearch,
}

impl Finder<'_> {
    fn find(
        &self,
        carried: &mut CarriedGrasp,
        generator: &mut ChaCha8Rng,
    ) -> Result<(), QualityError> {
        let known: Vec<_> = carried.hand.clone().into_iter().collect();
        let wanted = carried.grasp.contacts().to_vec();
        match self.reacher.reach(&wanted, self.params, &known, generator) {
            ReachOutcome::Reached(found) => carried.grasp.place(self.placement(found)),
            ReachOutcome::Near(near) => self.settle(carried, near, generator)?,
            ReachOutcome::Nothing { .. } | ReachOutcome::WrongCount { .. } => {}
        }
        Ok(())
    }

    /// Replaces the grasp by the best one that the hand makes near the requested contacts.
    fn settle(
        &self,
        carried: &mut CarriedGrasp,
        near: Reached,
        generator: &mut ChaCha8Rng,
    ) -> Result<(), QualityError> {
        let improve = ImproveParams {
            trials: self.search.trials,
            spread: self.search.spread,
            convention: self.measure.convention().clone(),
            centre: self.measure.centre(),
            tips: self.measure.tips(),
        };
        let wanted = carried.grasp.contacts().to_vec();
        let found = self
            .reacher
            .improve(&wanted, near, self.params, &improve, generator)?;
        let naive = match carried.grasp.source() {
            Source::Transfer { naive, .. } => *naive,
            Source::Synthesis { .. } | Source::Given => 0.0,
        };
        if self.measure.is_stable(found.quality) && found.quality >= naive {
            let contacts = found.reached.contacts.clone();
            let directions = found.reached.directions.clone();
            let source = carried.grasp.source().clone();
            let hand = HandPlacement {
                contact_error: 0.0,
                met: false,
                ..self.placement(found.reached)
            };
            let quality = found.quality;
            let settled = self
                .measure
                .grasp_of(directions, contacts, quality, source)?;
            carried.grasp = settled.with_hand(Some(hand));
        }
        Ok(())
    }

    fn placement(&self, found: Reached) -> HandPlacement {
        let opening = ReachParams::default().opening;
        let pose = found.object_from_palm;
        HandPlacement {
            clearance_to_support: self.measure.clearance(self.hand, &pose, &found.joints),
            centred_from_palm: pose,
            pregrasp_joints: self.hand.opened(&found.joints, opening),
            joints: found.joints,
            contact_error: found.position_error,
            met: true,
        }
    }
}
