//! Grids of rings on the sphere, and synthesis and analysis on them.

use nalgebra::Vector3;

use crate::coefficients::Coefficients;
use crate::direction::Direction;
use crate::legendre::Legendre;
use crate::transform;

/// Rings of equal z, each with the same evenly spaced longitudes φ_k = 2πk/n.
#[derive(Clone, Debug)]
pub struct RingGrid {
    /// (sin θ, cos θ) of every ring, from the north.
    rings: Vec<(f64, f64)>,
    /// Weight in z of every ring, for ∫_{−1}^{1} dz.
    weights: Vec<f64>,
    longitudes: usize,
}

/// Values on a [`RingGrid`], ring after ring.
#[derive(Clone, Debug, PartialEq)]
pub struct GridValues {
    /// Points per ring.
    pub longitudes: usize,
    /// Value of ring j, longitude k at j · longitudes + k.
    pub values: Vec<f64>,
}

impl RingGrid {
    /// Gauss–Legendre rings: quadrature is exact for spherical polynomials of degree
    /// below min(2·rings, longitudes).
    pub fn gauss_legendre(rings: usize, longitudes: usize) -> Self {
        let (nodes, weights) = gauss_legendre(rings);
        let rings = nodes
            .iter()
            .map(|&z| (((1.0 - z) * (1.0 + z)).sqrt(), z))
            .collect();
        Self {
            rings,
            weights,
            longitudes,
        }
    }

    /// Rings at θ = π j / (rings−1), including the poles. For figures and bounds, not for
    /// quadrature: the weights are zero. Needs at least two rings.
    pub fn equiangular(rings: usize, longitudes: usize) -> Self {
        let step = std::f64::consts::PI / (rings.max(2) - 1) as f64;
        Self {
            rings: (0..rings).map(|j| (step * j as f64).sin_cos()).collect(),
            weights: vec![0.0; rings],
            longitudes,
        }
    }

    /// (sin θ, cos θ) of every ring.
    pub fn rings(&self) -> &[(f64, f64)] {
        &self.rings
    }

    /// Weight of every ring for ∫dz; a point's weight on the sphere is this times 2π/longitudes.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Points per ring.
    pub fn longitudes(&self) -> usize {
        self.longitudes
    }

    /// All grid points, ring after ring.
    pub fn directions(&self) -> impl Iterator<Item = Direction> {
        let step = std::f64::consts::TAU / self.longitudes as f64;
        self.rings.iter().flat_map(move |&(sin, cos)| {
            (0..self.longitudes).map(move |k| {
                let (s, c) = (step * k as f64).sin_cos();
                Direction::new_unchecked(Vector3::new(sin * c, sin * s, cos))
            })
        })
    }

    /// Values of Σ β_{lm} Y_{lm} on the grid.
    ///
    /// With more than 2L longitudes whose factors are 2, 3 and 5 (an even number), a fast Fourier
    /// transform runs along the rings: about rings·(4L² + 10·longitudes·log₂ longitudes) flops.
    /// Otherwise rings·(2L² + 4·L·longitudes).
    pub fn synthesis(&self, beta: &Coefficients) -> GridValues {
        let degree = beta.degree();
        if transform::suits(&self.rings, self.longitudes, degree) {
            return GridValues {
                longitudes: self.longitudes,
                values: transform::to_rings(&self.rings, self.longitudes, beta.as_slice()),
            };
        }
        let legendre = Legendre::new(degree);
        let roots = RootsOfUnity::new(self.longitudes);
        let mut column = vec![0.0; degree + 1];
        let mut values = Vec::with_capacity(self.rings.len() * self.longitudes);
        for &(sin, cos) in &self.rings {
            let start = values.len();
            values.resize(start + self.longitudes, 0.0);
            let ring = &mut values[start..];
            let mut power = 1.0;
            for m in 0..=degree {
                let column = &mut column[..=degree - m];
                legendre.column(m, cos, column);
                let (mut even, mut odd) = (0.0, 0.0);
                for (l, pi) in (m..).zip(column.iter()) {
                    let centre = l * l + l;
                    even += pi * beta.as_slice()[centre + m];
                    odd += pi * beta.as_slice()[centre - m];
                }
                let odd = if m == 0 { 0.0 } else { odd };
                roots.add(m, even * power, odd * power, ring);
                power *= sin;
            }
        }
        GridValues {
            longitudes: self.longitudes,
            values,
        }
    }

    /// β_{lm} = ∫ f Y_{lm} by the grid's quadrature.
    ///
    /// Exact when deg f + degree is below the grid's exactness ([`RingGrid::gauss_legendre`]).
    pub fn analysis(&self, values: &GridValues, degree: usize) -> Coefficients {
        let cell = std::f64::consts::TAU / self.longitudes as f64;
        if transform::suits(&self.rings, self.longitudes, degree) {
            let weights: Vec<f64> = self.weights.iter().map(|w| w * cell).collect();
            let (rings, n) = (&self.rings, self.longitudes);
            let beta = transform::from_rings(rings, &weights, n, &values.values, degree);
            let mut out = Coefficients::zeros(degree);
            out.as_mut_slice().copy_from_slice(&beta);
            return out;
        }
        let legendre = Legendre::new(degree);
        let roots = RootsOfUnity::new(self.longitudes);
        let mut column = vec![0.0; degree + 1];
        let mut beta = Coefficients::zeros(degree);
        let out = beta.as_mut_slice();
        for (j, (&(sin, cos), weight)) in self.rings.iter().zip(&self.weights).enumerate() {
            let ring = &values.values[j * self.longitudes..(j + 1) * self.longitudes];
            let mut power = weight * cell;
            for m in 0..=degree {
                let column = &mut column[..=degree - m];
                legendre.column(m, cos, column);
                let (even, odd) = roots.project(m, ring);
                for (l, pi) in (m..).zip(column.iter()) {
                    let centre = l * l + l;
                    out[centre + m] += pi * even * power;
                    if m > 0 {
                        out[centre - m] += pi * odd * power;
                    }
                }
                power *= sin;
            }
        }
        beta
    }
}

/// cos and sin of 2πk/n, read with stride m.
struct RootsOfUnity(Vec<(f64, f64)>);

impl RootsOfUnity {
    fn new(longitudes: usize) -> Self {
        let step = std::f64::consts::TAU / longitudes as f64;
        Self(
            (0..longitudes)
                .map(|k| {
                    let (sin, cos) = (step * k as f64).sin_cos();
                    (cos, sin)
                })
                .collect(),
        )
    }

    /// ring[k] += even cos mφ_k + odd sin mφ_k.
    fn add(&self, m: usize, even: f64, odd: f64, ring: &mut [f64]) {
        let n = self.0.len();
        let step = m % n;
        let mut at = 0;
        for value in ring {
            let (cos, sin) = self.0[at];
            *value += even * cos + odd * sin;
            at += step;
            if at >= n {
                at -= n;
            }
        }
    }

    /// (Σ ring[k] cos mφ_k, Σ ring[k] sin mφ_k).
    fn project(&self, m: usize, ring: &[f64]) -> (f64, f64) {
        let n = self.0.len();
        let step = m % n;
        let (mut even, mut odd, mut at) = (0.0, 0.0, 0);
        for value in ring {
            let (cos, sin) = self.0[at];
            even += value * cos;
            odd += value * sin;
            at += step;
            if at >= n {
                at -= n;
            }
        }
        (even, odd)
    }
}

/// Nodes, from +1 down, and weights of Gauss–Legendre quadrature on [−1, 1].
///
/// Exact for polynomials of degree 2·count − 1. Newton's method from Tricomi's starting values.
pub fn gauss_legendre(count: usize) -> (Vec<f64>, Vec<f64>) {
    let n = count as f64;
    let mut nodes = vec![0.0; count];
    let mut weights = vec![0.0; count];
    for i in 0..count.div_ceil(2) {
        let angle = std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5);
        let mut z = (1.0 - (n - 1.0) / (8.0 * n * n * n)) * angle.cos();
        let mut slope = 0.0;
        for _ in 0..8 {
            let (value, derivative) = legendre_and_derivative(count, z);
            slope = derivative;
            let step = value / derivative;
            z -= step;
            if step.abs() <= 1e-16 {
                break;
            }
        }
        if 2 * i + 1 == count {
            z = 0.0;
            slope = legendre_and_derivative(count, z).1;
        }
        let weight = 2.0 / ((1.0 - z) * (1.0 + z) * slope * slope);
        nodes[i] = z;
        weights[i] = weight;
        nodes[count - 1 - i] = -z;
        weights[count - 1 - i] = weight;
    }
    (nodes, weights)
}

/// P_n(z) and P_n′(z) for |z| < 1.
fn legendre_and_derivative(n: usize, z: f64) -> (f64, f64) {
    let (mut before, mut here) = (1.0, z);
    for k in 2..=n {
        let k = k as f64;
        let next = ((2.0 * k - 1.0) * z * here - (k - 1.0) * before) / k;
        before = here;
        here = next;
    }
    if n == 0 {
        return (1.0, 0.0);
    }
    let slope = n as f64 * (before - z * here) / ((1.0 - z) * (1.0 + z));
    (here, slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::Basis;
    use crate::coefficients::tests::some_coefficients;
    use crate::direction::SphericalCoords;
    use crate::fft::smooth_length;

    #[test]
    fn synthesis_agrees_with_point_sums() {
        let beta = some_coefficients(13);
        let basis = Basis::new(13);
        let mut work = basis.workspace();
        // 17 longitudes take the direct sum, 30 and 32 the fast Fourier transform.
        for (rings, longitudes) in [(9, 17), (9, 30), (20, 32)] {
            let grid = RingGrid::equiangular(rings, longitudes);
            let values = grid.synthesis(&beta).values;
            for (p, value) in grid.directions().zip(&values) {
                assert!((value - basis.sum(&beta, &p, &mut work)).abs() <= 1e-12);
            }
            let corner = SphericalCoords {
                theta: std::f64::consts::PI / (rings - 1) as f64,
                phi: std::f64::consts::TAU / longitudes as f64,
            };
            let plain = basis.sum(&beta, &corner.direction(), &mut work);
            assert!((values[longitudes + 1] - plain).abs() <= 1e-12);
        }
    }

    #[test]
    fn analysis_undoes_synthesis_to_degree_100() {
        for degree in [0, 1, 8, 50, 100] {
            let beta = some_coefficients(degree);
            let plain = RingGrid::gauss_legendre(degree + 1, 2 * degree + 1);
            let fast = RingGrid::gauss_legendre(degree + 1, smooth_length(2 * degree + 2));
            for grid in [plain, fast] {
                let back = grid.analysis(&grid.synthesis(&beta), degree);
                assert!(beta.distance(&back) <= 1e-11 * (1.0 + degree as f64));
            }
        }
    }

    #[test]
    fn quadrature_is_exact_for_its_degree() {
        for count in [1, 2, 3, 10, 101, 400] {
            let (nodes, weights) = gauss_legendre(count);
            for power in (0..(2 * count).min(60)).step_by(2) {
                let sum: f64 = nodes
                    .iter()
                    .zip(&weights)
                    .map(|(z, w)| w * z.powi(power as i32))
                    .sum();
                assert!((sum - 2.0 / (power + 1) as f64).abs() <= 1e-13);
            }
        }
    }
}
