//! A trial of a hand on a ball, the easiest object.

use grasp::Convention;
use hand::{Hand, OutcomeCounts, TipModel};
use moduli::{Grasp, HandPlacement, Object, Poses, Source};
use shape::RadialShape;

use crate::failure::Failure;

/// Poses tried.
const POSES: usize = 200;

/// Diameters of the balls that are tried where one gives no grasp, metres.
const OTHER_BALLS: [f64; 6] = [0.055, 0.04, 0.025, 0.015, 0.09, 0.12];

/// The outcomes of the poses.
pub(crate) struct Trial {
    /// Diameter of the ball, metres.
    pub(crate) diameter: f64,
    pub(crate) ball: RadialShape,
    pub(crate) outcomes: OutcomeCounts,
    /// The best grasp of each pre-shape.
    pub(crate) best: Vec<Option<HandPlacement>>,
}

/// Closes the hand on a ball from 200 poses, under the paper's convention.
pub(crate) fn on_ball(
    hand: &Hand,
    diameter_mm: f64,
    tips: TipModel,
    seed: u64,
) -> Result<Trial, Failure> {
    let diameter = 1e-3 * diameter_mm;
    if !(1e-3..=2.0).contains(&diameter) {
        return Err(Failure::usage(format!(
            "--ball {diameter_mm}: expected a diameter from 1 to 2000 millimetres"
        )));
    }
    try_ball(hand, diameter, tips, seed)
}

/// The diameter of a ball that the hand can grasp, metres.
pub(crate) fn other_ball(hand: &Hand, tips: TipModel, seed: u64) -> Result<Option<f64>, Failure> {
    for diameter in OTHER_BALLS {
        if try_ball(hand, diameter, tips, seed)?.outcomes.stable > 0 {
            return Ok(Some(diameter));
        }
    }
    Ok(None)
}

fn try_ball(hand: &Hand, diameter: f64, tips: TipModel, seed: u64) -> Result<Trial, Failure> {
    let sphere = || RadialShape::sphere(3, 0.5 * diameter);
    let ball = sphere().map_err(|e| Failure::other(format!("the ball: {e}")))?;
    let object = Object::from_shape("a ball", ball.clone());
    let measure = object
        .measure(&Convention::paper())
        .map_err(|e| Failure::other(e.to_string()))?
        .with_tips(tips);
    let poses = Poses {
        count: POSES,
        seed,
        ..Poses::default()
    };
    let found = measure
        .synthesize(hand, &poses)
        .map_err(|e| Failure::refused(format!("synthesis on a ball: {e}")))?;
    let best_of = |p: usize| {
        let mut ranked = found.iter();
        let of_preshape = |g: &&Grasp| g.source() == &Source::Synthesis { preshape: p };
        ranked.find(of_preshape).and_then(Grasp::hand).cloned()
    };
    Ok(Trial {
        diameter,
        ball,
        best: (0..hand.preshapes().len()).map(best_of).collect(),
        outcomes: found.outcomes().cloned().unwrap_or_default(),
    })
}
