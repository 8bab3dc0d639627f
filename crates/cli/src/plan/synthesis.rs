//! Candidates found afresh with a hand.

use hand::{
    ClosingRules, CollisionObject, Hand, PoseSampling, Synthesis, SynthesisParams, collect,
    evaluate_pose,
};
use indicatif::ProgressBar;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::{Candidate, HandPlacement, Source, Target};
use crate::failure::Failure;

/// Grasps below this count as unstable (Sec. IV-E of the paper).
const LEAST_QUALITY: f64 = 0.01;

/// Closes the hand from `poses` random poses, in parallel; the same seed gives the same grasps.
pub(crate) fn synthesize(
    target: &Target,
    hand: &Hand,
    poses: usize,
    seed: u64,
    progress: &ProgressBar,
) -> Result<Synthesis, Failure> {
    let refused = |e: String| Failure::refused(format!("synthesis on {}: {e}", target.name));
    let surface = &target.fit.shape;
    let params = SynthesisParams {
        poses,
        sampling: PoseSampling::of_hand(hand),
        rules: ClosingRules::default(),
        convention: target.convention.clone(),
        centre: target.centre,
        least_quality: LEAST_QUALITY,
    };
    let object = CollisionObject::new(surface).map_err(|e| refused(e.to_string()))?;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let drawn = params.sampling.sample(surface, hand, poses, &mut rng);
    let outcomes = drawn
        .par_iter()
        .map(|pose| {
            progress.inc(1);
            evaluate_pose(&object, hand, pose, &params)
        })
        .collect::<Result<Vec<_>, _>>()
        .map_err(|e| refused(e.to_string()))?;
    Ok(collect(outcomes))
}

/// The best of a synthesis as candidates.
pub(crate) fn candidates(synthesis: &Synthesis, count: usize) -> Vec<Candidate> {
    synthesis
        .grasps
        .iter()
        .take(count)
        .map(|grasp| Candidate {
            contacts: grasp.contacts.clone(),
            quality: grasp.quality,
            source: Source::Synthesis,
            carried: None,
            hand: Some(HandPlacement {
                object_from_palm: grasp.object_from_palm,
                joints: grasp.joints.clone(),
                contact_error: 0.0,
            }),
        })
        .collect()
}
