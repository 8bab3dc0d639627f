//! Solutions of the normal equations to the accuracy of the samples themselves.

use super::conjugate::{Fine, Limits, dot};
use super::gram::Gram;
use super::{Penalty, RegressionError, Samples};
use crate::coefficients::Coefficients;
use crate::index;

/// Most corrections by the true residual, and the share of β that the last one may be.
const MOST_CORRECTIONS: usize = 6;
const SETTLED: f64 = 1e-6;

/// Corrections below this share of the mean are rounding: the values of a constant function differ
/// from their mean by no more.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Where (ρ̃⁻¹ YᵀWY) has at most this condition number, sums on the grid lose no more than three of
/// their fourteen digits on the way to β, and the samples need not be asked again.
const WELL_POSED: Fine = Fine {
    condition: 100.0,
    share: 1e-24,
};

impl Gram {
    pub(super) fn by_iteration(
        &self,
        samples: Samples,
        penalty: Penalty,
        iterations: usize,
    ) -> Result<Coefficients, RegressionError> {
        let aim = Limits {
            fine: Some(WELL_POSED),
            ..Limits::to(1e-18, iterations)
        };
        let first = self.iterate(penalty, self.right(), None, aim)?;
        if first.fine {
            return self.finish(first.solution);
        }
        self.refine(samples, penalty, first.solution, |rest| {
            let limits = Limits::to(1e-10, iterations);
            Ok(self.iterate(penalty, rest, None, limits)?.solution)
        })
    }

    pub(super) fn by_factor(
        &self,
        samples: Samples,
        penalty: Penalty,
    ) -> Result<Coefficients, RegressionError> {
        let factor = self.factor(penalty)?;
        self.refine(samples, penalty, factor.solve(self.right()), |rest| {
            Ok(factor.solve(rest))
        })
    }

    /// Corrects β by what the samples themselves say about its error, until that settles.
    fn refine(
        &self,
        samples: Samples,
        penalty: Penalty,
        mut beta: Vec<f64>,
        solve: impl Fn(&[f64]) -> Result<Vec<f64>, RegressionError>,
    ) -> Result<Coefficients, RegressionError> {
        let rounding = ROUNDING * self.mean.abs() * (4.0 * std::f64::consts::PI).sqrt();
        for _ in 0..MOST_CORRECTIONS {
            let step = solve(&self.gradient(samples, penalty, &beta))?;
            for (b, s) in beta.iter_mut().zip(&step) {
                *b += s;
            }
            // The relative error of each correction is about the size of the previous one relative to β.
            let settled = SETTLED * SETTLED * dot(&beta, &beta);
            if dot(&step, &step) <= settled.max(rounding * rounding) {
                return self.finish(beta);
            }
        }
        Err(RegressionError::NotConverged {
            degree: self.degree,
            iterations: MOST_CORRECTIONS,
        })
    }

    /// What β leaves of the normal equations, as the samples themselves say.
    fn gradient(&self, samples: Samples, penalty: Penalty, beta: &[f64]) -> Vec<f64> {
        let fitted = self.points.evaluate(samples.directions, beta);
        let mut residual: Vec<f64> = samples
            .values
            .iter()
            .zip(&fitted)
            .map(|(f, h)| f - self.mean - h)
            .collect();
        if let Some(weights) = &self.weights {
            for (r, w) in residual.iter_mut().zip(weights) {
                *r *= w;
            }
        }
        let mut gradient = self
            .points
            .moments(samples.directions, &residual, self.degree)
            .as_slice()
            .to_vec();
        for (i, g) in gradient.iter_mut().enumerate() {
            *g -= penalty.weight(index::degree_order(i).0) * beta[i];
        }
        gradient
    }

    /// The fit of the samples from that of their differences from the mean.
    fn finish(&self, mut beta: Vec<f64>) -> Result<Coefficients, RegressionError> {
        beta[0] += self.mean * (4.0 * std::f64::consts::PI).sqrt();
        Coefficients::new(beta).map_err(|_| self.rank_deficient())
    }
}
