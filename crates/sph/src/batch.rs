//! Sums over all harmonics at many scattered points, with one point per vector lane.
//!
//! The recurrences are those of [`crate::basis`], and the tests compare the two. The order of additions
//! is fixed, so the results do not depend on the number of threads.

mod jets;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

pub use jets::{jets, values_and_gradients};

use crate::coefficients::Coefficients;
use crate::direction::Direction;
use crate::index;
use crate::lanes::{Lanes, coordinates, multiply_complex};
use crate::legendre::Legendre;

/// Number of points that go through the recurrences together. With 16, two recurrences and two sums
/// fit the vector registers.
const LANES: usize = 16;
type Lane = Lanes<LANES>;

/// Number of points per task of [`evaluate`].
const CHUNK: usize = 256;

/// f(pᵢ) = Σ β_{lm} Y_{lm}(pᵢ) for all i. About 4 L² flops per point.
pub fn evaluate(beta: &Coefficients, directions: &[Direction]) -> Vec<f64> {
    let legendre = Legendre::new(beta.degree());
    let mut out = vec![0.0; directions.len()];
    out.par_chunks_mut(CHUNK)
        .zip(directions.par_chunks(CHUNK))
        .for_each(|(out, directions)| {
            Arch::new().dispatch(Evaluate {
                legendre: &legendre,
                beta: beta.as_slice(),
                directions,
                out,
            });
        });
    out
}

/// Σᵢ wᵢ Y_{lm}(pᵢ) for all l ≤ L: the adjoint of [`evaluate`]. About 4 L² flops per point.
///
/// # Panics
/// `weights` does not have one entry per direction.
pub fn moments(directions: &[Direction], weights: &[f64], degree: usize) -> Coefficients {
    assert_eq!(directions.len(), weights.len(), "one weight per direction");
    let legendre = Legendre::new(degree);
    let mut sums = vec![[0.0; LANES]; index::count(degree)];
    Arch::new().dispatch(Moments {
        legendre: &legendre,
        directions,
        weights,
        sums: &mut sums,
    });
    let mut out = Coefficients::zeros(degree);
    for (total, lanes) in out.as_mut_slice().iter_mut().zip(&sums) {
        *total = lanes.iter().sum();
    }
    out
}

struct Evaluate<'a> {
    legendre: &'a Legendre,
    beta: &'a [f64],
    directions: &'a [Direction],
    out: &'a mut [f64],
}

impl WithSimd for Evaluate<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let degree = self.legendre.degree();
        for (points, out) in self
            .directions
            .chunks(LANES)
            .zip(self.out.chunks_mut(LANES))
        {
            let [x, y, z] = coordinates(points);
            let (mut re, mut im) = ([1.0; LANES], [0.0; LANES]);
            let mut total = [0.0; LANES];
            for m in 0..=degree {
                let (cos, sin) = sum_order(self.legendre, m, &z, self.beta);
                for k in 0..LANES {
                    total[k] += cos[k] * re[k] + sin[k] * im[k];
                }
                multiply_complex(&mut re, &mut im, &x, &y);
            }
            out.copy_from_slice(&total[..out.len()]);
        }
    }
}

/// Σ_l β_{l,m} Π_l^m and Σ_l β_{l,−m} Π_l^m for one order.
#[inline(always)]
fn sum_order(legendre: &Legendre, m: usize, z: &Lane, beta: &[f64]) -> (Lane, Lane) {
    let (first, steps) = legendre.recurrence(m);
    let (mut before, mut here) = ([0.0; LANES], [first; LANES]);
    let mut centre = m * m + m;
    let mut cos = [first * beta[centre + m]; LANES];
    let mut sin = [first * beta[centre - m]; LANES];
    for (l, &(a, b)) in (m + 1..).zip(steps) {
        centre += 2 * l;
        let (up, down) = (beta[centre + m], beta[centre - m]);
        for k in 0..LANES {
            let next = a * z[k] * here[k] - b * before[k];
            before[k] = here[k];
            here[k] = next;
            cos[k] += next * up;
            sin[k] += next * down;
        }
    }
    (cos, sin)
}

struct Moments<'a> {
    legendre: &'a Legendre,
    directions: &'a [Direction],
    weights: &'a [f64],
    sums: &'a mut [Lane],
}

impl WithSimd for Moments<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let degree = self.legendre.degree();
        for (points, weights) in self
            .directions
            .chunks(LANES)
            .zip(self.weights.chunks(LANES))
        {
            let [x, y, z] = coordinates(points);
            let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
            re[..weights.len()].copy_from_slice(weights);
            for m in 0..=degree {
                add_order(self.legendre, m, &z, &re, &im, self.sums);
                multiply_complex(&mut re, &mut im, &x, &y);
            }
        }
    }
}

/// Adds w Π_l^m Re (x+iy)ᵐ and w Π_l^m Im (x+iy)ᵐ of one order to the lanes of each harmonic.
#[inline(always)]
fn add_order(legendre: &Legendre, m: usize, z: &Lane, re: &Lane, im: &Lane, sums: &mut [Lane]) {
    let (first, steps) = legendre.recurrence(m);
    let (mut before, mut here) = ([0.0; LANES], [first; LANES]);
    let mut centre = m * m + m;
    add_lane(&mut sums[centre + m], &here, re);
    if m > 0 {
        add_lane(&mut sums[centre - m], &here, im);
    }
    for (l, &(a, b)) in (m + 1..).zip(steps) {
        centre += 2 * l;
        for k in 0..LANES {
            let next = a * z[k] * here[k] - b * before[k];
            before[k] = here[k];
            here[k] = next;
        }
        add_lane(&mut sums[centre + m], &here, re);
        if m > 0 {
            add_lane(&mut sums[centre - m], &here, im);
        }
    }
}

#[inline(always)]
fn add_lane(sum: &mut Lane, a: &Lane, b: &Lane) {
    for k in 0..LANES {
        sum[k] += a[k] * b[k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::Basis;
    use crate::direction::even_directions;

    #[test]
    fn lanes_agree_with_the_plain_path() {
        for (degree, count) in [(0, 5), (3, 16), (50, 133), (100, 40)] {
            let points = even_directions(count);
            let basis = Basis::new(degree);
            let mut work = basis.workspace();
            let mut beta = Coefficients::zeros(degree);
            for (i, b) in beta.as_mut_slice().iter_mut().enumerate() {
                *b = (i as f64 * 0.37).cos();
            }
            let fast = evaluate(&beta, &points);
            let weights: Vec<f64> = (0..count).map(|i| (i as f64).sin()).collect();
            let adjoint = moments(&points, &weights, degree);
            let mut plain = vec![0.0; basis.len()];
            let mut values = vec![0.0; basis.len()];
            for ((p, w), f) in points.iter().zip(&weights).zip(&fast) {
                assert!((basis.sum(&beta, p, &mut work) - f).abs() <= 1e-11);
                basis.values(p, &mut work, &mut values);
                for (s, y) in plain.iter_mut().zip(&values) {
                    *s += w * y;
                }
            }
            for (a, b) in adjoint.as_slice().iter().zip(&plain) {
                assert!((a - b).abs() <= 1e-11);
            }
        }
    }
}
