//! The real orthonormal spherical harmonics: values and tangential gradients at a point.

use nalgebra::{Matrix3, Vector3};

use crate::coefficients::Coefficients;
use crate::direction::{Direction, project_tangent};
use crate::index;
use crate::legendre::{Azimuth, Legendre, derivative_factor};

/// The highest degree the recurrences are tested for.
pub const MAX_DEGREE: usize = 300;

/// Value and tangential gradient of one harmonic, or of a sum of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Y_{l,m}(p), or f(p).
    pub value: f64,
    /// ∇_S Y_{l,m}(p), or ∇_S f(p): a vector of R³ tangent to the sphere at p.
    pub gradient: Vector3<f64>,
}

/// Value and derivatives of a function on the sphere at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// f(p).
    pub value: f64,
    /// ∇_S f(p), tangent to the sphere at p.
    pub gradient: Vector3<f64>,
    /// Covariant Hessian of f on S², a symmetric 3×3 matrix with p in its kernel.
    pub hessian: Matrix3<f64>,
}

/// Constants for evaluating all Y_{l,m} with l ≤ L.
///
/// Y_{l,m} = Π_l^{|m|}(z) · Im or Re (x+iy)^{|m|} for m < 0 or m ≥ 0 (Sec. II-C of the paper, no
/// Condon–Shortley phase). Written in x, y and z it is a polynomial, so values and gradients have
/// no singularity at the poles. About L² words; construction costs L² square roots.
#[derive(Clone, Debug)]
pub struct Basis {
    degree: usize,
    legendre: Legendre,
    /// dΠ_l^m/dz = factor · Π_l^{m+1}; columns m, l = m … L.
    derivative: Vec<Vec<f64>>,
}

/// Memory for one evaluation at a time; construct it once and reuse it.
pub struct Workspace {
    azimuth: Azimuth,
    /// Π columns of three neighbouring orders, each indexed by l.
    columns: [Vec<f64>; 3],
}

impl Basis {
    /// Constants for degree L; tested up to [`MAX_DEGREE`].
    pub fn new(degree: usize) -> Self {
        Self {
            degree,
            legendre: Legendre::new(degree),
            derivative: (0..=degree)
                .map(|m| (m..=degree).map(|l| derivative_factor(l, m)).collect())
                .collect(),
        }
    }

    /// L.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Number of harmonics, (L+1)².
    pub fn len(&self) -> usize {
        index::count(self.degree)
    }

    /// Always false: a basis holds at least the constant.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Memory for evaluations of this degree.
    pub fn workspace(&self) -> Workspace {
        Workspace {
            azimuth: Azimuth::new(self.degree),
            columns: std::array::from_fn(|_| vec![0.0; self.degree + 2]),
        }
    }

    /// Writes Y_{l,m}(p) for all l ≤ L into `values`, of length (L+1)², position l²+l+m.
    ///
    /// # Panics
    /// `values` does not have (L+1)² entries.
    pub fn values(&self, p: &Direction, workspace: &mut Workspace, values: &mut [f64]) {
        assert_eq!(values.len(), self.len(), "one value per harmonic");
        workspace.azimuth.fill(p.x, p.y);
        for m in 0..=self.degree {
            let column = &mut workspace.columns[0][..=self.degree - m];
            self.legendre.column(m, p.z, column);
            let azimuth = &workspace.azimuth;
            for (l, &pi) in (m..).zip(column.iter()) {
                let centre = l * l + l;
                values[centre + m] = azimuth.unscaled(m, pi * azimuth.re[m]);
                if m > 0 {
                    values[centre - m] = azimuth.unscaled(m, pi * azimuth.im[m]);
                }
            }
        }
    }

    /// Y_{l,m}(p) and ∇_S Y_{l,m}(p) for all l ≤ L into `harmonics`, of length (L+1)².
    ///
    /// The gradient is the gradient in R³ of Π(z)·(x+iy)ᵐ projected onto the tangent plane.
    ///
    /// # Panics
    /// `harmonics` does not have (L+1)² entries.
    pub fn values_and_gradients(
        &self,
        p: &Direction,
        workspace: &mut Workspace,
        harmonics: &mut [Harmonic],
    ) {
        assert_eq!(harmonics.len(), self.len(), "one entry per harmonic");
        workspace.azimuth.fill(p.x, p.y);
        self.load_column(0, 0, p.z, workspace);
        for m in 0..=self.degree {
            self.load_column(m + 1, 1, p.z, workspace);
            let azimuth = &workspace.azimuth;
            let (re, im) = (azimuth.re[m], azimuth.im[m]);
            // m (x+iy)^{m−1} in the scale of order m.
            let (re_before, im_before) = lower_order(azimuth, m);
            for l in m..=self.degree {
                let pi = workspace.columns[0][l];
                let slope = self.derivative[m][l - m] * workspace.columns[1][l];
                let centre = l * l + l;
                let cos = Vector3::new(pi * re_before, -pi * im_before, slope * re);
                harmonics[centre + m] = harmonic(azimuth, m, p, pi * re, cos);
                if m > 0 {
                    let sin = Vector3::new(pi * im_before, pi * re_before, slope * im);
                    harmonics[centre - m] = harmonic(azimuth, m, p, pi * im, sin);
                }
            }
            workspace.columns.swap(0, 1);
        }
    }

    /// f(p) = Σ β_{lm} Y_{lm}(p). About 3 L² flops.
    ///
    /// # Panics
    /// The coefficients are not of this basis's degree.
    pub fn sum(&self, beta: &Coefficients, p: &Direction, workspace: &mut Workspace) -> f64 {
        assert_eq!(beta.degree(), self.degree, "coefficients of this degree");
        let beta = beta.as_slice();
        workspace.azimuth.fill(p.x, p.y);
        let azimuth = &workspace.azimuth;
        let mut total = 0.0;
        for m in 0..=self.degree {
            let (first, steps) = self.legendre.recurrence(m);
            let (mut before, mut here) = (0.0, first);
            let (mut cos, mut sin) = (0.0, 0.0);
            let mut centre = m * m + m;
            cos += here * beta[centre + m];
            sin += here * beta[centre - m];
            for (l, &(a, b)) in (m + 1..).zip(steps) {
                let next = a * p.z * here - b * before;
                before = here;
                here = next;
                centre += 2 * l;
                cos += here * beta[centre + m];
                sin += here * beta[centre - m];
            }
            let term = if m == 0 {
                cos
            } else {
                azimuth.unscaled(m, cos * azimuth.re[m] + sin * azimuth.im[m])
            };
            total += term;
        }
        total
    }

    /// f, ∇_S f and the covariant Hessian of f = Σ β_{lm} Y_{lm} at p. About 12 L² flops.
    ///
    /// With F the polynomial extension of f to R³ and T the projection onto the tangent plane,
    /// ∇_S f = T ∇F and Hess_S f = T (∇²F − (p·∇F) I) T.
    ///
    /// # Panics
    /// The coefficients are not of this basis's degree.
    pub fn jet(&self, beta: &Coefficients, p: &Direction, workspace: &mut Workspace) -> Jet {
        assert_eq!(beta.degree(), self.degree, "coefficients of this degree");
        let beta = beta.as_slice();
        workspace.azimuth.fill(p.x, p.y);
        self.load_column(0, 0, p.z, workspace);
        self.load_column(1, 1, p.z, workspace);
        let mut ambient = Ambient::default();
        for m in 0..=self.degree {
            self.load_column(m + 2, 2, p.z, workspace);
            let mut sums = OrderSums::default();
            for l in m..=self.degree {
                let first = self.derivative[m][l - m];
                let second = if l > m {
                    first * self.derivative[m + 1][l - m - 1]
                } else {
                    0.0
                };
                let pi = [
                    workspace.columns[0][l],
                    first * workspace.columns[1][l],
                    second * workspace.columns[2][l],
                ];
                let centre = l * l + l;
                sums.add(pi, beta[centre + m], beta[centre - m]);
            }
            ambient.add_order(&workspace.azimuth, m, &sums);
            workspace.columns.rotate_left(1);
        }
        ambient.jet(p)
    }

    /// Loads Π_l^m for l = m … L into workspace column `slot`, indexed by l; writes nothing for m >
    /// L.
    fn load_column(&self, m: usize, slot: usize, z: f64, workspace: &mut Workspace) {
        if m <= self.degree {
            let column = &mut workspace.columns[slot][m..=self.degree];
            self.legendre.column(m, z, column);
        }
    }
}

/// m · (x+iy)^{m−1} in the scale of order m.
fn lower_order(azimuth: &Azimuth, m: usize) -> (f64, f64) {
    if m == 0 {
        return (0.0, 0.0);
    }
    let (to, from) = (azimuth.unscale[m], azimuth.unscale[m - 1]);
    let ratio = (from.0 / to.0) * (from.1 / to.1) * m as f64;
    (azimuth.re[m - 1] * ratio, azimuth.im[m - 1] * ratio)
}

fn harmonic(
    azimuth: &Azimuth,
    m: usize,
    p: &Direction,
    value: f64,
    ambient: Vector3<f64>,
) -> Harmonic {
    Harmonic {
        value: azimuth.unscaled(m, value),
        gradient: project_tangent(p, &ambient).map(|v| azimuth.unscaled(m, v)),
    }
}

/// Σ_l β Π, Σ_l β Π′, Σ_l β Π″ of one order, for the cosine and the sine part.
#[derive(Default)]
struct OrderSums {
    cos: [f64; 3],
    sin: [f64; 3],
}

impl OrderSums {
    fn add(&mut self, pi: [f64; 3], cos: f64, sin: f64) {
        for k in 0..3 {
            self.cos[k] += cos * pi[k];
            self.sin[k] += sin * pi[k];
        }
    }
}

/// Value, gradient and Hessian of the polynomial extension in R³.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ambient {
    pub(crate) value: f64,
    pub(crate) gradient: Vector3<f64>,
    pub(crate) hessian: Matrix3<f64>,
}

impl Ambient {
    fn add_order(&mut self, azimuth: &Azimuth, m: usize, sums: &OrderSums) {
        let power = |k: usize| -> (f64, f64) {
            // (x+iy)^{m−k} in true scale; orders below zero do not occur.
            if m < k {
                (0.0, 0.0)
            } else {
                (
                    azimuth.unscaled(m - k, azimuth.re[m - k]),
                    azimuth.unscaled(m - k, azimuth.im[m - k]),
                )
            }
        };
        let (re, im) = power(0);
        let (re1, im1) = power(1);
        let (re2, im2) = power(2);
        let (c, mut s) = (sums.cos, sums.sin);
        if m == 0 {
            s = [0.0; 3];
        }
        let m1 = m as f64;
        let m2 = m1 * (m1 - 1.0);
        self.value += c[0] * re + s[0] * im;
        let along_x = |k: usize| m1 * (c[k] * re1 + s[k] * im1);
        let along_y = |k: usize| m1 * (s[k] * re1 - c[k] * im1);
        self.gradient += Vector3::new(along_x(0), along_y(0), c[1] * re + s[1] * im);
        let xx = m2 * (c[0] * re2 + s[0] * im2);
        let xy = m2 * (s[0] * re2 - c[0] * im2);
        let (xz, yz) = (along_x(1), along_y(1));
        let zz = c[2] * re + s[2] * im;
        self.hessian += Matrix3::new(xx, xy, xz, xy, -xx, yz, xz, yz, zz);
    }

    pub(crate) fn jet(&self, p: &Direction) -> Jet {
        let normal = p.into_inner();
        let tangent = Matrix3::identity() - normal * normal.transpose();
        let inner = self.hessian - Matrix3::identity() * normal.dot(&self.gradient);
        Jet {
            value: self.value,
            gradient: project_tangent(p, &self.gradient),
            hessian: tangent * inner * tangent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::{even_directions, retract, tangent_frame};

    fn wavy(degree: usize) -> Coefficients {
        let mut beta = Coefficients::zeros(degree);
        for (i, b) in beta.as_mut_slice().iter_mut().enumerate() {
            let (l, _) = index::degree_order(i);
            *b = (1.7 * i as f64).sin() / (1.0 + (l * l) as f64);
        }
        beta
    }

    fn with_poles(count: usize) -> Vec<Direction> {
        let mut all = even_directions(count);
        let near = retract(&Vector3::z_axis(), &Vector3::new(1e-9, 2e-9, 0.0));
        all.extend([Vector3::z_axis(), -Vector3::z_axis(), near]);
        all
    }

    #[test]
    fn sums_agree_with_the_basis() {
        for degree in [0, 1, 2, 7, 50] {
            let (basis, beta) = (Basis::new(degree), wavy(degree));
            let mut work = basis.workspace();
            let mut values = vec![0.0; basis.len()];
            for p in with_poles(40) {
                basis.values(&p, &mut work, &mut values);
                let plain: f64 = values.iter().zip(beta.as_slice()).map(|(y, b)| y * b).sum();
                assert!((basis.sum(&beta, &p, &mut work) - plain).abs() <= 1e-13);
                assert!((basis.jet(&beta, &p, &mut work).value - plain).abs() <= 1e-13);
            }
        }
    }

    #[test]
    fn jet_agrees_with_differences_also_at_the_poles() {
        let (basis, beta) = (Basis::new(20), wavy(20));
        let mut work = basis.workspace();
        let h = 1e-4;
        for p in with_poles(30) {
            let jet = basis.jet(&beta, &p, &mut work);
            let (e1, e2) = tangent_frame(&p);
            for v in [e1, e2, (e1 + e2) / 2.0_f64.sqrt()] {
                let at =
                    |t: f64, work: &mut Workspace| basis.sum(&beta, &retract(&p, &(v * t)), work);
                let (up, down) = (at(h, &mut work), at(-h, &mut work));
                let slope = (up - down) / (2.0 * h);
                assert!((jet.gradient.dot(&v) - slope).abs() <= 1e-6);
                let bend = (up - 2.0 * jet.value + down) / (h * h);
                assert!((v.dot(&(jet.hessian * v)) - bend).abs() <= 1e-4);
            }
            assert!((jet.hessian * p.into_inner()).norm() <= 1e-12);
        }
    }

    #[test]
    fn gradients_of_the_basis_agree_with_the_jet() {
        let (basis, beta) = (Basis::new(12), wavy(12));
        let mut work = basis.workspace();
        let blank = Harmonic {
            value: 0.0,
            gradient: Vector3::zeros(),
        };
        let mut harmonics = vec![blank; basis.len()];
        for p in with_poles(30) {
            basis.values_and_gradients(&p, &mut work, &mut harmonics);
            let sum: Vector3<f64> = harmonics
                .iter()
                .zip(beta.as_slice())
                .map(|(y, b)| y.gradient * *b)
                .sum();
            let jet = basis.jet(&beta, &p, &mut work);
            assert!((sum - jet.gradient).norm() <= 1e-12);
        }
    }
}
