//! The fixed-step ascent of the paper, unchanged.

use grasp::QualityError;
use shape::Surface;
use sph::Direction;

use super::{Ascent, Step};
use crate::chart::{from_angles, to_angles};
use crate::gradient::forward_differences;
use crate::objective::Objective;
use crate::point::contacts_on;

/// x_{n+1} = x_n + rate · clamp(∇Q(x_n)), clamp(v) = v/max(1, ‖v‖), x = (θ₁,φ₁,…) (Sec. IV-D).
///
/// Q can be lower at the end than at the start. The paper reports this too; the ascent is kept for
/// comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperAscent {
    /// Number of steps; 1000 in Sec. IV-D, 100 per station in Sec. IV-E.
    pub steps: usize,
    /// Forward-difference step δ, radians; 1e-5 in the paper.
    pub delta: f64,
    /// Step length, radians; 0.01 in the paper.
    pub rate: f64,
}

impl PaperAscent {
    /// The ascent of Sec. IV-D: 1000 steps of 0.01 radians, gradients by differences of 1e-5
    /// radians.
    pub const PAPER: Self = Self {
        steps: 1000,
        delta: 1e-5,
        rate: 0.01,
    };

    /// Climbs from `start`; `trace` receives every state, including the start and the end.
    ///
    /// Costs 1 + 2m qualities per step. A start that is not force-closed has no gradient, so it is
    /// also the end.
    ///
    /// # Errors
    /// A quality cannot be computed.
    pub fn climb(
        &self,
        surface: &impl Surface,
        start: &[Direction],
        objective: &mut Objective,
        mut trace: impl FnMut(&Step),
    ) -> Result<Ascent, QualityError> {
        let before = objective.evaluations();
        objective.forget();
        let mut angles = to_angles(start);
        let mut gradient = vec![0.0; angles.len()];
        let mut directions = start.to_vec();
        let mut contacts = contacts_on(surface, &directions);
        let mut quality = objective.quality(&contacts)?;
        let start_quality = quality;
        for _ in 0..self.steps {
            forward_differences(
                surface,
                &angles,
                &mut contacts,
                quality,
                self.delta,
                objective,
                &mut gradient,
            )?;
            let norm = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
            trace(&Step {
                directions: &directions,
                quality,
                stationarity: norm,
            });
            if norm == 0.0 {
                // The gradient is zero, so every later step would leave the grasp where it is.
                break;
            }
            for (x, g) in angles.iter_mut().zip(&gradient) {
                *x += self.rate * g / norm.max(1.0);
            }
            directions = from_angles(&angles);
            contacts = contacts_on(surface, &directions);
            quality = objective.quality(&contacts)?;
        }
        let stationarity = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
        trace(&Step {
            directions: &directions,
            quality,
            stationarity,
        });
        Ok(Ascent {
            directions,
            start_quality,
            quality,
            margin: quality,
            stationarity,
            evaluations: objective.evaluations() - before,
        })
    }
}
