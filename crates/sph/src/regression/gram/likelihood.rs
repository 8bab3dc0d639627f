//! The choice of λ by restricted marginal likelihood, from solutions of the equations without a
//! determinant.

use super::Gram;
use crate::index;
use crate::regression::conjugate::Limits;
use crate::regression::penalty::roughness;
use crate::regression::{Penalty, RegressionError};

/// Range of log₁₀(λ/N) that is searched.
const RANGE: (f64, f64) = (-14.0, 0.0);
/// log₁₀(λ/N) at which the search starts.
const START: f64 = -8.0;
/// Longest step of the search, decades.
const LONGEST: f64 = 2.0;
/// The search ends with a step shorter than this, decades.
const SHORTEST: f64 = 0.05;

/// The root of the derivative of the likelihood by log λ.
pub(super) fn choose(gram: &Gram, power: i32) -> Result<Penalty, RegressionError> {
    let samples = gram.samples() as f64;
    let penalty = |log: f64| Penalty {
        lambda: samples * 10.0_f64.powf(log),
        power,
    };
    let probes = probes(gram.degree(), power);
    let mut beta = None;
    let mut balance = |log: f64| balance(gram, penalty(log), &probes, &mut beta);
    let root = find_root(RANGE, START, &mut balance)?;
    Ok(penalty(root))
}

/// log of (N−1) λ βᵀDβ / RSS divided by the degrees of freedom beyond the constant. It grows with λ and
/// is zero at the stationary point.
fn balance(
    gram: &Gram,
    penalty: Penalty,
    probes: &[Vec<f64>],
    beta: &mut Option<Vec<f64>>,
) -> Result<f64, RegressionError> {
    let unknowns = index::count(gram.degree()) as f64;
    let iterations = index::count(gram.degree());
    let fit = Limits {
        iterations,
        share: 1e-3,
        offset: gram.sum_squares(),
        floor: 1e-16 * gram.sum_squares(),
        fine: None,
    };
    // For large λ the quadratic of a probe tends to −trace/λ; trace + λ·quadratic is the degrees of freedom.
    let trace = Limits {
        iterations,
        share: 3e-3,
        offset: (unknowns - 1.0) / penalty.lambda,
        floor: 0.1 / penalty.lambda,
        fine: None,
    };
    let start = beta.take();
    let mut rights = vec![(gram.right(), start.as_deref(), fit)];
    rights.extend(probes.iter().map(|probe| (probe.as_slice(), None, trace)));
    let mut found = gram.solve_roughly(penalty, &rights)?;
    let traces = found.split_off(1);
    let freedom: f64 = traces
        .iter()
        .map(|outcome| unknowns - 1.0 + penalty.lambda * outcome.quadratic)
        .sum::<f64>()
        / traces.len().max(1) as f64;
    let outcome = found.swap_remove(0);
    // An exact fit would leave only rounding.
    let rss = (gram.sum_squares() + outcome.quadratic).max(1e-15 * gram.sum_squares());
    let rough: f64 = (0..)
        .zip(&outcome.solution)
        .map(|(i, b)| penalty.weight(index::degree_order(i).0) * b * b)
        .sum();
    *beta = Some(outcome.solution);
    let misfit = (gram.samples().max(2) as f64 - 1.0) * rough / rss.max(f64::MIN_POSITIVE);
    Ok(misfit.max(1e-9).ln() - freedom.max(1e-3).ln())
}

/// D^{1/2} z for fixed vectors of signs z: zᵀ D^{1/2} M⁻¹ D^{1/2} z estimates tr(M⁻¹D) (Hutchinson).
///
/// Few probes suffice for many unknowns: for even samples M⁻¹ is nearly diagonal, and only the entries off
/// the diagonal contribute to the error of the estimate.
fn probes(degree: usize, power: i32) -> Vec<Vec<f64>> {
    let unknowns = index::count(degree);
    let count = (5000 / unknowns).clamp(2, 16);
    (0..count)
        .map(|probe| {
            (0..unknowns)
                .map(|i| {
                    let (l, _) = index::degree_order(i);
                    let size = if l == 0 {
                        0.0
                    } else {
                        roughness(l, power).sqrt()
                    };
                    if sign_bit(i as u64, probe as u64) {
                        size
                    } else {
                        -size
                    }
                })
                .collect()
        })
        .collect()
}

/// A pseudorandom bit from two numbers (the finaliser of SplitMix64).
fn sign_bit(i: u64, j: u64) -> bool {
    let mut x = (i << 8 | j)
        .wrapping_add(1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x ^ (x >> 31)) & 1 == 1
}

/// Root of an increasing function of log₁₀ λ by safeguarded secant steps; the nearer end of the range if
/// there is no root.
fn find_root<E>(
    (mut low, mut high): (f64, f64),
    start: f64,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let ends = (low, high);
    let mut x = start;
    let mut before: Option<(f64, f64)> = None;
    for _ in 0..24 {
        let value = f(x)?;
        if value > 0.0 {
            high = x;
        } else {
            low = x;
        }
        // A first slope of 1 per unit of ln λ gives the fixed point iteration of Fellner and Schall.
        let slope = match before {
            Some((x0, f0)) if (value - f0) / (x - x0) > 0.2 => (value - f0) / (x - x0),
            _ => std::f64::consts::LN_10,
        };
        let mut next = x - (value / slope).clamp(-LONGEST, LONGEST);
        if next <= low || next >= high {
            let bracketed = low > ends.0 && high < ends.1;
            next = if bracketed {
                0.5 * (low + high)
            } else {
                next.clamp(low, high)
            };
        }
        if (next - x).abs() <= SHORTEST {
            return Ok(next);
        }
        before = Some((x, value));
        x = next;
    }
    Ok(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_found_or_the_nearer_end_taken() {
        let found = find_root(RANGE, START, |x| {
            Ok::<_, ()>((x + 5.3) * 1.1 + (x + 5.3).powi(3))
        });
        assert!((found.unwrap() + 5.3).abs() <= 0.1);
        assert_eq!(find_root(RANGE, START, |_| Ok::<_, ()>(1.0)), Ok(-14.0));
        assert_eq!(find_root(RANGE, START, |_| Ok::<_, ()>(-1.0)), Ok(0.0));
    }

    #[test]
    fn signs_are_balanced() {
        for j in 0..4 {
            let up = (0..4000).filter(|&i| sign_bit(i, j)).count();
            assert!(up.abs_diff(2000) < 150, "{up}");
        }
    }
}
