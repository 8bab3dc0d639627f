//! Sums over the samples of a fit.

use crate::coefficients::Coefficients;
use crate::direction::Direction;
use crate::{batch, scattered::Scattered};

/// Sums over the points: direct for few points, by a non-uniform Fourier transform for many.
pub(super) enum Points {
    Few,
    Many(Scattered),
}

impl Points {
    pub(super) fn new(directions: &[Direction], degree: usize) -> Self {
        // Each point costs the square of the window's width instead of L²; the grid costs L³ once.
        if directions.len() > 400 && degree > 8 {
            Self::Many(Scattered::new(directions))
        } else {
            Self::Few
        }
    }

    pub(super) fn moments(
        &self,
        directions: &[Direction],
        weights: &[f64],
        degree: usize,
    ) -> Coefficients {
        match self {
            Self::Few => batch::moments(directions, weights, degree),
            Self::Many(points) => points.moments(weights, degree),
        }
    }

    pub(super) fn evaluate(&self, directions: &[Direction], beta: &[f64]) -> Vec<f64> {
        let mut coefficients = Coefficients::zeros(beta.len().isqrt() - 1);
        coefficients.as_mut_slice().copy_from_slice(beta);
        match self {
            Self::Few => batch::evaluate(&coefficients, directions),
            Self::Many(points) => points.evaluate(&coefficients),
        }
    }
}
