//! Candidates found afresh with a hand.

use hand::{
    ClosingRules, CollisionObject, Hand, OutcomeCounts, PoseSampling, Synthesis, SynthesisParams,
    collect, evaluate_pose,
};
use indicatif::ProgressBar;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::{Candidate, HandPlacement, Source, Target};
use crate::failure::Failure;

/// What is asked of a synthesis.
pub(crate) struct Request {
    pub(crate) poses: usize,
    /// Indices of the pre-shapes to close from.
    pub(crate) preshapes: Vec<usize>,
    pub(crate) least_quality: f64,
    /// Range of the distance from the surface, metres; that of the hand when absent.
    pub(crate) standoff: Option<(f64, f64)>,
    /// Close past the tips.
    pub(crate) power: bool,
    pub(crate) seed: u64,
}

/// Closes the hand from random poses, in parallel; the same seed gives the same grasps.
pub(crate) fn synthesize(
    target: &Target,
    hand: &Hand,
    request: &Request,
    progress: &ProgressBar,
) -> Result<Synthesis, Failure> {
    let refused = |e: String| Failure::refused(format!("synthesis on {}: {e}", target.name));
    let surface = &target.fit.shape;
    let params = SynthesisParams {
        poses: request.poses,
        sampling: PoseSampling {
            preshapes: request.preshapes.clone(),
            standoff: request.standoff.unwrap_or(hand.standoff()),
            ..PoseSampling::of_hand(hand)
        },
        rules: ClosingRules {
            past_tips: request.power,
            ..ClosingRules::default()
        },
        convention: target.convention.clone(),
        centre: target.centre,
        least_quality: request.least_quality,
    };
    let object = CollisionObject::new(surface).map_err(|e| refused(e.to_string()))?;
    let mut rng = ChaCha8Rng::seed_from_u64(request.seed);
    let drawn = params
        .sampling
        .sample(surface, hand, request.poses, &mut rng);
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
            directions: grasp.directions.clone(),
            contacts: grasp.contacts.clone(),
            quality: grasp.quality,
            source: Source::Synthesis {
                preshape: grasp.preshape,
            },
            carried: None,
            hand: Some(HandPlacement {
                object_from_palm: grasp.object_from_palm,
                joints: grasp.joints.clone(),
                contact_error: 0.0,
                met: true,
            }),
        })
        .collect()
}

/// "96 of 200 poses give a stable grasp; 60 tip did not arrive, …".
pub(crate) fn sentence(outcomes: &OutcomeCounts) -> String {
    let mut parts: Vec<String> = reasons(outcomes)
        .iter()
        .filter(|(_, count)| *count > 0)
        .map(|(reason, count)| format!("{count} {}", reason.replace('_', " ")))
        .collect();
    if parts.is_empty() {
        parts.push("none rejected".to_owned());
    }
    format!(
        "{} of {} hand poses give a stable grasp ({})",
        outcomes.stable,
        outcomes.total(),
        parts.join(", ")
    )
}

/// Poses that gave no stable grasp, by reason; all reasons, also those that did not occur.
pub(crate) fn reasons(outcomes: &OutcomeCounts) -> Vec<(&'static str, usize)> {
    let unstable = std::iter::once(("unstable", outcomes.unstable));
    outcomes.by_reason().into_iter().chain(unstable).collect()
}

/// Why no pose gave a stable grasp: the commonest reason, where, and what to try.
pub(crate) fn why_none(outcomes: &OutcomeCounts, hand: &Hand) -> String {
    let counts = reasons(outcomes);
    let Some((reason, count)) = counts.iter().max_by_key(|(_, count)| *count) else {
        return "no pose was tried".to_owned();
    };
    let advice = match *reason {
        "base_near_object" | "part_near_object" | "starts_in_object" => {
            "the object may be too large for the hand, or the least stand-off (standoff_m of the TOML) too small"
        }
        "tip_did_not_arrive" | "no_contact" => {
            "the object may be too small or too thin for the hand, or the stand-off (standoff_m of the TOML) too large"
        }
        "parts_near_each_other" => "the object may be too small for all fingers at once",
        _ => "more friction (--friction) or a smaller --least-quality may help",
    };
    let of_reason = outcomes
        .rejected
        .iter()
        .filter(|(r, _)| r.reason() == *reason);
    let most = of_reason.max_by_key(|(_, count)| **count);
    let place = most.map_or(String::new(), |(r, count)| {
        format!(", {count} times because {}", r.describe(hand))
    });
    format!(
        "{count} of {} poses ended as {}{place}; {advice}",
        outcomes.total(),
        reason.replace('_', " ")
    )
}
