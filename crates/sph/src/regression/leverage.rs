//! The diagonal of the hat matrix, as a function on the sphere.
//!
//! y(p)ᵀ V y(p), with y the harmonics up to degree L and V a symmetric matrix, is a function of degree
//! 2L: its coefficients follow from V ring by ring, as the Gram matrix follows from the density, and
//! all points are then read at once.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};

use super::dense::{Order, legendre_tables};
use crate::coefficients::Coefficients;
use crate::grid::gauss_legendre;

/// Coefficients up to degree 2L of y(p)ᵀ V y(p); V in [`Order`]. About 2 L⁵ flops.
pub(super) fn quadratic_form(matrix: MatRef<f64>, degree: usize, order: &Order) -> Coefficients {
    let (nodes, weights) = gauss_legendre(2 * degree + 1);
    let tables = legendre_tables(degree, &nodes);
    let mut modes = RingModes::new(degree, nodes.len());
    for n in 0..=degree {
        for m in n..=degree {
            let (rows, columns) = (degree - m + 1, degree - n + 1);
            for (sin_m, sin_n) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                // The sine of order 0 does not exist; of two mirrored blocks of one order, one serves.
                let absent = (sin_m == 1 && m == 0) || (sin_n == 1 && n == 0);
                if absent || (m == n && sin_n > sin_m) {
                    continue;
                }
                let row = order.starts[m] + sin_m * rows;
                let column = order.starts[n] + sin_n * columns;
                let block = matrix.submatrix(row, column, rows, columns);
                let twice = if row == column { 1.0 } else { 2.0 };
                let mut image = Mat::zeros(nodes.len(), columns);
                let left = tables[m].as_ref();
                matmul(image.as_mut(), Accum::Replace, left, block, twice, Par::Seq);
                modes.add(m, n, (sin_m == 1, sin_n == 1), &image, &tables[n]);
            }
        }
    }
    modes.coefficients(&nodes, &weights)
}

/// Σ a_k cos kφ + b_k sin kφ on every ring; index k · rings + j.
struct RingModes {
    degree: usize,
    rings: usize,
    cos: Vec<f64>,
    sin: Vec<f64>,
}

impl RingModes {
    /// Nothing yet, for products of two functions of degree L.
    fn new(degree: usize, rings: usize) -> Self {
        let size = (2 * degree + 1) * rings;
        Self {
            degree: 2 * degree,
            rings,
            cos: vec![0.0; size],
            sin: vec![0.0; size],
        }
    }

    /// Adds (row of `left` · row of `right`) T_m(φ) T_n(φ) on every ring, T the cosine or the sine.
    fn add(&mut self, m: usize, n: usize, sines: (bool, bool), left: &Mat<f64>, right: &Mat<f64>) {
        for j in 0..self.rings {
            let mut product = 0.0;
            for l in 0..left.ncols() {
                product += left[(j, l)] * right[(j, l)];
            }
            let half = 0.5 * product;
            let (sum, difference) = ((m + n) * self.rings + j, (m - n) * self.rings + j);
            let (list, at_sum, at_difference) = match sines {
                (false, false) => (&mut self.cos, half, half),
                (false, true) => (&mut self.sin, half, -half),
                (true, false) => (&mut self.sin, half, half),
                (true, true) => (&mut self.cos, -half, half),
            };
            list[sum] += at_sum;
            list[difference] += at_difference;
        }
    }

    /// ∫ (the sum) Y_{lm} for all l, by Gauss–Legendre quadrature over the rings.
    fn coefficients(&self, nodes: &[f64], weights: &[f64]) -> Coefficients {
        let mut out = Coefficients::zeros(self.degree);
        let tables = legendre_tables(self.degree, nodes);
        for (k, table) in tables.iter().enumerate() {
            let circle = std::f64::consts::PI * if k == 0 { 2.0 } else { 1.0 };
            for l in k..=self.degree {
                let (mut even, mut odd) = (0.0, 0.0);
                for (j, weight) in weights.iter().enumerate() {
                    let share = circle * weight * table[(j, l - k)];
                    even += share * self.cos[k * self.rings + j];
                    odd += share * self.sin[k * self.rings + j];
                }
                out.as_mut_slice()[l * l + l + k] = even;
                if k > 0 {
                    out.as_mut_slice()[l * l + l - k] = odd;
                }
            }
        }
        out
    }
}
