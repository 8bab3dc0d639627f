//! Conjugate gradients, stopped by an estimate of the error in the energy norm.

use super::lanczos::Lanczos;

/// Number of decrements in the error estimate.
const WINDOW: usize = 4;

/// The result of an iteration.
pub(super) struct Outcome {
    pub(super) solution: Vec<f64>,
    /// xᵀMx − 2bᵀx at the solution.
    pub(super) quadratic: f64,
    pub(super) iterations: usize,
    pub(super) converged: bool,
    /// Whether [`Limits::fine`] applied.
    pub(super) fine: bool,
}

/// When an iteration stops.
///
/// It stops at a squared error, in the norm of M, of at most share · |offset + q|, where q is the value
/// of the quadratic; or at `floor`, if that is larger.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// Largest number of iterations.
    pub(super) iterations: usize,
    /// Relative tolerance of the squared error.
    pub(super) share: f64,
    /// Added to the quadratic.
    pub(super) offset: f64,
    /// Absolute tolerance of the squared error.
    pub(super) floor: f64,
    /// A smaller tolerance for well conditioned systems.
    pub(super) fine: Option<Fine>,
}

/// A tolerance for well conditioned systems.
#[derive(Clone, Copy)]
pub(super) struct Fine {
    /// Largest condition number of CM for which it applies.
    pub(super) condition: f64,
    /// Replaces [`Limits::share`].
    pub(super) share: f64,
}

impl Limits {
    /// A squared error of `share` times the squared norm of the solution.
    pub(super) fn to(share: f64, iterations: usize) -> Self {
        Self {
            iterations,
            share,
            offset: 0.0,
            floor: 0.0,
            fine: None,
        }
    }
}

/// Solves Mx = b for a positive definite M, given as a function, with a preconditioner C ≈ M⁻¹.
///
/// Step k lowers the quadratic xᵀMx − 2bᵀx by α rᵀCr, and the sum of all later decrements is the
/// squared error in the norm of M (Hestenes and Stiefel 1952). The sum of the last few decrements estimates
/// it.
pub(super) fn solve(
    apply: impl Fn(&[f64]) -> Vec<f64>,
    precondition: impl Fn(&[f64]) -> Vec<f64>,
    right: &[f64],
    start: Option<&[f64]>,
    limits: Limits,
) -> Outcome {
    let mut x = vec![0.0; right.len()];
    let mut r = right.to_vec();
    let mut quadratic = 0.0;
    if let Some(start) = start {
        x.copy_from_slice(start);
        for (r, m) in r.iter_mut().zip(apply(start)) {
            *r -= m;
        }
        quadratic = -dot(right, start) - dot(&r, start);
    }
    let mut z = precondition(&r);
    let mut direction = z.clone();
    let mut energy = dot(&r, &z);
    let mut progress = Progress::new(limits);
    for iteration in 0..limits.iterations {
        if energy.is_nan() || energy <= 0.0 {
            // The residual is zero, or the matrix is not positive definite in floating point.
            return progress.outcome(x, quadratic, iteration, energy == 0.0);
        }
        let image = apply(&direction);
        let curvature = dot(&direction, &image);
        if curvature.is_nan() || curvature <= 0.0 {
            return progress.outcome(x, quadratic, iteration, false);
        }
        let alpha = energy / curvature;
        for i in 0..x.len() {
            x[i] += alpha * direction[i];
            r[i] -= alpha * image[i];
        }
        quadratic -= alpha * energy;
        if progress.suffices(alpha * energy, quadratic) {
            return progress.outcome(x, quadratic, iteration + 1, true);
        }
        z = precondition(&r);
        let next = dot(&r, &z);
        let beta = next / energy;
        progress.steps.push(alpha, beta);
        energy = next;
        for (d, z) in direction.iter_mut().zip(&z) {
            *d = z + beta * *d;
        }
    }
    progress.outcome(x, quadratic, limits.iterations, false)
}

/// The state of the stopping test.
struct Progress {
    limits: Limits,
    /// The last decrements.
    recent: [f64; WINDOW],
    at: usize,
    steps: Lanczos,
    /// Whether the tolerance for well conditioned systems applies.
    fine: bool,
}

impl Progress {
    fn new(limits: Limits) -> Self {
        Self {
            limits,
            recent: [f64::INFINITY; WINDOW],
            at: 0,
            steps: Lanczos::default(),
            fine: false,
        }
    }

    /// Whether the error is small enough after one more decrement, which led to `quadratic`.
    fn suffices(&mut self, decrement: f64, quadratic: f64) -> bool {
        let limits = &mut self.limits;
        self.recent[self.at % WINDOW] = decrement;
        self.at += 1;
        let error = self.recent.iter().sum::<f64>();
        let size = (limits.offset + quadratic).abs();
        if error > (limits.share * size).max(limits.floor) {
            return false;
        }
        let Some(fine) = limits.fine.take() else {
            return true;
        };
        self.fine = self.steps.condition() <= fine.condition;
        if self.fine {
            limits.share = fine.share;
        }
        error <= limits.share * size
    }

    fn outcome(&self, x: Vec<f64>, quadratic: f64, iterations: usize, converged: bool) -> Outcome {
        Outcome {
            solution: x,
            quadratic,
            iterations,
            converged,
            fine: self.fine,
        }
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_diagonal_system_from_any_start() {
        let diagonal: Vec<f64> = (1..60).map(|i| f64::from(i * i)).collect();
        let truth: Vec<f64> = (1..60).map(|i| f64::from(i).sin()).collect();
        let apply = |x: &[f64]| {
            x.iter()
                .zip(&diagonal)
                .map(|(x, d)| x * d)
                .collect::<Vec<_>>()
        };
        let right = apply(&truth);
        let limits = Limits {
            iterations: 400,
            share: 1e-24,
            offset: 0.0,
            floor: 0.0,
            fine: None,
        };
        for start in [None, Some(vec![0.5; truth.len()])] {
            let found = solve(apply, <[f64]>::to_vec, &right, start.as_deref(), limits);
            assert!(found.converged && found.iterations > 10);
            for (a, b) in found.solution.iter().zip(&truth) {
                assert!((a - b).abs() <= 1e-11);
            }
            assert!((found.quadratic + dot(&right, &truth)).abs() <= 1e-10 * dot(&right, &truth));
        }
    }
}
