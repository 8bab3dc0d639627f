//! Sums over the degrees of one order by a recurrence that advances two degrees per step.
//!
//! For an order m only P̄_m, P̄_{m+2}, … are computed, by a recurrence in z². The degrees between follow
//! from z P̄_l = ε_{l+1} P̄_{l+1} + ε_l P̄_{l−1}, where ε_lm = 1/a_lm of [`crate::legendre`]: they are z
//! times combinations of the computed ones, and the combination is applied to the coefficients
//! beforehand (Ishioka 2018). With P̄_{m+2k} = α_k q_k the recurrence is
//! q_{k+1} = (A_k z² + B_k) q_k − q_{k−1}, a third of the work of one degree per step.

use crate::index;
use crate::legendre::Legendre;

/// The coefficients of one q_k: cosine and sine parts of degree m + 2k, then cosine and sine parts of
/// z times the odd degrees.
pub(crate) type Folded = [f64; 4];

/// The recurrences of all orders up to a degree.
#[derive(Clone, Debug)]
pub(crate) struct TwoStep {
    degree: usize,
    /// P̄_m^m / sinᵐθ.
    first: Vec<f64>,
    /// (A_k, B_k), order after order.
    steps: Vec<(f64, f64)>,
    /// α_k.
    scales: Vec<f64>,
    /// (1/ε_{m+2k+1}, ε_{m+2k+2}); the first is zero if there is no such degree.
    links: Vec<(f64, f64)>,
    /// Index of the first step of each order, and the number of steps.
    starts: Vec<usize>,
}

impl TwoStep {
    /// The recurrences up to a degree; about L²/2 square roots.
    pub(crate) fn new(degree: usize) -> Self {
        let legendre = Legendre::new(degree + 2);
        let mut out = Self {
            degree,
            first: Vec::with_capacity(degree + 1),
            steps: Vec::new(),
            scales: Vec::new(),
            links: Vec::new(),
            starts: vec![0],
        };
        for m in 0..=degree {
            let (first, steps) = legendre.recurrence(m);
            out.first.push(first);
            // ε of degree m + i.
            let epsilon = |i: usize| if i == 0 { 0.0 } else { 1.0 / steps[i - 1].0 };
            let (mut before, mut here) = (1.0, 1.0);
            for i in (0..=degree - m).step_by(2) {
                let ahead = epsilon(i + 2) * epsilon(i + 1);
                let behind = if i == 0 {
                    ahead
                } else {
                    epsilon(i) * epsilon(i - 1)
                };
                let next = behind / ahead * before;
                let slope = here / (ahead * next);
                let middle = epsilon(i + 1).powi(2) + epsilon(i).powi(2);
                out.steps.push((slope, -middle * slope));
                out.scales.push(here);
                let odd = if m + i < degree {
                    1.0 / epsilon(i + 1)
                } else {
                    0.0
                };
                out.links.push((odd, epsilon(i + 2)));
                (before, here) = (here, next);
            }
            out.starts.push(out.steps.len());
        }
        out
    }

    /// L.
    pub(crate) fn degree(&self) -> usize {
        self.degree
    }

    /// Number of steps of all orders.
    pub(crate) fn len(&self) -> usize {
        self.steps.len()
    }

    /// Indices of the steps of order m.
    #[inline(always)]
    pub(crate) fn range(&self, m: usize) -> std::ops::Range<usize> {
        self.starts[m]..self.starts[m + 1]
    }

    /// q_0 without sinᵐθ, and the steps of order m.
    #[inline(always)]
    pub(crate) fn recurrence(&self, m: usize) -> (f64, &[(f64, f64)]) {
        (self.first[m], &self.steps[self.range(m)])
    }

    /// The coefficient of every q_k in Σ β P̄.
    pub(crate) fn fold(&self, beta: &[f64]) -> Vec<Folded> {
        let at = |l: usize, m: usize| {
            let centre = l * l + l;
            let sin = if m == 0 { 0.0 } else { beta[centre - m] };
            [beta[centre + m], sin]
        };
        let mut out = vec![[0.0; 4]; self.len()];
        for m in 0..=self.degree {
            let mut above = [0.0; 2];
            for (k, i) in self.range(m).enumerate().rev() {
                let l = m + 2 * k;
                let (inverse, next) = self.links[i];
                let even = at(l, m);
                let odd = if l < self.degree {
                    at(l + 1, m)
                } else {
                    [0.0; 2]
                };
                for part in 0..2 {
                    above[part] = (odd[part] - next * above[part]) * inverse;
                    out[i][part] = self.scales[i] * even[part];
                    out[i][2 + part] = self.scales[i] * above[part];
                }
            }
        }
        out
    }

    /// The adjoint of [`TwoStep::fold`].
    pub(crate) fn unfold(&self, folded: &[Folded]) -> Vec<f64> {
        let mut out = vec![0.0; index::count(self.degree)];
        for m in 0..=self.degree {
            let mut put = |l: usize, [cos, sin]: [f64; 2]| {
                let centre = l * l + l;
                out[centre + m] = cos;
                if m > 0 {
                    out[centre - m] = sin;
                }
            };
            let mut below = [0.0; 2];
            for (k, i) in self.range(m).enumerate() {
                let l = m + 2 * k;
                let scaled = folded[i].map(|x| self.scales[i] * x);
                put(l, [scaled[0], scaled[1]]);
                if l < self.degree {
                    let (inverse, next) = self.links[i];
                    let odd = [0, 1].map(|part| (scaled[2 + part] - below[part]) * inverse);
                    put(l + 1, odd);
                    below = odd.map(|x| next * x);
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rungs_sum_to_the_functions_and_unfold_is_the_adjoint() {
        for degree in [0, 1, 2, 3, 8, 9, 60] {
            let two_step = TwoStep::new(degree);
            let legendre = Legendre::new(degree);
            let beta: Vec<f64> = (0..index::count(degree))
                .map(|i| (1.3 * i as f64).sin())
                .collect();
            let folded = two_step.fold(&beta);
            for m in 0..=degree {
                for z in [-1.0, -0.3, 0.0, 0.8] {
                    let (first, steps) = two_step.recurrence(m);
                    let (mut before, mut here) = (0.0, first);
                    let (mut sum, mut size) = (0.0, 0.0);
                    for (term, (a, b)) in folded[two_step.range(m)].iter().zip(steps) {
                        sum += (term[0] + z * term[2]) * here;
                        (before, here) = (here, (a * z * z + b) * here - before);
                    }
                    let mut column = vec![0.0; degree - m + 1];
                    legendre.column(m, z, &mut column);
                    let mut plain = 0.0;
                    for (l, pi) in (m..).zip(&column) {
                        plain += pi * beta[l * l + l + m];
                        size += pi.abs();
                    }
                    assert!(
                        (sum - plain).abs() <= 1e-13 * size,
                        "L={degree} m={m} z={z}"
                    );
                }
            }
            // ⟨fold β, r⟩ = ⟨β, unfold r⟩ for folded that a sum may have: no sine of order 0.
            let mut other: Vec<Folded> = (0..two_step.len())
                .map(|i| std::array::from_fn(|j| (0.7 * (4 * i + j) as f64).cos()))
                .collect();
            for term in &mut other[two_step.range(0)] {
                (term[1], term[3]) = (0.0, 0.0);
            }
            let left: f64 = folded
                .iter()
                .zip(&other)
                .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>())
                .sum();
            let back = two_step.unfold(&other);
            let right: f64 = back.iter().zip(&beta).map(|(a, b)| a * b).sum();
            assert!((left - right).abs() <= 1e-11 * (1.0 + left.abs()));
        }
    }
}
