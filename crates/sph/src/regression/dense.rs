//! The dense Gram matrix, assembled ring by ring, and its Cholesky factor.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::{factor, solve};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};

use super::Penalty;
use crate::coefficients::Coefficients;
use crate::grid::gauss_legendre;
use crate::index;
use crate::legendre::Legendre;

/// YᵀWY, assembled block by block (one block per pair of orders) from the rings of its density.
pub(super) struct Dense {
    /// Lower triangle in [`Order`].
    matrix: Mat<f64>,
    order: Order,
}

/// A Cholesky factor of YᵀWY + penalty.
pub(super) struct Factor<'a> {
    /// The lower triangle; the entries above it are undefined.
    lower: Mat<f64>,
    order: &'a Order,
    /// Largest pivot over smallest: at most the condition number of the square root of the matrix.
    pub(super) pivot_ratio: f64,
}

impl Dense {
    /// Assembles the matrix. About L⁵ flops; 8·(L+1)⁴ bytes.
    pub(super) fn new(density: &Coefficients, degree: usize) -> Self {
        let order = Order::new(degree);
        Self {
            matrix: assemble(density, degree, &order),
            order,
        }
    }

    /// Its Cholesky factor; `None` if the matrix is not positive definite in floating point.
    /// (L+1)⁶/3 flops.
    pub(super) fn factor(&self, penalty: Penalty) -> Option<Factor<'_>> {
        let mut matrix = self.matrix.clone();
        for (row, &position) in self.order.positions.iter().enumerate() {
            matrix[(row, row)] += penalty.weight(index::degree_order(position).0);
        }
        let size = matrix.nrows();
        let scratch = factor::cholesky_in_place_scratch::<f64>(size, shares(), Default::default());
        factor::cholesky_in_place(
            matrix.as_mut(),
            Default::default(),
            shares(),
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        )
        .ok()?;
        let pivots = (0..size).map(|i| matrix[(i, i)]);
        let (least, most) = pivots.fold((f64::INFINITY, 0.0_f64), |(a, b), d| (a.min(d), b.max(d)));
        Some(Factor {
            pivot_ratio: most / least,
            order: &self.order,
            lower: matrix,
        })
    }
}

/// The number of parts into which large products are split. It is the same on every machine, since
/// the order of additions determines the last bits of the result.
fn shares() -> Par {
    Par::rayon(4)
}

impl Factor<'_> {
    /// M⁻¹ b, positions l²+l+m.
    pub(super) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let positions = &self.order.positions;
        let mut x = Mat::from_fn(positions.len(), 1, |i, _| right[positions[i]]);
        self.solve_in_place(&mut x);
        let mut out = vec![0.0; right.len()];
        for (row, &position) in positions.iter().enumerate() {
            out[position] = x[(row, 0)];
        }
        out
    }

    fn solve_in_place(&self, right: &mut Mat<f64>) {
        let scratch = solve::solve_in_place_scratch::<f64>(right.nrows(), right.ncols(), shares());
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        solve::solve_in_place(self.lower.as_ref(), right.as_mut(), shares(), stack);
    }
}

/// Unknowns by order: for each m the cosines l = m … L, then, for m > 0, the sines.
struct Order {
    /// Position l²+l+m of every row.
    positions: Vec<usize>,
    /// First row of order m's cosines; the sines follow after L−m+1 rows.
    starts: Vec<usize>,
}

impl Order {
    fn new(degree: usize) -> Self {
        let mut positions = Vec::with_capacity(index::count(degree));
        let mut starts = Vec::with_capacity(degree + 1);
        for m in 0..=degree {
            starts.push(positions.len());
            positions.extend((m..=degree).map(|l| l * l + l + m));
            if m > 0 {
                positions.extend((m..=degree).map(|l| l * l + l - m));
            }
        }
        Self { positions, starts }
    }
}

/// ∫ρ cos kφ dφ and ∫ρ sin kφ dφ on every ring, times the ring's weight; index k · rings + j.
struct RingMoments {
    rings: usize,
    cos: Vec<f64>,
    sin: Vec<f64>,
}

impl RingMoments {
    fn new(density: &Coefficients, nodes: &[f64], weights: &[f64]) -> Self {
        let degree = density.degree();
        let legendre = Legendre::new(degree);
        let rings = nodes.len();
        let mut cos = vec![0.0; (degree + 1) * rings];
        let mut sin = vec![0.0; (degree + 1) * rings];
        let mut column = vec![0.0; degree + 1];
        for (j, (&z, &weight)) in nodes.iter().zip(weights).enumerate() {
            let s = ((1.0 - z) * (1.0 + z)).sqrt();
            let mut power = weight * std::f64::consts::PI;
            for k in 0..=degree {
                let column = &mut column[..=degree - k];
                legendre.column(k, z, column);
                let (mut even, mut odd) = (0.0, 0.0);
                for (l, pi) in (k..).zip(column.iter()) {
                    even += pi * density.as_slice()[l * l + l + k];
                    odd += pi * density.as_slice()[l * l + l - k];
                }
                cos[k * rings + j] = even * power * if k == 0 { 2.0 } else { 1.0 };
                sin[k * rings + j] = if k == 0 { 0.0 } else { odd * power };
                power *= s;
            }
        }
        Self { rings, cos, sin }
    }

    /// Ring weights of ∫ρ T_m T_n dφ for the four products of {cos, sin} m and {cos, sin} n, m ≥ n.
    fn products(&self, m: usize, n: usize, j: usize) -> [f64; 4] {
        let at = |list: &[f64], k: usize| list[k * self.rings + j];
        let (sum, difference) = (m + n, m - n);
        let (c_sum, c_diff) = (at(&self.cos, sum), at(&self.cos, difference));
        let (s_sum, s_diff) = (at(&self.sin, sum), at(&self.sin, difference));
        [
            0.5 * (c_diff + c_sum),
            0.5 * (s_sum - s_diff),
            0.5 * (s_sum + s_diff),
            0.5 * (c_diff - c_sum),
        ]
    }
}

/// The lower triangle of YᵀY in [`Order`], ring by ring: block (m, n) is P_mᵀ diag(w) P_n.
fn assemble(density: &Coefficients, degree: usize, order: &Order) -> Mat<f64> {
    let (nodes, weights) = gauss_legendre(2 * degree + 1);
    let rings = nodes.len();
    let moments = RingMoments::new(density, &nodes, &weights);
    let tables = legendre_tables(degree, &nodes);
    let size = order.positions.len();
    let mut matrix = Mat::zeros(size, size);
    let mut scaled = Mat::zeros(rings, degree + 1);
    for n in 0..=degree {
        for m in n..=degree {
            let (rows, columns) = (degree - m + 1, degree - n + 1);
            let products: Vec<[f64; 4]> = (0..rings).map(|j| moments.products(m, n, j)).collect();
            for (k, (sin_m, sin_n)) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().enumerate() {
                if (sin_m == 1 && m == 0) || (sin_n == 1 && n == 0) {
                    continue;
                }
                for l in 0..columns {
                    for j in 0..rings {
                        scaled[(j, l)] = tables[n][(j, l)] * products[j][k];
                    }
                }
                let row = order.starts[m] + sin_m * rows;
                let column = order.starts[n] + sin_n * columns;
                let block = matrix.as_mut().submatrix_mut(row, column, rows, columns);
                let right: MatRef<f64> = scaled.as_ref().subcols(0, columns);
                let left = tables[m].transpose();
                matmul(block, Accum::Replace, left, right, 1.0, Par::Seq);
            }
        }
    }
    matrix
}

/// P̄_l^m at every ring, one rings × (L−m+1) matrix per order.
fn legendre_tables(degree: usize, nodes: &[f64]) -> Vec<Mat<f64>> {
    let legendre = Legendre::new(degree);
    let mut column = vec![0.0; degree + 1];
    (0..=degree)
        .map(|m| {
            let mut table = Mat::zeros(nodes.len(), degree - m + 1);
            for (j, &z) in nodes.iter().enumerate() {
                let power = ((1.0 - z) * (1.0 + z)).sqrt().powi(m as i32);
                let column = &mut column[..=degree - m];
                legendre.column(m, z, column);
                for (l, pi) in column.iter().enumerate() {
                    table[(j, l)] = pi * power;
                }
            }
            table
        })
        .collect()
}
