//! Hands for transferred grasps: a pose and joints that bring the tips to given contacts.

use grasp::QualityError;
use hand::{CollisionObject, Hand, ImproveParams, ReachOutcome, ReachParams, Reached, Reacher};
use indicatif::ProgressBar;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::{Candidate, HandPlacement, Target};
use crate::failure::Failure;

/// Closings tried around contacts that no hand was found for.
const TRIALS: usize = 40;
/// First move of contacts in such a trial, metres.
const SPREAD: f64 = 4e-3;

/// Looks for a hand for every candidate that has none, in parallel.
///
/// Where no hand meets the contacts, the best grasp that the hand makes near them takes their
/// place, if it is no worse than the naive transfer. Every candidate has a generator of its own,
/// so the result does not depend on threads.
pub(crate) fn give_hands(
    target: &Target,
    hand: &Hand,
    candidates: &mut [Candidate],
    starts: usize,
    seed: u64,
    progress: &ProgressBar,
) -> Result<(), Failure> {
    let object = CollisionObject::new(&target.fit.shape)
        .map_err(|e| Failure::refused(format!("{}: {e}", target.name)))?;
    let reacher = Reacher::new(&object, hand);
    let params = ReachParams {
        starts,
        friction: target.convention.friction,
        ..ReachParams::default()
    };
    candidates
        .par_iter_mut()
        .enumerate()
        .filter(|(_, c)| c.hand.is_none())
        .try_for_each(|(i, candidate)| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            // Streams are independent sequences of one seed; 0 is that of the hand poses.
            rng.set_stream(1 + i as u64);
            let carried = candidate.carried.as_ref();
            let known: Vec<_> = carried.and_then(|c| c.hand.clone()).into_iter().collect();
            match reacher.reach(&candidate.contacts, &params, &known, &mut rng) {
                ReachOutcome::Reached(found) => candidate.hand = Some(placement(found)),
                ReachOutcome::Near(near) => {
                    settle_for(&reacher, target, candidate, near, &params, &mut rng)?;
                }
                ReachOutcome::Nothing { .. } | ReachOutcome::WrongCount { .. } => {}
            }
            progress.inc(1);
            Ok(())
        })
        .map_err(|e: QualityError| Failure::refused(format!("{}: {e}", target.name)))
}

/// Takes the best contacts that the hand makes near the wanted ones.
fn settle_for(
    reacher: &Reacher<'_>,
    target: &Target,
    candidate: &mut Candidate,
    near: Reached,
    params: &ReachParams,
    rng: &mut ChaCha8Rng,
) -> Result<(), QualityError> {
    let improve = ImproveParams {
        trials: TRIALS,
        spread: SPREAD,
        convention: target.convention.clone(),
        centre: target.centre,
    };
    let found = reacher.improve(&candidate.contacts, near, params, &improve, rng)?;
    let naive = candidate.carried.as_ref().map_or(0.0, |c| c.naive);
    if target.convention.is_stable(found.quality) && found.quality >= naive {
        candidate.quality = found.quality;
        candidate.contacts.clone_from(&found.reached.contacts);
        candidate.directions.clone_from(&found.reached.directions);
        candidate.hand = Some(HandPlacement {
            contact_error: 0.0,
            met: false,
            ..placement(found.reached)
        });
    }
    Ok(())
}

fn placement(found: Reached) -> HandPlacement {
    HandPlacement {
        object_from_palm: found.object_from_palm,
        joints: found.joints,
        contact_error: found.position_error,
        met: true,
    }
}
