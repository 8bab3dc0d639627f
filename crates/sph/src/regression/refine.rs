//! Solutions of the normal equations, refined with the residuals of the samples.

use super::conjugate::{Fine, Limits, dot};
use super::gram::Gram;
use super::{Penalty, RegressionError, Samples};
use crate::coefficients::Coefficients;
use crate::index;

/// Largest number of corrections.
const MOST_CORRECTIONS: usize = 6;
/// The refinement ends with a correction below this share of the norm of β.
const SETTLED: f64 = 1e-6;

/// Corrections below this share of the mean are rounding: the values of a constant function differ
/// from their mean by no more.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// If ρ̃⁻¹ YᵀWY has at most this condition number, β loses at most three of the fourteen digits of the
/// sums on the grid, and no correction from the samples is needed.
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

    /// Corrects β with the residuals of the samples until the corrections are small.
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

    /// The residual of the normal equations at β, computed from the residuals of the samples.
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

    /// Adds the mean of the samples to the fit of their differences from it.
    fn finish(&self, mut beta: Vec<f64>) -> Result<Coefficients, RegressionError> {
        beta[0] += self.mean * (4.0 * std::f64::consts::PI).sqrt();
        Coefficients::new(beta).map_err(|_| self.rank_deficient())
    }
}
