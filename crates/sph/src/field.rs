//! Repeated evaluation of one function and its derivatives at arbitrary points.
//!
//! Summing (L+1)² terms at every point dwarfs everything else in an ascent. A [`Field`] sums them
//! once, on fine grids of two charts of the sphere, and reads a point from its 16×16 neighbours.

use nalgebra::{Matrix3, Vector3};
use pulp::{Arch, Simd, WithSimd};

use crate::basis::Jet;
use crate::coefficients::Coefficients;
use crate::direction::Direction;
use crate::fused::multiply_add;
use crate::kernel::TAPS;
use crate::rotation::{cyclic, rotate};
use crate::torus::{Torus, TorusGrid};

/// Why fields do not combine.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FieldError {
    /// Degrees or tolerances differ, so the grids do.
    #[error(
        "field {index} is of degree {degree} with {taps} taps; the first has degree {first_degree} with {first_taps}"
    )]
    Mismatch {
        /// Which field.
        index: usize,
        /// Its degree.
        degree: usize,
        /// Its window.
        taps: usize,
        /// Degree of the first.
        first_degree: usize,
        /// Window of the first.
        first_taps: usize,
    },
    /// There is nothing to combine.
    #[error("no fields")]
    Empty,
}

/// Lower degrees are held as this one: a window needs a grid of its own width at least.
const LEAST_DEGREE: usize = 8;

/// A function on the sphere, ready to be read anywhere in well below a microsecond.
///
/// Linear in the coefficients: the field of Σ αᵢ βᵢ is [`Field::combine`] of the fields, a sum over
/// grids. With M = max |f − mean| and L at least 8, errors of value, gradient and Hessian are below tolerance · M,
/// tolerance · L M and tolerance · L² M, down to 2e-12; the value alone is 100 to 1000 times better.
/// Memory: about 200 L² bytes a chart at L = 50.
#[derive(Clone, Debug)]
pub struct Field {
    torus: Torus,
    /// The chart with its axis along z, and the one along x.
    charts: [TorusGrid; 2],
    /// The constant part, which needs no grid.
    mean: f64,
    arch: Arch,
}

impl Field {
    /// Builds both charts. `tolerance` between 0.1 and 2e-12 chooses the window. Milliseconds at
    /// L = 50; L³ flops.
    pub fn new(beta: &Coefficients, tolerance: f64) -> Self {
        // Widths 4, 6, … 16 reach about these accuracies on a grid twice as fine as needed.
        const REACHED: [(f64, usize); 6] = [
            (0.1, 4),
            (2e-3, 6),
            (4e-5, 8),
            (6e-7, 10),
            (7e-9, 12),
            (1e-10, 14),
        ];
        let fits = REACHED.iter().find(|(reached, _)| *reached <= tolerance);
        let width = fits.map_or(TAPS, |&(_, width)| width);
        let torus = Torus::new(beta.degree().max(LEAST_DEGREE), width, 2.0);
        let mut rest = beta.with_degree(torus.degree());
        rest.as_mut_slice()[0] = 0.0;
        let turned = rotate(&rest, &cyclic());
        Self {
            charts: [rest, turned].map(|b| torus.synthesis(b.as_slice())),
            torus,
            mean: beta.get(0, 0) / (4.0 * std::f64::consts::PI).sqrt(),
            arch: Arch::new(),
        }
    }

    /// L.
    ///
    /// At least 8, whatever the degree of the coefficients.
    pub fn degree(&self) -> usize {
        self.torus.degree()
    }

    /// The field of Σ αᵢ fᵢ; all fields must share degree and tolerance.
    pub fn combine(terms: &[(f64, &Field)]) -> Result<Self, FieldError> {
        let (_, first) = terms.first().ok_or(FieldError::Empty)?;
        let mut out = (*first).clone();
        out.assign(terms)?;
        Ok(out)
    }

    /// [`Field::combine`] into a field that exists, without allocation.
    pub fn assign(&mut self, terms: &[(f64, &Field)]) -> Result<(), FieldError> {
        let shape = |f: &Field| (f.degree(), f.torus.kernel().width());
        let (first_degree, first_taps) = shape(self);
        for (index, (_, field)) in terms.iter().enumerate() {
            let (degree, taps) = shape(field);
            if (degree, taps) != (first_degree, first_taps) {
                return Err(FieldError::Mismatch {
                    index,
                    degree,
                    taps,
                    first_degree,
                    first_taps,
                });
            }
        }
        self.mean = terms.iter().map(|(a, f)| a * f.mean).sum();
        for (chart, grid) in self.charts.iter_mut().enumerate() {
            grid.values.fill(0.0);
            for (factor, field) in terms {
                for (sum, v) in grid.values.iter_mut().zip(&field.charts[chart].values) {
                    *sum += factor * v;
                }
            }
        }
        Ok(())
    }

    /// f(p).
    pub fn value(&self, p: &Direction) -> f64 {
        self.jet(p).value
    }

    /// f, ∇_S f and the covariant Hessian at p.
    pub fn jet(&self, p: &Direction) -> Jet {
        // The chart whose poles are farther: sin θ is never below √½.
        let tilted = p.x.abs() < p.z.abs();
        let q = if tilted {
            Vector3::new(p.y, p.z, p.x)
        } else {
            p.into_inner()
        };
        let sin = q.x.hypot(q.y);
        let n = self.torus.steps() as f64 / std::f64::consts::TAU;
        let phi = q.y.atan2(q.x);
        let phi = if phi < 0.0 {
            phi + std::f64::consts::TAU
        } else {
            phi
        };
        let d = self.arch.dispatch(Read {
            torus: &self.torus,
            grid: &self.charts[usize::from(tilted)].values,
            theta: sin.atan2(q.z) * n,
            phi: phi * n,
        });
        let mut jet = chart_jet(&q, sin, &d, n);
        jet.value += self.mean;
        if tilted { unturn(jet) } else { jet }
    }
}

/// f, f_θ, f_φ, f_θθ, f_θφ, f_φφ in grid steps to the jet; ∇ = f_θ e_θ + (f_φ / sin θ) e_φ.
fn chart_jet(q: &Vector3<f64>, sin: f64, d: &[f64; 6], n: f64) -> Jet {
    let (cos_phi, sin_phi) = (q.x / sin, q.y / sin);
    let e_theta = Vector3::new(q.z * cos_phi, q.z * sin_phi, -sin);
    let e_phi = Vector3::new(-sin_phi, cos_phi, 0.0);
    let (theta, phi) = (d[1] * n, d[2] * n / sin);
    let n2 = n * n;
    let cot = q.z / sin;
    let tt = d[3] * n2;
    let tp = d[4] * n2 / sin - cot * phi;
    let pp = d[5] * n2 / (sin * sin) + cot * theta;
    let mixed = e_theta * e_phi.transpose();
    Jet {
        value: d[0],
        gradient: e_theta * theta + e_phi * phi,
        hessian: e_theta * e_theta.transpose() * tt
            + (mixed + mixed.transpose()) * tp
            + e_phi * e_phi.transpose() * pp,
    }
}

/// From the axes (y, z, x) back to (x, y, z).
fn unturn(jet: Jet) -> Jet {
    let (g, h) = (jet.gradient, jet.hessian);
    Jet {
        value: jet.value,
        gradient: Vector3::new(g.z, g.x, g.y),
        hessian: Matrix3::from_fn(|i, j| h[((i + 2) % 3, (j + 2) % 3)]),
    }
}

/// The window sums at one place, with derivatives per grid step.
struct Read<'a> {
    torus: &'a Torus,
    grid: &'a [f64],
    theta: f64,
    phi: f64,
}

impl WithSimd for Read<'_> {
    type Output = [f64; 6];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> [f64; 6] {
        let (kernel, stride) = (self.torus.kernel(), self.torus.stride());
        let row = self.theta as usize;
        // Rounding may bring φ to one whole turn.
        let column = (self.phi as usize).min(self.torus.steps() - 1);
        let along_theta = kernel.derivatives::<S, 3>(self.theta - row as f64 - 0.5);
        let along_phi = kernel.derivatives::<S, 3>(self.phi - column as f64 - 0.5);
        let mut sums = [[0.0; TAPS]; 3];
        for tap in kernel.support() {
            let at = (row + tap) * stride + column;
            let values = &self.grid[at..at + TAPS];
            for k in 0..TAPS {
                sums[0][k] = multiply_add::<S>(along_theta[0][tap], values[k], sums[0][k]);
                sums[1][k] = multiply_add::<S>(along_theta[1][tap], values[k], sums[1][k]);
                sums[2][k] = multiply_add::<S>(along_theta[2][tap], values[k], sums[2][k]);
            }
        }
        let mut out = [0.0; 6];
        for (slot, (a, b)) in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
            .into_iter()
            .enumerate()
        {
            out[slot] = dot(&sums[a], &along_phi[b]);
        }
        out
    }
}

#[inline(always)]
fn dot(a: &[f64; TAPS], b: &[f64; TAPS]) -> f64 {
    let mut parts = [0.0; 4];
    for k in 0..TAPS {
        parts[k % 4] += a[k] * b[k];
    }
    (parts[0] + parts[2]) + (parts[1] + parts[3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::Basis;
    use crate::direction::{even_directions, retract};
    use crate::index;

    fn rough(degree: usize) -> Coefficients {
        let mut beta = Coefficients::constant(degree, 0.05);
        for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
            let (l, _) = index::degree_order(i);
            *b = 0.01 * (1.7 * i as f64).sin() / (l as f64).powi(2);
        }
        beta
    }

    fn places() -> Vec<Direction> {
        let mut all = even_directions(4000);
        let near = Vector3::new(2e-9, -1e-9, 3e-9);
        for axis in [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()] {
            all.extend([axis, -axis, retract(&axis, &near), retract(&-axis, &near)]);
        }
        all
    }

    /// Worst errors of value, gradient and Hessian in units of M, L M, L² M.
    fn worst(beta: &Coefficients, field: &Field) -> [f64; 3] {
        let basis = Basis::new(beta.degree());
        let mut work = basis.workspace();
        let mean = beta.get(0, 0) / (4.0 * std::f64::consts::PI).sqrt();
        let (mut errors, mut reach) = ([0.0_f64; 3], 0.0_f64);
        for p in places() {
            let (found, exact) = (field.jet(&p), basis.jet(beta, &p, &mut work));
            reach = reach.max((exact.value - mean).abs());
            errors[0] = errors[0].max((found.value - exact.value).abs());
            errors[1] = errors[1].max((found.gradient - exact.gradient).norm());
            errors[2] = errors[2].max((found.hessian - exact.hessian).norm());
        }
        let l = beta.degree().max(LEAST_DEGREE) as f64;
        [
            errors[0] / reach,
            errors[1] / (l * reach),
            errors[2] / (l * l * reach),
        ]
    }

    #[test]
    fn errors_stay_below_the_tolerance() {
        for degree in [1, 7, 50] {
            let beta = rough(degree);
            for tolerance in [0.1, 2e-3, 4e-5, 6e-7, 7e-9, 1e-10, 2e-12] {
                let errors = worst(&beta, &Field::new(&beta, tolerance));
                assert!(
                    errors.iter().all(|e| *e <= tolerance),
                    "L={degree} {tolerance:.0e}: {errors:?}"
                );
            }
        }
    }

    #[test]
    fn combining_fields_is_the_field_of_the_combination() {
        let (a, b) = (rough(20), Coefficients::constant(20, 0.08));
        let mix = Coefficients::combination([(0.3, &a), (0.7, &b)]);
        let (fa, fb) = (Field::new(&a, 1e-9), Field::new(&b, 1e-9));
        let combined = Field::combine(&[(0.3, &fa), (0.7, &fb)]).unwrap();
        assert!(worst(&mix, &combined).iter().all(|e| *e <= 1e-9));
        let other = Field::new(&rough(21), 1e-9);
        assert!(matches!(
            Field::combine(&[(1.0, &fa), (1.0, &other)]),
            Err(FieldError::Mismatch {
                index: 1,
                degree: 21,
                ..
            })
        ));
        assert_eq!(Field::combine(&[]).err(), Some(FieldError::Empty));
    }
}
