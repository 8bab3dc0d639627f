//! Least squares through the Gram matrix YᵀWY, which is never formed from the points.
//!
//! The moments ρ_{LM} = Σᵢ wᵢ Y_{LM}(pᵢ) up to degree 2L define a density ρ = Σ ρ_{LM} Y_{LM}. For
//! harmonics of degree ≤ L, (YᵀWY)_{ab} = ∫ ρ Y_a Y_b exactly, and Gauss–Legendre rings exact to degree
//! 4L give the integral. One pass over the points yields the moments; nothing after it depends on the
//! number of points. For conjugate gradients the matrix is applied as multiplication by ρ on the grid;
//! for a Cholesky factor it is assembled ring by ring.

mod likelihood;

use std::borrow::Cow;
use std::sync::OnceLock;

use rayon::prelude::*;

use super::conjugate::{self, Limits, Outcome, dot};
use super::dense::{Dense, Factor};
use super::operator::Multiplier;
use super::points::Points;
use super::{Method, Penalty, RegressionError, Samples, qr};
use crate::coefficients::Coefficients;
use crate::index;

/// Largest degree at which a dense factor costs less than iterations.
const SMALL_DEGREE: usize = 16;
/// Largest degree at which a dense factor is used if the iteration fails.
const DENSE_DEGREE: usize = 80;

/// A right-hand side, a start vector, and when to stop.
pub(super) type Task<'a> = (&'a [f64], Option<&'a [f64]>, Limits);

/// Largest number of iterations when there is no other method.
pub(super) const MOST_ITERATIONS: usize = 5000;

/// The normal equations of a set of samples at one degree.
///
/// They are assembled once and solved for any penalty. The solves take the samples again, since the last
/// digits come from their residuals.
pub struct Gram {
    pub(super) degree: usize,
    samples: usize,
    pub(super) weights: Option<Vec<f64>>,
    pub(super) points: Points,
    density: Coefficients,
    /// YᵀWY as multiplication by ρ.
    operator: Multiplier,
    /// Multiplication by 1/ρ̃ with ρ̃ smooth and positive: the preconditioner.
    inverse: Multiplier,
    /// YᵀW(f − mean), position l²+l+m.
    right: Vec<f64>,
    /// Σ w (fᵢ − mean)².
    sum_squares: f64,
    /// Weighted mean of the values.
    pub(super) mean: f64,
    dense: OnceLock<Dense>,
}

/// The solution of [`Gram::solve`] and its condition number.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The coefficients β.
    pub coefficients: Coefficients,
    /// Condition number of [√W Y; √penalty], to about ten per cent.
    pub condition: f64,
}

impl Gram {
    /// The equations of unweighted samples. About 2,000 flops per point and 50 L³.
    ///
    /// # Errors
    /// As [`Samples::check`].
    pub fn new(samples: Samples, degree: usize) -> Result<Self, RegressionError> {
        Self::build(samples, None, degree)
    }

    /// The equations of samples with one weight ≥ 0 per sample: Σ wᵢ (h(pᵢ) − fᵢ)².
    ///
    /// # Errors
    /// As [`Samples::check`], and [`RegressionError::Weight`].
    pub fn weighted(
        samples: Samples,
        weights: &[f64],
        degree: usize,
    ) -> Result<Self, RegressionError> {
        Self::build(samples, Some(weights.to_vec()), degree)
    }

    fn build(
        samples: Samples,
        weights: Option<Vec<f64>>,
        degree: usize,
    ) -> Result<Self, RegressionError> {
        samples.check()?;
        let count = samples.values.len();
        let points = Points::new(samples.directions, degree);
        let ones = vec![1.0; if weights.is_none() { count } else { 0 }];
        let w = weights.as_deref().unwrap_or(&ones);
        check_weights(w, count)?;
        let mean = dot(w, samples.values) / w.iter().sum::<f64>();
        let used = w.iter().filter(|&&w| w > 0.0).count();
        let density = points.moments(samples.directions, w, 2 * degree);
        // There may be millions of samples: what is not needed again is freed.
        drop(ones);
        let centred: Vec<f64> = samples.values.iter().map(|f| f - mean).collect();
        let weighted = weights.as_ref().map_or(Cow::Borrowed(&centred), |w| {
            Cow::Owned(centred.iter().zip(w).map(|(f, w)| f * w).collect())
        });
        let right = points.moments(samples.directions, &weighted, degree);
        Ok(Self {
            degree,
            samples: used,
            operator: Multiplier::new(degree, 2 * degree + 1, 4 * degree + 1, &density, |g| g),
            inverse: inverse_density(&density, degree),
            right: right.as_slice().to_vec(),
            sum_squares: dot(&centred, &weighted),
            mean,
            points,
            density,
            weights,
            dense: OnceLock::new(),
        })
    }

    /// L.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// argmin Σᵢ wᵢ (h(pᵢ) − fᵢ)² + penalty, refined with the residuals of the samples, and its condition
    /// number. `samples` are those that the system was assembled from.
    ///
    /// # Errors
    /// As [`Gram::coefficients`].
    pub fn solve(&self, samples: Samples, penalty: Penalty) -> Result<Solution, RegressionError> {
        let coefficients = self.coefficients(samples, penalty, Method::Automatic)?;
        Ok(Solution {
            condition: self.condition(penalty)?,
            coefficients,
        })
    }

    /// β alone, by a given method. `samples` are those that the system was assembled from.
    ///
    /// # Errors
    /// λ is not a finite number ≥ 0, the samples do not determine the coefficients, or the solution did not
    /// reach its accuracy.
    pub fn coefficients(
        &self,
        samples: Samples,
        penalty: Penalty,
        method: Method,
    ) -> Result<Coefficients, RegressionError> {
        penalty.check()?;
        if penalty.lambda == 0.0 && self.samples < index::count(self.degree) {
            return Err(self.rank_deficient());
        }
        match method {
            Method::Automatic if self.prefers_dense() => self.by_factor(samples, penalty),
            Method::Automatic => {
                match self.by_iteration(samples, penalty, self.most_iterations()) {
                    Err(RegressionError::NotConverged { .. }) if self.degree <= DENSE_DEGREE => {
                        self.by_factor(samples, penalty)
                    }
                    found => found,
                }
            }
            Method::Conjugate => self.by_iteration(samples, penalty, MOST_ITERATIONS),
            Method::Cholesky => self.by_factor(samples, penalty),
            Method::Qr => qr::fit_weighted(samples, self.weights.as_deref(), self.degree, penalty),
        }
    }

    /// YᵀWf for other values f at the directions of the samples, position l²+l+m.
    ///
    /// # Errors
    /// As [`Samples::check`], or the number of samples is another one.
    pub fn right_hand_side(&self, samples: Samples) -> Result<Vec<f64>, RegressionError> {
        samples.check()?;
        let weighted: Vec<f64> = match &self.weights {
            None => samples.values.to_vec(),
            Some(weights) if weights.len() == samples.values.len() => {
                let pairs = samples.values.iter().zip(weights);
                pairs.map(|(f, w)| f * w).collect()
            }
            Some(weights) => {
                return Err(RegressionError::Weight {
                    index: weights.len().min(samples.values.len()),
                    value: f64::NAN,
                });
            }
        };
        let moments = self
            .points
            .moments(samples.directions, &weighted, self.degree);
        Ok(moments.as_slice().to_vec())
    }

    /// β for a right-hand side of [`Gram::right_hand_side`], by conjugate gradients from `start`.
    ///
    /// The relative error of β, in the norm of the system, is about 3e-6: enough for steps of a
    /// continuation, and several times cheaper than [`Gram::coefficients`].
    ///
    /// # Errors
    /// As [`Gram::coefficients`].
    pub fn continued(
        &self,
        right: &[f64],
        penalty: Penalty,
        start: Option<&Coefficients>,
    ) -> Result<Coefficients, RegressionError> {
        penalty.check()?;
        if self.prefers_dense() {
            let beta = self.factor(penalty)?.solve(right);
            return Coefficients::new(beta).map_err(|_| self.rank_deficient());
        }
        let limits = Limits::to(1e-11, MOST_ITERATIONS);
        let start = start.map(Coefficients::as_slice);
        let outcome = self.iterate(penalty, right, start, limits)?;
        Coefficients::new(outcome.solution).map_err(|_| self.rank_deficient())
    }

    /// Condition number of [√W Y; √penalty], to about ten per cent, by power and inverse iteration.
    ///
    /// # Errors
    /// As [`Gram::coefficients`].
    pub fn condition(&self, penalty: Penalty) -> Result<f64, RegressionError> {
        penalty.check()?;
        let start: Vec<f64> = (0..index::count(self.degree))
            .map(|i| 1.0 + 0.5 * (i as f64 * 1.618).sin())
            .collect();
        let largest = eigenvalue(start.clone(), 12, |x| Ok(self.apply(penalty, x)))?;
        let inverse = if self.prefers_dense() {
            let factor = self.factor(penalty)?;
            eigenvalue(start, 6, |x| Ok(factor.solve(x)))
        } else {
            let limits = Limits::to(1e-2, self.most_iterations());
            let inverse = eigenvalue(start.clone(), 6, |x| {
                self.iterate(penalty, x, None, limits).map(|o| o.solution)
            });
            if inverse.is_err() && self.degree <= DENSE_DEGREE {
                let factor = self.factor(penalty)?;
                eigenvalue(start, 6, |x| Ok(factor.solve(x)))
            } else {
                inverse
            }
        }?;
        Ok((largest * inverse).sqrt())
    }

    /// Whether the dense matrix exists already or is cheap.
    fn prefers_dense(&self) -> bool {
        self.degree <= SMALL_DEGREE || self.dense.get().is_some()
    }

    /// The number of iterations that cost about as much as a dense factor, if one is affordable.
    fn most_iterations(&self) -> usize {
        if self.degree <= DENSE_DEGREE {
            200 + index::count(self.degree) / 5
        } else {
            MOST_ITERATIONS
        }
    }

    /// The λ that maximises the restricted marginal likelihood of the samples (REML).
    ///
    /// Model: fᵢ = h(pᵢ) + noise of variance σ²/wᵢ, β_{lm} ~ N(0, σ² / (λ(l(l+1))^power)) for l ≥ 1,
    /// flat in the constant. Its derivative vanishes where
    /// (N−1) λ βᵀDβ / RSS = Σ over l ≥ 1 of the degrees of freedom, where RSS is the penalised sum of
    /// squared residuals. Secant steps in log λ find the root within λ/N ∈ [1e−14, 1] to a twentieth of a
    /// decade; Hutchinson's estimate with fixed signs gives the degrees of freedom.
    ///
    /// # Errors
    /// A system on the way could not be solved ([`RegressionError::NotConverged`] or
    /// [`RegressionError::RankDeficient`]).
    pub fn choose_penalty(&self, power: i32) -> Result<Penalty, RegressionError> {
        likelihood::choose(self, power)
    }

    /// Number of samples with a positive weight.
    pub(super) fn samples(&self) -> usize {
        self.samples
    }

    pub(super) fn right(&self) -> &[f64] {
        &self.right
    }

    pub(super) fn sum_squares(&self) -> f64 {
        self.sum_squares
    }

    /// M⁻¹ b for several right-hand sides to the given limits, by iteration or by the factor.
    pub(super) fn solve_roughly(
        &self,
        penalty: Penalty,
        tasks: &[Task],
    ) -> Result<Vec<Outcome>, RegressionError> {
        if !self.prefers_dense() {
            let found: Result<Vec<Outcome>, RegressionError> = tasks
                .par_iter()
                .map(|&(right, start, limits)| self.iterate(penalty, right, start, limits))
                .collect();
            if found.is_ok() || self.degree > DENSE_DEGREE {
                return found;
            }
        }
        let factor = self.factor(penalty)?;
        Ok(tasks
            .iter()
            .map(|(right, ..)| {
                let solution = factor.solve(right);
                Outcome {
                    quadratic: -dot(right, &solution),
                    solution,
                    iterations: 0,
                    converged: true,
                    fine: false,
                }
            })
            .collect())
    }

    /// Conjugate gradients on YᵀWY + penalty.
    pub(super) fn iterate(
        &self,
        penalty: Penalty,
        right: &[f64],
        start: Option<&[f64]>,
        limits: Limits,
    ) -> Result<Outcome, RegressionError> {
        let mean_density = self.density.as_slice()[0] / (4.0 * std::f64::consts::PI).sqrt();
        let share = |i: usize| {
            let (l, _) = index::degree_order(i);
            1.0 / (1.0 + penalty.weight(l) / mean_density)
        };
        let shares: Vec<f64> = (0..right.len()).map(share).collect();
        let scaled =
            |x: &[f64]| -> Vec<f64> { x.iter().zip(&shares).map(|(x, p)| x * p).collect() };
        // (ρ + λd)⁻¹ ≈ p ρ̃⁻¹ p + (1−p) p / ρ̄ with p = 1/(1 + λd/ρ̄): exact if ρ is constant.
        let precondition = |r: &[f64]| {
            let mut out = scaled(&self.inverse.apply(&scaled(r)));
            for ((out, r), p) in out.iter_mut().zip(r).zip(&shares) {
                *out += (1.0 - p) * p / mean_density * r;
            }
            out
        };
        let apply = |x: &[f64]| self.apply(penalty, x);
        let outcome = conjugate::solve(apply, precondition, right, start, limits);
        if outcome.converged {
            Ok(outcome)
        } else {
            Err(RegressionError::NotConverged {
                degree: self.degree,
                iterations: outcome.iterations,
            })
        }
    }

    /// (YᵀWY + penalty) x.
    fn apply(&self, penalty: Penalty, x: &[f64]) -> Vec<f64> {
        let mut image = self.operator.apply(x);
        if penalty.lambda > 0.0 {
            add_penalty(penalty, x, &mut image);
        }
        image
    }

    pub(super) fn factor(&self, penalty: Penalty) -> Result<Factor<'_>, RegressionError> {
        let dense = self
            .dense
            .get_or_init(|| Dense::new(&self.density, self.degree));
        let factor = dense.factor(penalty).ok_or_else(|| self.rank_deficient())?;
        // The pivots of the factor are those of R in Y = QR; pivots below √ε of the largest are rounding.
        if factor.pivot_ratio < 1e8 || penalty.lambda > 0.0 {
            Ok(factor)
        } else {
            Err(self.rank_deficient())
        }
    }

    pub(super) fn rank_deficient(&self) -> RegressionError {
        RegressionError::RankDeficient {
            samples: self.samples,
            coefficients: index::count(self.degree),
            degree: self.degree,
        }
    }
}

/// The unweighted fit of degree L alone: [`Gram::new`], then [`Gram::coefficients`] by
/// [`Method::Automatic`].
///
/// # Errors
/// As [`Gram::new`] and [`Gram::coefficients`].
pub fn fit(
    samples: Samples,
    degree: usize,
    penalty: Penalty,
) -> Result<Coefficients, RegressionError> {
    Gram::new(samples, degree)?.coefficients(samples, penalty, Method::Automatic)
}

fn check_weights(weights: &[f64], samples: usize) -> Result<(), RegressionError> {
    if weights.len() != samples {
        return Err(RegressionError::Weight {
            index: samples,
            value: f64::NAN,
        });
    }
    let bad = |w: &f64| !(*w >= 0.0 && w.is_finite());
    if let Some(index) = weights.iter().position(bad) {
        return Err(RegressionError::Weight {
            index,
            value: weights[index],
        });
    }
    if weights.iter().all(|&w| w == 0.0) {
        return Err(RegressionError::Weight {
            index: 0,
            value: 0.0,
        });
    }
    Ok(())
}

/// Multiplication by 1/ρ̃, where ρ̃ is ρ smoothed over about three wave lengths and at least 2 % of its
/// mean.
fn inverse_density(density: &Coefficients, degree: usize) -> Multiplier {
    let mut smooth = density.with_degree(degree);
    let width = 0.35 * degree.max(1) as f64;
    for (i, c) in smooth.as_mut_slice().iter_mut().enumerate() {
        let (l, _) = index::degree_order(i);
        *c *= (-((l * (l + 1)) as f64) / (width * width)).exp();
    }
    let mean = density.as_slice()[0] / (4.0 * std::f64::consts::PI).sqrt();
    Multiplier::new(degree, degree + 1, 2 * degree + 1, &smooth, |g| {
        1.0 / g.max(0.02 * mean)
    })
}

fn add_penalty(penalty: Penalty, x: &[f64], image: &mut [f64]) {
    let degree = x.len().isqrt() - 1;
    for l in 1..=degree {
        let weight = penalty.weight(l);
        for i in l * l..(l + 1) * (l + 1) {
            image[i] += weight * x[i];
        }
    }
}

/// Largest eigenvalue of a positive operator by power iteration, from below.
fn eigenvalue(
    mut x: Vec<f64>,
    steps: usize,
    apply: impl Fn(&[f64]) -> Result<Vec<f64>, RegressionError>,
) -> Result<f64, RegressionError> {
    let mut value = 0.0;
    for _ in 0..steps {
        let length = dot(&x, &x).sqrt();
        for x in &mut x {
            *x /= length;
        }
        x = apply(&x)?;
        value = dot(&x, &x).sqrt();
    }
    Ok(value)
}
