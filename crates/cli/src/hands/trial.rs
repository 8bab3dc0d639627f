//! A hand tried on a ball: the easiest object there is.

use grasp::Convention;
use hand::{Hand, HandGrasp, OutcomeCounts};
use indicatif::ProgressBar;
use nalgebra::Point3;
use shape::RadialShape;

use crate::failure::Failure;
use crate::plan::synthesis::{Request, synthesize};
use crate::plan::{Fitted, Target};

/// Poses tried.
const POSES: usize = 200;

/// What became of the poses.
pub(crate) struct Trial {
    /// Diameter of the ball, metres.
    pub(crate) diameter: f64,
    pub(crate) ball: RadialShape,
    pub(crate) outcomes: OutcomeCounts,
    /// By pre-shape, the best grasp.
    pub(crate) best: Vec<Option<HandGrasp>>,
}

/// Closes the hand on a ball from 200 poses, under the paper's convention.
pub(crate) fn on_ball(hand: &Hand, diameter_mm: f64, seed: u64) -> Result<Trial, Failure> {
    let diameter = 1e-3 * diameter_mm;
    if !(1e-3..=2.0).contains(&diameter) {
        return Err(Failure::usage(format!(
            "--ball {diameter_mm}: expected a diameter from 1 to 2000 millimetres"
        )));
    }
    let sphere = || RadialShape::sphere(3, 0.5 * diameter);
    let ball = sphere().map_err(|e| Failure::other(format!("the ball: {e}")))?;
    let fitted = Fitted {
        shape: ball.clone(),
        centre_in_cloud: Point3::origin(),
        rms: 0.0,
        points: 0,
    };
    let rule = Convention::paper();
    let target = Target::new("a ball", &fitted, &rule);
    let request = Request {
        poses: POSES,
        preshapes: (0..hand.preshapes().len()).collect(),
        least_quality: rule.stable_above,
        standoff: None,
        power: false,
        seed,
    };
    let found = synthesize(&target, hand, &request, &ProgressBar::hidden())?;
    let best_of = |p: usize| found.grasps.iter().find(|g| g.preshape == p).cloned();
    Ok(Trial {
        diameter,
        ball,
        best: (0..hand.preshapes().len()).map(best_of).collect(),
        outcomes: found.outcomes,
    })
}
