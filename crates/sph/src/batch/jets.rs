//! Values, gradients and Hessians at many scattered points, with one point per vector lane.
//!
//! With F the polynomial extension of f to R³, ∂F/∂z of order m is a sum over Π^{m+1}, since
//! dΠ_l^m/dz = k_lm Π_l^{m+1}. So one recurrence per order serves the value and all derivatives; the
//! factors k_lm are multiplied into the coefficients beforehand.

use nalgebra::{Matrix3, Vector3};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::basis::{Ambient, Harmonic, Jet};
use crate::coefficients::Coefficients;
use crate::direction::{Direction, project_tangent};
use crate::lanes::{Lanes, coordinates, multiply_complex};
use crate::legendre::{Legendre, derivative_factor};
use crate::multiply_add::multiply_add;

/// Number of points that go through the recurrences together. It is lower than in the parent
/// module, since nine sums per point have to fit the vector registers.
const LANES: usize = 4;
type Lane = Lanes<LANES>;

/// Number of points per task.
const CHUNK: usize = 64;

/// f, ∇_S f and the covariant Hessian at all points, as [`crate::Basis::jet`] gives them.
///
/// About 9 L² flops per point.
pub fn jets(beta: &Coefficients, directions: &[Direction]) -> Vec<Jet> {
    let sums = ambient_sums::<3>(beta, directions);
    let jet = |(ambient, p): (&Ambient, &Direction)| ambient.jet(p);
    sums.iter().zip(directions).map(jet).collect()
}

/// f and ∇_S f at all points. About 7 L² flops per point.
pub fn values_and_gradients(beta: &Coefficients, directions: &[Direction]) -> Vec<Harmonic> {
    let sums = ambient_sums::<2>(beta, directions);
    let harmonic = |(ambient, p): (&Ambient, &Direction)| Harmonic {
        value: ambient.value,
        gradient: project_tangent(p, &ambient.gradient),
    };
    sums.iter().zip(directions).map(harmonic).collect()
}

/// F and its derivatives up to order PARTS − 1 at all points; higher derivatives stay zero.
fn ambient_sums<const PARTS: usize>(beta: &Coefficients, directions: &[Direction]) -> Vec<Ambient> {
    let legendre = Legendre::new(beta.degree());
    let coefficients = by_order::<PARTS>(beta);
    let mut out = vec![Ambient::default(); directions.len()];
    out.par_chunks_mut(CHUNK)
        .zip(directions.par_chunks(CHUNK))
        .for_each(|(out, directions)| {
            Arch::new().dispatch(Sums {
                legendre: &legendre,
                coefficients: &coefficients,
                directions,
                out,
            });
        });
    out
}

/// β_{l,±(n−d)} times the factors of d derivatives, d = 0 … PARTS − 1, for every order n of Π and
/// l = n … L: the coefficient of Π_l^n in the d-th derivative of order n − d. Cosine, then sine.
fn by_order<const PARTS: usize>(beta: &Coefficients) -> Vec<[[f64; 2]; PARTS]> {
    let degree = beta.degree();
    let mut out = Vec::with_capacity((degree + 1) * (degree + 2) / 2);
    for n in 0..=degree {
        for l in n..=degree {
            let mut factor = 1.0;
            out.push(std::array::from_fn(|d| {
                if d > n {
                    return [0.0; 2];
                }
                let m = n - d;
                if d > 0 {
                    factor *= derivative_factor(l, m);
                }
                let sin = if m == 0 {
                    0.0
                } else {
                    beta.as_slice()[l * l + l - m]
                };
                [factor * beta.as_slice()[l * l + l + m], factor * sin]
            }));
        }
    }
    out
}

struct Sums<'a, const PARTS: usize> {
    legendre: &'a Legendre,
    coefficients: &'a [[[f64; 2]; PARTS]],
    directions: &'a [Direction],
    out: &'a mut [Ambient],
}

impl<const PARTS: usize> WithSimd for Sums<'_, PARTS> {
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
            let mut powers = [[[0.0; LANES]; 2]; 3];
            powers[0][0] = [1.0; LANES];
            let mut totals = [[0.0; LANES]; TERMS];
            let mut rest = self.coefficients;
            for n in 0..=degree {
                let (column, later) = rest.split_at(degree + 1 - n);
                rest = later;
                let sums = order_sums::<S, PARTS>(self.legendre, n, &z, column);
                add_order(&mut totals, n, &sums, &powers);
                powers = [powers[0], powers[0], powers[1]];
                let [re, im] = &mut powers[0];
                multiply_complex(re, im, &x, &y);
            }
            for (k, ambient) in out.iter_mut().enumerate() {
                *ambient = gathered(&totals.map(|lane| lane[k]));
            }
        }
    }
}

/// Σ_l of one order of Π, cosine and sine, for every derivative.
#[inline(always)]
fn order_sums<S: Simd, const PARTS: usize>(
    legendre: &Legendre,
    n: usize,
    z: &Lane,
    column: &[[[f64; 2]; PARTS]],
) -> [[Lane; 2]; PARTS] {
    let (first, steps) = legendre.recurrence(n);
    let (mut before, mut here) = ([0.0; LANES], [first; LANES]);
    let mut sums = [[[0.0; LANES]; 2]; PARTS];
    add(&mut sums, &column[0], |k, c, s| {
        multiply_add::<S>(here[k], c, s)
    });
    for (&(a, b), factors) in steps.iter().zip(&column[1..]) {
        for k in 0..LANES {
            let next = multiply_add::<S>(a * z[k], here[k], -(b * before[k]));
            before[k] = here[k];
            here[k] = next;
        }
        add(&mut sums, factors, |k, c, s| {
            multiply_add::<S>(here[k], c, s)
        });
    }
    sums
}

/// sum ← step(lane, factor, sum) throughout.
#[inline(always)]
fn add<const PARTS: usize>(
    sums: &mut [[Lane; 2]; PARTS],
    factors: &[[f64; 2]; PARTS],
    step: impl Fn(usize, f64, f64) -> f64,
) {
    for (sums, factors) in sums.iter_mut().zip(factors) {
        for (sum, &factor) in sums.iter_mut().zip(factors) {
            for (k, s) in sum.iter_mut().enumerate() {
                *s = step(k, factor, *s);
            }
        }
    }
}

/// F, F_x, F_y, F_z, F_xx, F_xy, F_xz, F_yz, F_zz.
const TERMS: usize = 9;

/// Adds the terms of order n of Π: the value for m = n, ∂_z for m = n − 1, ∂_z² for m = n − 2.
/// `powers` are (x+iy)^n, (x+iy)^{n−1}, (x+iy)^{n−2}.
#[inline(always)]
fn add_order<const PARTS: usize>(
    totals: &mut [Lane; TERMS],
    n: usize,
    sums: &[[Lane; 2]; PARTS],
    powers: &[[Lane; 2]; 3],
) {
    for k in 0..LANES {
        let power = |d: usize| powers.get(d).map_or((0.0, 0.0), |p| (p[0][k], p[1][k]));
        for (d, part) in sums.iter().enumerate() {
            let (c, s) = (part[0][k], part[1][k]);
            // c Re (x+iy)ᵐ + s Im (x+iy)ᵐ; ∂_x and ∂_y lower the power by one and multiply by m.
            let m = n.saturating_sub(d) as f64;
            let ((re, im), (re1, im1), (re2, im2)) = (power(d), power(d + 1), power(d + 2));
            let here = c * re + s * im;
            let along_x = m * (c * re1 + s * im1);
            let along_y = m * (s * re1 - c * im1);
            let curve = m * (m - 1.0);
            match d {
                0 => {
                    totals[0][k] += here;
                    totals[1][k] += along_x;
                    totals[2][k] += along_y;
                    if PARTS > 2 {
                        totals[4][k] += curve * (c * re2 + s * im2);
                        totals[5][k] += curve * (s * re2 - c * im2);
                    }
                }
                1 => {
                    totals[3][k] += here;
                    totals[6][k] += along_x;
                    totals[7][k] += along_y;
                }
                _ => totals[8][k] += here,
            }
        }
    }
}

/// The sums at one point as a value, gradient and Hessian. Every order of F is harmonic in x and y, so
/// F_yy = −F_xx.
fn gathered(t: &[f64; TERMS]) -> Ambient {
    Ambient {
        value: t[0],
        gradient: Vector3::new(t[1], t[2], t[3]),
        hessian: Matrix3::new(t[4], t[5], t[6], t[5], -t[4], t[7], t[6], t[7], t[8]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::Basis;
    use crate::direction::{even_directions, retract};
    use crate::index;

    #[test]
    fn lanes_agree_with_the_plain_path_to_degree_300() {
        for (degree, count) in [(0, 3), (1, 5), (2, 9), (50, 131), (300, 18)] {
            let mut beta = Coefficients::constant(degree, 1.0);
            for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
                let (l, _) = index::degree_order(i);
                *b = 0.2 * (1.7 * i as f64).sin() / (l * l) as f64;
            }
            let mut points = even_directions(count);
            let near = Vector3::new(2e-9, -1e-9, 3e-9);
            for axis in [Vector3::x_axis(), Vector3::z_axis()] {
                points.extend([axis, -axis, retract(&axis, &near), retract(&-axis, &near)]);
            }
            let basis = Basis::new(degree);
            let mut work = basis.workspace();
            let exact: Vec<Jet> = points
                .iter()
                .map(|p| basis.jet(&beta, p, &mut work))
                .collect();
            let largest =
                |size: &dyn Fn(&Jet) -> f64| exact.iter().map(size).fold(1e-300, f64::max);
            let value = largest(&|j| j.value.abs());
            let slope = largest(&|j| j.gradient.norm());
            let bend = largest(&|j| j.hessian.norm());
            let first = values_and_gradients(&beta, &points);
            for ((jet, plain), first) in jets(&beta, &points).iter().zip(&exact).zip(&first) {
                assert!((jet.value - plain.value).abs() <= 1e-13 * value);
                assert!((jet.gradient - plain.gradient).norm() <= 1e-12 * slope);
                assert!(
                    (jet.hessian - plain.hessian).norm() <= 1e-12 * bend,
                    "L={degree}"
                );
                assert_eq!((first.value, first.gradient), (jet.value, jet.gradient));
            }
        }
    }
}
