//! Certified local bounds of the third derivatives of a map of the sphere.

use rayon::prelude::*;
use sph::grid::RingGrid;
use sph::{Coefficients, Direction};

use crate::rotation_field::rotational_gradient;

/// Rings of the grid per degree: the grid has this many points per half wave.
const OVERSAMPLING: usize = 3;
/// Points of a stencil along one axis, and of those the first corner of its cell.
const STENCIL: usize = 8;
const CORNER: usize = 3;
/// max over the cell of Π|t − tₖ| / 8!, the remainder of the stencil's polynomial.
const REMAINDER: f64 = 1.069e-3;

/// Bounds of τ = (Σ_{ijk} |½(K_jK_k + K_kK_j) K_i f|²)^{1/2}, K = p × ∇ the generators of rotations.
///
/// For a unit vector ω the third derivative of f along the rotation about ω is at most τ, and so is the
/// second derivative of the matrix of first derivatives K_i f.
pub(crate) struct ThirdDerivatives {
    /// Bound of every cell between two rings and two longitudes.
    cells: Vec<f64>,
    rings: usize,
    longitudes: usize,
}

impl ThirdDerivatives {
    /// Every cell's bound is Λ² times the largest value on the 8 × 8 points around it, plus a remainder:
    /// the 54 functions are trigonometric polynomials of degree L in both angles, Λ is the Lebesgue constant
    /// of the stencil, and Bernstein's inequality bounds the eighth derivatives.
    pub(crate) fn new(coordinates: &[Coefficients; 3]) -> Self {
        let degree = coordinates[0].degree().max(8);
        let half = OVERSAMPLING * degree;
        let grid = RingGrid::equiangular(half + 1, 2 * half);
        let squares: Vec<f64> = thirds(coordinates)
            .par_iter()
            .map(|(factor, c)| {
                let values = grid.synthesis(c).values;
                values.iter().map(|v| factor * v * v).collect::<Vec<f64>>()
            })
            .reduce_with(|mut a, b| {
                for (a, b) in a.iter_mut().zip(b) {
                    *a += b;
                }
                a
            })
            .unwrap_or_default();
        let sizes: Vec<f64> = squares.iter().map(|s| s.sqrt()).collect();
        let largest = sizes.iter().fold(0.0, |a: f64, b| a.max(*b));
        let angle = 0.5 * std::f64::consts::PI / OVERSAMPLING as f64;
        // Ehlich and Zeller, as in sph::bounds.
        let most = largest / angle.cos().powi(2);
        let step = std::f64::consts::PI / half as f64;
        let lebesgue = lebesgue_constant();
        let remainder =
            (1.0 + lebesgue) * REMAINDER * most * (degree as f64 * step).powi(STENCIL as i32);
        let (rings, longitudes) = (half, 2 * half);
        let at = |row: isize, column: isize| {
            // Beyond the poles (−θ, φ) is (θ, φ + π).
            let last = half as isize;
            let (ring, turn) = match row {
                r if r < 0 => (-r, half),
                r if r > last => (2 * last - r, half),
                r => (r, 0),
            };
            let column = (column + turn as isize).rem_euclid(longitudes as isize);
            sizes[ring as usize * longitudes + column as usize]
        };
        let reach = -(CORNER as isize)..(STENCIL - CORNER) as isize;
        let cells = (0..rings * longitudes)
            .into_par_iter()
            .map(|k| {
                let (i, j) = ((k / longitudes) as isize, (k % longitudes) as isize);
                let stencil = reach
                    .clone()
                    .flat_map(|a| reach.clone().map(move |b| (i + a, j + b)));
                let top = stencil.fold(0.0, |top: f64, (a, b)| top.max(at(a, b)));
                (lebesgue * lebesgue * top + remainder).min(most)
            })
            .collect();
        Self {
            cells,
            rings,
            longitudes,
        }
    }

    /// A bound of τ on all points within `angle` of a direction.
    pub(crate) fn within(&self, centre: &Direction, angle: f64) -> f64 {
        let step = std::f64::consts::PI / self.rings as f64;
        let theta = centre.x.hypot(centre.y).atan2(centre.z);
        let phi = centre.y.atan2(centre.x);
        let row = |t: f64| ((t / step).floor().max(0.0) as usize).min(self.rings - 1);
        let (low, high) = (theta - angle, theta + angle);
        let polar = low <= 0.0 || high >= std::f64::consts::PI;
        let mut most = 0.0_f64;
        // A cap without a pole spans asin(sin angle / sin θ) in longitude on each side.
        let spread = (angle.sin() / theta.sin()).min(1.0).asin();
        for i in row(low - 1e-9)..=row(high + 1e-9) {
            let cells = &self.cells[i * self.longitudes..(i + 1) * self.longitudes];
            if polar || spread > 1.5 {
                most = cells.iter().fold(most, |a, b| a.max(*b));
                continue;
            }
            let first = ((phi - spread - 1e-9) / step).floor() as isize;
            let last = ((phi + spread + 1e-9) / step).floor() as isize;
            for j in first..=last {
                most = most.max(cells[j.rem_euclid(self.longitudes as isize) as usize]);
            }
        }
        most
    }
}

/// ½(K_jK_k + K_kK_j) K_i of every coordinate for j ≤ k, with the factor of its square in τ².
fn thirds(coordinates: &[Coefficients; 3]) -> Vec<(f64, Coefficients)> {
    let mut out = Vec::with_capacity(54);
    for f in coordinates {
        for first in rotational_gradient(f) {
            let second = rotational_gradient(&first);
            let third = second.each_ref().map(rotational_gradient);
            for (j, k) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)] {
                let mean = Coefficients::combination([(0.5, &third[k][j]), (0.5, &third[j][k])]);
                out.push((if j == k { 1.0 } else { 2.0 }, mean));
            }
        }
    }
    out
}

/// max Σ|wₖ(t)| over the cell 0 ≤ t ≤ 1 of the stencil's Lagrange polynomials, nodes −3 … 4.
fn lebesgue_constant() -> f64 {
    const STEPS: usize = 1000;
    let node = |k: usize| k as f64 - CORNER as f64;
    let weight = |k: usize, t: f64| -> f64 {
        let others = (0..STENCIL).filter(|m| *m != k);
        others
            .map(|m| (t - node(m)) / (node(k) - node(m)))
            .product()
    };
    let sum = |t: f64| (0..STENCIL).map(|k| weight(k, t).abs()).sum::<f64>();
    let values = (0..=STEPS).map(|i| sum(i as f64 / STEPS as f64));
    // Between the places looked at it is less than 1e-3 more, since the sum of slopes is below 2.
    values.fold(0.0, f64::max) + 1e-3
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::batch;
    use sph::direction::{even_directions, retract};

    #[test]
    fn no_value_is_above_its_bound() {
        let degree = 9;
        let coordinates = [0.3, 1.1, 2.3].map(|k| {
            let mut beta = Coefficients::zeros(degree);
            for (i, b) in beta.as_mut_slice().iter_mut().enumerate() {
                *b = (k * i as f64).sin() / (1.0 + i as f64);
            }
            beta
        });
        let bounds = ThirdDerivatives::new(&coordinates);
        let centres = even_directions(300);
        let step = nalgebra::Vector3::new(0.03, -0.02, 0.025);
        let places: Vec<Direction> = centres.iter().map(|p| retract(p, &step)).collect();
        let mut squares = vec![0.0; places.len()];
        for (factor, c) in thirds(&coordinates) {
            for (s, v) in squares.iter_mut().zip(batch::evaluate(&c, &places)) {
                *s += factor * v * v;
            }
        }
        let mut tight = 0.0_f64;
        for (square, centre) in squares.iter().zip(&centres) {
            let bound = bounds.within(centre, 0.05);
            assert!(square.sqrt() <= bound);
            tight = tight.max(square.sqrt() / bound);
        }
        assert!(tight > 0.3, "{tight}");
    }
}
