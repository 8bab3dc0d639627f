//! Proposals tried on balls: which of them grasps best.

use grasp::Convention;
use nalgebra::Point3;
use rand::Rng;
use shape::RadialShape;

use crate::closing::ClosingRules;
use crate::hand::Hand;
use crate::pose_sampling::PoseSampling;
use crate::synthesis::{SynthesisError, SynthesisParams, synthesize};

/// Poses on each ball.
const POSES: usize = 30;
/// Radii of the balls, metres.
const RADII: [f64; 3] = [0.025, 0.035, 0.045];

/// The roots of the shares of stable poses, summed over the balls, so that a hand which holds all of
/// them a little is better than one which holds one of them well; and a little for quality.
pub(super) fn score<R: Rng + Clone>(hand: &Hand, rng: &R) -> Result<f64, SynthesisError> {
    let mut score = 0.0;
    for radius in RADII {
        let Ok(ball) = RadialShape::sphere(3, radius) else {
            continue;
        };
        let params = SynthesisParams {
            poses: POSES,
            sampling: PoseSampling::of_hand(hand),
            rules: ClosingRules::default(),
            convention: Convention::paper(),
            centre: Point3::origin(),
            tips: hand.tip_model(),
            least_quality: Convention::paper().stable_above,
        };
        let found = synthesize(&ball, hand, &params, &mut rng.clone())?;
        let grasps = found.grasps.iter();
        let stable = grasps.map(|g| 1.0 + g.quality).sum::<f64>();
        score += (stable / POSES as f64).sqrt();
    }
    Ok(score)
}
