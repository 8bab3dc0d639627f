//! Damped least squares with box limits, for few variables.

use nalgebra::{DMatrix, DVector};

/// Termination criteria.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stopping {
    pub(crate) iterations: usize,
    /// Ends below this cost (half the sum of squares).
    pub(crate) cost: f64,
    /// Ends when a step lowers the cost by less than this share.
    pub(crate) decrease: f64,
}

/// Minimises ½|f(x)|² from `x` (Levenberg–Marquardt, forward differences); `project` moves a point
/// into its limits. Returns the cost; deterministic.
///
/// For the differences, `residuals` also receives the residuals at the base point. Entries that are
/// zero there may be skipped.
pub(crate) fn minimise(
    x: &mut DVector<f64>,
    stopping: Stopping,
    residuals: impl Fn(&DVector<f64>, Option<&DVector<f64>>) -> DVector<f64>,
    project: impl Fn(&mut DVector<f64>),
) -> f64 {
    let mut at = residuals(x, None);
    let mut cost = 0.5 * at.norm_squared();
    let mut damping = 1e-2;
    for _ in 0..stopping.iterations {
        if cost <= stopping.cost {
            break;
        }
        let slope = jacobian(x, &at, &residuals);
        let gradient = slope.tr_mul(&at);
        let curvature = slope.tr_mul(&slope);
        let mut lowered = false;
        while damping <= 1e8 {
            if let Some(step) = damped_step(&curvature, &gradient, damping) {
                let mut next = &*x - step;
                project(&mut next);
                let found = residuals(&next, None);
                let next_cost = 0.5 * found.norm_squared();
                if next_cost < cost {
                    lowered = cost - next_cost > stopping.decrease * cost;
                    *x = next;
                    at = found;
                    cost = next_cost;
                    damping = (damping * 0.2).max(1e-9);
                    break;
                }
            }
            damping *= 5.0;
        }
        if !lowered {
            break;
        }
    }
    cost
}

fn jacobian(
    x: &DVector<f64>,
    at: &DVector<f64>,
    residuals: &impl Fn(&DVector<f64>, Option<&DVector<f64>>) -> DVector<f64>,
) -> DMatrix<f64> {
    const STEP: f64 = 1e-6;
    let mut slope = DMatrix::zeros(at.len(), x.len());
    let mut moved = x.clone();
    for k in 0..x.len() {
        moved[k] += STEP;
        slope.set_column(k, &((residuals(&moved, Some(at)) - at) / STEP));
        moved[k] = x[k];
    }
    slope
}

/// (JᵀJ + λ diag(JᵀJ))⁻¹ Jᵀr, with a lower bound on the diagonal, so that variables without
/// influence do not move.
fn damped_step(
    curvature: &DMatrix<f64>,
    gradient: &DVector<f64>,
    damping: f64,
) -> Option<DVector<f64>> {
    let mut system = curvature.clone();
    let floor = 1e-9 + 1e-6 * curvature.diagonal().max();
    for k in 0..system.nrows() {
        system[(k, k)] += damping * curvature[(k, k)].max(floor);
    }
    system.cholesky().map(|c| c.solve(gradient))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_bottom_of_a_curved_valley_and_respects_limits() {
        let valley = |x: &DVector<f64>, _: Option<&DVector<f64>>| {
            DVector::from_vec(vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]])
        };
        let stopping = Stopping {
            iterations: 200,
            cost: 1e-20,
            decrease: 0.0,
        };
        let mut x = DVector::from_vec(vec![-1.2, 1.0]);
        let cost = minimise(&mut x, stopping, valley, |_| ());
        assert!(cost <= 1e-18 && (x[0] - 1.0).abs() <= 1e-6);
        let mut x = DVector::from_vec(vec![-1.2, 1.0]);
        minimise(&mut x, stopping, valley, |x| x[0] = x[0].min(0.5));
        assert!((x[0] - 0.5).abs() <= 1e-12 && (x[1] - 0.25).abs() <= 1e-3);
    }
}
