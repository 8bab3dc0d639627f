//! Repeated evaluation of one function and its derivatives at arbitrary points.
//!
//! An ascent evaluates one function thousands of times, and a sum of (L+1)² terms at every point would
//! dominate its cost. A [`Field`] does the sums once, on fine grids of two charts of the sphere, and
//! interpolates from 16×16 grid neighbours.

use nalgebra::{Matrix3, Vector3};
use pulp::{Arch, Simd, WithSimd};

use crate::basis::Jet;
use crate::coefficients::Coefficients;
use crate::direction::Direction;
use crate::double_fourier::{DoubleFourier, FineGrid};
use crate::kernel::{TAPS, Taps};
use crate::multiply_add::multiply_add;
use crate::rotation::{cyclic, rotate};

/// Why fields cannot be combined.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FieldError {
    /// The degrees differ, and so the grids differ.
    #[error("field {index} is of degree {degree}; the first has degree {first_degree}")]
    Mismatch {
        /// Index of the field with the other degree.
        index: usize,
        /// Degree of that field.
        degree: usize,
        /// Degree of the first field.
        first_degree: usize,
    },
    /// There is nothing to combine.
    #[error("no fields")]
    Empty,
}

/// Least degree that is stored: the grid must be at least as wide as the window. Fields of lower
/// degree are stored at this degree.
const LEAST_DEGREE: usize = 8;

/// A function on the sphere, tabulated so that its value and derivatives at any point take a
/// fraction of a microsecond.
///
/// With M = max |f − mean| and L at least 8, the errors of value, gradient and Hessian are below
/// 1e-13 M, 1e-13 L M and 2e-12 L² M. If the coefficients decrease like 1/l², the errors are below
/// 1e-10 of the largest value, gradient and Hessian (`docs/accuracy.md`). Tests measure both;
/// neither is proved. Proofs use [`crate::bounds`].
///
/// A field is linear in the coefficients: the field of Σ αᵢ βᵢ is [`Field::combine`] of the fields,
/// a sum over grids. Memory: about 80 L² bytes per chart. The window has sixteen taps; fourteen
/// would save a thirtieth of the time and lose two digits of the Hessian.
///
/// ```
/// use sph::direction::even_directions;
/// use sph::{Basis, Coefficients, Field};
///
/// let mut beta = Coefficients::constant(12, 1.0);
/// beta.as_mut_slice()[sph::index::position(3, -2)] = 0.1;
/// let (field, basis) = (Field::new(&beta), Basis::new(12));
/// let mut workspace = basis.workspace();
/// for p in even_directions(100) {
///     let (table, sum) = (field.jet(&p), basis.jet(&beta, &p, &mut workspace));
///     assert!((table.value - sum.value).abs() < 1e-12);
///     assert!((table.gradient - sum.gradient).norm() < 1e-11);
/// }
/// ```
#[derive(Clone, Debug)]
pub struct Field {
    fourier: DoubleFourier,
    /// The chart with its axis along z, and the one along x.
    charts: [FineGrid; 2],
    /// The mean of the function; the grids hold the difference from it.
    mean: f64,
    arch: Arch,
}

impl Field {
    /// Tabulates a function on both charts. Costs about L³ flops, a few milliseconds at L = 50.
    pub fn new(beta: &Coefficients) -> Self {
        let fourier = DoubleFourier::new(beta.degree().max(LEAST_DEGREE));
        let mut rest = beta.with_degree(fourier.degree());
        rest.as_mut_slice()[0] = 0.0;
        let turned = rotate(&rest, &cyclic());
        Self {
            charts: [rest, turned].map(|b| fourier.synthesis(b.as_slice())),
            fourier,
            mean: beta.get(0, 0) / (4.0 * std::f64::consts::PI).sqrt(),
            arch: Arch::new(),
        }
    }

    /// The degree of the coefficients, but at least 8.
    pub fn degree(&self) -> usize {
        self.fourier.degree()
    }

    /// The field of Σ αᵢ fᵢ.
    ///
    /// # Errors
    /// There are no terms, or the fields differ in degree.
    pub fn combine(terms: &[(f64, &Field)]) -> Result<Self, FieldError> {
        let (_, first) = terms.first().ok_or(FieldError::Empty)?;
        let mut out = (*first).clone();
        out.assign(terms)?;
        Ok(out)
    }

    /// Replaces this field by Σ αᵢ fᵢ, without allocation.
    ///
    /// # Errors
    /// A field's degree differs from that of this field.
    pub fn assign(&mut self, terms: &[(f64, &Field)]) -> Result<(), FieldError> {
        let first_degree = self.degree();
        for (index, (_, field)) in terms.iter().enumerate() {
            let degree = field.degree();
            if degree != first_degree {
                return Err(FieldError::Mismatch {
                    index,
                    degree,
                    first_degree,
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

    /// f(p), in half the time of [`Field::jet`].
    pub fn value(&self, p: &Direction) -> f64 {
        let [[value, ..]] = read::<1, 1>(&[self], self, &Place::new(p));
        self.mean + value
    }

    /// f, ∇_S f and the covariant Hessian at p.
    ///
    /// Leaving out the Hessian would save nothing, since the gradient needs the same rows of the window.
    pub fn jet(&self, p: &Direction) -> Jet {
        let place = Place::new(p);
        let [d] = read::<3, 1>(&[self], self, &place);
        let mut jet = place.jet(&d, self.steps_a_radian());
        jet.value += self.mean;
        if place.tilted {
            unturned_jet(&jet)
        } else {
            jet
        }
    }

    /// The jets of several functions at one point.
    ///
    /// The weights of the window are computed once, so that three functions take about twice the
    /// time of one. Each is the same as [`Field::jet`] gives, to the bit.
    ///
    /// # Errors
    /// There are no fields, or they differ in degree.
    pub fn jets<const N: usize>(
        fields: [&Field; N],
        p: &Direction,
    ) -> Result<[Jet; N], FieldError> {
        let (first, place) = (shared_grid(&fields)?, Place::new(p));
        let parts = read::<3, N>(&fields, first, &place);
        let mut jets = parts.map(|d| place.jet(&d, first.steps_a_radian()));
        for (jet, field) in jets.iter_mut().zip(fields) {
            jet.value += field.mean;
            if place.tilted {
                *jet = unturned_jet(jet);
            }
        }
        Ok(jets)
    }

    /// The values of several functions at one point; see [`Field::jets`].
    ///
    /// # Errors
    /// There are no fields, or they differ in degree.
    pub fn values<const N: usize>(
        fields: [&Field; N],
        p: &Direction,
    ) -> Result<[f64; N], FieldError> {
        let first = shared_grid(&fields)?;
        let parts = read::<1, N>(&fields, first, &Place::new(p));
        let mut values = parts.map(|[value, ..]| value);
        for (value, field) in values.iter_mut().zip(fields) {
            *value += field.mean;
        }
        Ok(values)
    }

    fn steps_a_radian(&self) -> f64 {
        self.fourier.steps() as f64 / std::f64::consts::TAU
    }
}

/// The first field, if all have its degree and so its grid.
fn shared_grid<'a>(fields: &[&'a Field]) -> Result<&'a Field, FieldError> {
    let first = fields.first().ok_or(FieldError::Empty)?;
    let first_degree = first.degree();
    match fields.iter().position(|f| f.degree() != first_degree) {
        Some(index) => Err(FieldError::Mismatch {
            index,
            degree: fields[index].degree(),
            first_degree,
        }),
        None => Ok(first),
    }
}

/// f without its mean, f_θ, f_φ, f_θθ, f_θφ, f_φφ in grid steps, up to the derivative PARTS − 1, of
/// each function; all have the grid of `first`.
fn read<const PARTS: usize, const N: usize>(
    fields: &[&Field; N],
    first: &Field,
    place: &Place,
) -> [[f64; 6]; N] {
    let n = first.steps_a_radian();
    first.arch.dispatch(Read::<PARTS, N> {
        fourier: &first.fourier,
        grids: fields.map(|f| &*f.charts[usize::from(place.tilted)].values),
        theta: place.sin.atan2(place.q.z) * n,
        phi: place.phi() * n,
    })
}

/// A point in the chart whose poles are farther away, so that sin θ ≥ √½.
struct Place {
    tilted: bool,
    q: Vector3<f64>,
    sin: f64,
}

impl Place {
    fn new(p: &Direction) -> Self {
        let tilted = p.x.abs() < p.z.abs();
        let q = if tilted {
            Vector3::new(p.y, p.z, p.x)
        } else {
            p.into_inner()
        };
        Self {
            tilted,
            sin: (q.x * q.x + q.y * q.y).sqrt(),
            q,
        }
    }

    fn phi(&self) -> f64 {
        let phi = self.q.y.atan2(self.q.x);
        if phi < 0.0 {
            phi + std::f64::consts::TAU
        } else {
            phi
        }
    }

    /// Unit vectors in the directions of increasing θ and φ.
    fn frame(&self) -> (Vector3<f64>, Vector3<f64>) {
        let (cos_phi, sin_phi) = (self.q.x / self.sin, self.q.y / self.sin);
        (
            Vector3::new(self.q.z * cos_phi, self.q.z * sin_phi, -self.sin),
            Vector3::new(-sin_phi, cos_phi, 0.0),
        )
    }

    /// The jet from f, f_θ, f_φ, f_θθ, f_θφ, f_φφ in grid steps; ∇ = f_θ e_θ + (f_φ / sin θ) e_φ.
    fn jet(&self, d: &[f64; 6], n: f64) -> Jet {
        let (e_theta, e_phi) = self.frame();
        let (theta, phi) = (d[1] * n, d[2] * n / self.sin);
        let n2 = n * n;
        let cot = self.q.z / self.sin;
        let tt = d[3] * n2;
        let tp = d[4] * n2 / self.sin - cot * phi;
        let pp = d[5] * n2 / (self.sin * self.sin) + cot * theta;
        let mixed = e_theta * e_phi.transpose();
        Jet {
            value: d[0],
            gradient: e_theta * theta + e_phi * phi,
            hessian: e_theta * e_theta.transpose() * tt
                + (mixed + mixed.transpose()) * tp
                + e_phi * e_phi.transpose() * pp,
        }
    }
}

/// Components in (x, y, z) of a vector given in the axes (y, z, x).
fn unturned(v: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(v.z, v.x, v.y)
}

fn unturned_jet(jet: &Jet) -> Jet {
    Jet {
        value: jet.value,
        gradient: unturned(&jet.gradient),
        hessian: Matrix3::from_fn(|i, j| jet.hessian[((i + 2) % 3, (j + 2) % 3)]),
    }
}

/// The window sums of several grids at one place, with derivatives per grid step.
struct Read<'a, const PARTS: usize, const N: usize> {
    fourier: &'a DoubleFourier,
    grids: [&'a [f64]; N],
    theta: f64,
    phi: f64,
}

impl<const PARTS: usize, const N: usize> WithSimd for Read<'_, PARTS, N> {
    type Output = [[f64; 6]; N];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> [[f64; 6]; N] {
        let (kernel, stride) = (self.fourier.kernel(), self.fourier.stride());
        let row = self.theta as usize;
        // Rounding can make φ equal to one whole turn.
        let column = (self.phi as usize).min(self.fourier.steps() - 1);
        let weights = [
            kernel.derivatives::<S, PARTS>(self.theta - row as f64 - 0.5),
            kernel.derivatives::<S, PARTS>(self.phi - column as f64 - 0.5),
        ];
        let mut out = [[0.0; 6]; N];
        for (out, grid) in out.iter_mut().zip(self.grids) {
            *out = window_sums::<S, PARTS>(&grid[row * stride + column..], stride, &weights);
        }
        out
    }
}

/// The sums over one grid that begins at the first tap, weighted along θ and along φ.
#[inline(always)]
fn window_sums<S: Simd, const PARTS: usize>(
    grid: &[f64],
    stride: usize,
    [along_theta, along_phi]: &[[Taps; PARTS]; 2],
) -> [f64; 6] {
    let mut totals = [[0.0; HALF]; 6];
    for first in [0, HALF] {
        // Half a row at a time, so that its three sums stay in registers from the first row to the last.
        let mut sums = [[0.0; HALF]; PARTS];
        for tap in 0..TAPS {
            let at = tap * stride + first;
            let values = &grid[at..at + HALF];
            for (part, sum) in sums.iter_mut().enumerate() {
                for k in 0..HALF {
                    sum[k] = multiply_add::<S>(along_theta[part][tap], values[k], sum[k]);
                }
            }
        }
        // The orders a + b below PARTS come first.
        for (total, (a, b)) in totals.iter_mut().zip(ORDERS).take(PARTS * (PARTS + 1) / 2) {
            for k in 0..HALF {
                total[k] = multiply_add::<S>(sums[a][k], along_phi[b][first + k], total[k]);
            }
        }
    }
    totals.map(|lanes| lanes.iter().sum())
}

/// Number of columns that are summed together.
const HALF: usize = TAPS / 2;
/// Orders of the derivatives along θ and φ, in the order in which they are returned.
const ORDERS: [(usize, usize); 6] = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)];

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
    fn errors_stay_below_what_is_stated() {
        for degree in [1, 7, 50, 120] {
            let beta = rough(degree);
            let errors = worst(&beta, &Field::new(&beta));
            for (error, allowed) in errors.into_iter().zip([1e-13, 1e-13, 2e-12]) {
                assert!(error <= allowed, "L={degree}: {errors:?}");
            }
        }
    }

    #[test]
    fn the_value_alone_is_the_value_of_the_jet() {
        let field = Field::new(&rough(30));
        for p in places() {
            assert_eq!(field.value(&p), field.jet(&p).value);
        }
    }

    #[test]
    fn several_functions_are_read_as_each_alone() {
        let [a, b, c] = [0.0, 0.3, 0.6].map(|shift| {
            let mut beta = rough(30);
            beta.as_mut_slice()[5] += shift;
            Field::new(&beta)
        });
        for p in places() {
            let jets = Field::jets([&a, &b, &c], &p).unwrap();
            assert_eq!(jets, [a.jet(&p), b.jet(&p), c.jet(&p)]);
            let values = Field::values([&a, &b, &c], &p).unwrap();
            assert_eq!(values, jets.map(|j| j.value));
        }
        let other = Field::new(&rough(31));
        let mixed = Field::jets([&a, &other], &Vector3::z_axis());
        assert!(matches!(mixed, Err(FieldError::Mismatch { index: 1, .. })));
        assert_eq!(
            Field::values([], &Vector3::z_axis()),
            Err(FieldError::Empty)
        );
    }

    #[test]
    fn combining_fields_is_the_field_of_the_combination() {
        let (a, b) = (rough(20), Coefficients::constant(20, 0.08));
        let mix = Coefficients::combination([(0.3, &a), (0.7, &b)]);
        let (fa, fb) = (Field::new(&a), Field::new(&b));
        let combined = Field::combine(&[(0.3, &fa), (0.7, &fb)]).unwrap();
        assert!(worst(&mix, &combined).iter().all(|e| *e <= 1e-11));
        let other = Field::new(&rough(21));
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
