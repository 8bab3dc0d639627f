//! Hands for transferred grasps: a pose and joints that bring the tips to given contacts.

use hand::{CollisionObject, Hand, ReachOutcome, ReachParams, reach_contacts};
use indicatif::ProgressBar;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::{Candidate, HandPlacement, Target};
use crate::failure::Failure;

/// Looks for a hand for every candidate that has none, in parallel.
///
/// Every candidate has a generator of its own, so the result does not depend on threads.
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
    let params = ReachParams {
        starts,
        friction: target.convention.friction,
        ..ReachParams::default()
    };
    candidates
        .par_iter_mut()
        .enumerate()
        .filter(|(_, c)| c.hand.is_none())
        .for_each(|(i, candidate)| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            // Streams are independent sequences of one seed; 0 is that of the hand poses.
            rng.set_stream(1 + i as u64);
            let wanted = &candidate.contacts;
            if let ReachOutcome::Reached(found) =
                reach_contacts(&object, hand, wanted, &params, &mut rng)
            {
                candidate.hand = Some(HandPlacement {
                    object_from_palm: found.object_from_palm,
                    joints: found.joints,
                    contact_error: found.position_error,
                });
            }
            progress.inc(1);
        });
    Ok(())
}
