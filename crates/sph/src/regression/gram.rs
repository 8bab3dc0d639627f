//! Least squares through the Gram matrix, assembled without touching the N × (L+1)² matrix.
//!
//! With the moments ρ_{LM} = Σᵢ Y_{LM}(pᵢ) up to degree 2L, the density ρ = Σ ρ_{LM} Y_{LM} has
//! the same inner products with products of two harmonics of degree ≤ L as the samples have:
//! (YᵀY)_{ab} = ∫ ρ Y_a Y_b, exactly, and Gauss–Legendre rings exact to degree 4L integrate it.
//! One pass over the points; nothing after it depends on their number.

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::{Llt, Solve};
use faer::{Accum, Mat, MatRef, Par, Side};

use super::penalty::{golden_section, roughness};
use super::{Penalty, RegressionError, Samples};
use crate::batch;
use crate::coefficients::Coefficients;
use crate::grid::gauss_legendre;
use crate::index;
use crate::legendre::Legendre;

/// The normal equations of a set of samples at one degree.
pub struct Gram {
    degree: usize,
    samples: usize,
    /// YᵀY in [`Order`], lower triangle.
    matrix: Mat<f64>,
    /// Yᵀ(f − mean), position l²+l+m.
    right: Coefficients,
    /// Σ (fᵢ − mean)².
    sum_squares: f64,
    mean: f64,
    order: Order,
}

/// A solved system: what [`Gram::solve`] found, and how well posed it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// β.
    pub coefficients: Coefficients,
    /// Condition number of [Y; √penalty], to about ten per cent.
    pub condition: f64,
}

impl Gram {
    /// Assembles YᵀY and Yᵀf. About 16·N·L² + L⁵ flops and 8·(L+1)⁴ bytes (54 MB at L = 50).
    pub fn new(samples: Samples, degree: usize) -> Result<Self, RegressionError> {
        samples.check()?;
        let count = samples.values.len();
        let mean = samples.values.iter().sum::<f64>() / count as f64;
        let centred: Vec<f64> = samples.values.iter().map(|f| f - mean).collect();
        let density = batch::moments(samples.directions, &vec![1.0; count], 2 * degree);
        let order = Order::new(degree);
        Ok(Self {
            degree,
            samples: count,
            matrix: assemble(&density, degree, &order),
            right: batch::moments(samples.directions, &centred, degree),
            sum_squares: centred.iter().map(|f| f * f).sum(),
            mean,
            order,
        })
    }

    /// argmin Σᵢ (h(pᵢ) − fᵢ)² + penalty, with one step of refinement on the true residual.
    ///
    /// `samples` are those the system was assembled from. Costs (L+1)⁶/3 flops.
    pub fn solve(&self, samples: Samples, penalty: Penalty) -> Result<Solution, RegressionError> {
        let factor = self.factor(penalty)?;
        let mut beta = self.order.solve(&factor, &self.right);
        let fitted = batch::evaluate(&beta, samples.directions);
        let residual: Vec<f64> = samples
            .values
            .iter()
            .zip(&fitted)
            .map(|(f, h)| f - self.mean - h)
            .collect();
        let mut gradient = batch::moments(samples.directions, &residual, self.degree);
        for (i, g) in gradient.as_mut_slice().iter_mut().enumerate() {
            *g -= penalty.weight(index::degree_order(i).0) * beta.as_slice()[i];
        }
        let step = self.order.solve(&factor, &gradient);
        beta = Coefficients::combination([(1.0, &beta), (1.0, &step)]);
        beta.as_mut_slice()[0] += self.mean * (4.0 * std::f64::consts::PI).sqrt();
        if beta.as_slice().iter().any(|b| !b.is_finite()) {
            return Err(self.rank_deficient());
        }
        Ok(Solution {
            condition: self.condition(penalty, &factor),
            coefficients: beta,
        })
    }

    /// The λ that maximises the restricted marginal likelihood of the samples (REML).
    ///
    /// Model: fᵢ = h(pᵢ) + noise of variance σ², β_{lm} ~ N(0, σ² / (λ(l(l+1))^power)) for l ≥ 1,
    /// flat in the constant. Minimises (N−1) log RSS(λ) + log|YᵀY + λD| − ((L+1)²−1) log λ by
    /// golden section in log₁₀(λ/N) ∈ [−14, 0] to a fifth of a decade; 11 factorisations.
    pub fn choose_penalty(&self, power: i32) -> Result<Penalty, RegressionError> {
        let per_sample = self.samples as f64;
        let at = |log: f64| Penalty {
            lambda: per_sample * 10.0_f64.powf(log),
            power,
        };
        let best = golden_section((-14.0, 0.0), 0.2, |log| self.marginal_cost(at(log)))?;
        Ok(at(best))
    }

    fn marginal_cost(&self, penalty: Penalty) -> Result<f64, RegressionError> {
        let factor = match self.factor(penalty) {
            Ok(factor) => factor,
            // Too little penalty to be positive definite in floating point: never the best.
            Err(RegressionError::RankDeficient { .. }) => return Ok(f64::INFINITY),
            Err(other) => return Err(other),
        };
        let beta = self.order.solve(&factor, &self.right);
        let explained: f64 = beta
            .as_slice()
            .iter()
            .zip(self.right.as_slice())
            .map(|(b, r)| b * r)
            .sum();
        // Exactly fitted data leave only rounding.
        let rss = (self.sum_squares - explained).max(1e-15 * self.sum_squares);
        let factor = factor.L();
        let log_det: f64 = (0..factor.nrows()).map(|i| factor[(i, i)].ln()).sum();
        let penalised = index::count(self.degree) as f64 - 1.0;
        Ok(
            (self.samples.max(2) as f64 - 1.0) * rss.max(f64::MIN_POSITIVE).ln() + 2.0 * log_det
                - penalised * penalty.lambda.ln(),
        )
    }

    fn factor(&self, penalty: Penalty) -> Result<Llt<f64>, RegressionError> {
        if !(penalty.lambda >= 0.0 && penalty.lambda.is_finite()) {
            return Err(RegressionError::Penalty {
                lambda: penalty.lambda,
            });
        }
        let mut matrix = self.matrix.clone();
        for (row, &position) in self.order.positions.iter().enumerate() {
            let l = index::degree_order(position).0;
            matrix[(row, row)] += penalty.lambda * roughness(l, penalty.power);
        }
        let factor = matrix.llt(Side::Lower).map_err(|_| self.rank_deficient())?;
        let lower = factor.L();
        let pivots = (0..lower.nrows()).map(|i| lower[(i, i)]);
        let (least, most) = pivots.fold((f64::INFINITY, 0.0_f64), |(a, b), d| (a.min(d), b.max(d)));
        // The pivots of a Gram matrix are those of a triangle R; below √ε they are rounding.
        if least > most * 1e-8 || penalty.lambda > 0.0 {
            Ok(factor)
        } else {
            Err(self.rank_deficient())
        }
    }

    /// √(largest / smallest eigenvalue) of YᵀY + penalty, by power and inverse iteration.
    fn condition(&self, penalty: Penalty, factor: &Llt<f64>) -> f64 {
        let size = self.order.positions.len();
        let start = || Mat::from_fn(size, 1, |i, _| 1.0 + 0.5 * (i as f64 * 1.618).sin());
        let (mut high, mut low) = (start(), start());
        let (mut largest, mut smallest) = (1.0, 1.0);
        for _ in 0..8 {
            let lower = factor.L();
            high = lower * (lower.transpose() * &high);
            largest = high.norm_l2();
            high /= faer::Scale(largest);
            low = factor.solve(&low);
            smallest = 1.0 / low.norm_l2();
            low *= faer::Scale(smallest);
        }
        debug_assert!(penalty.lambda >= 0.0);
        (largest / smallest).sqrt()
    }

    fn rank_deficient(&self) -> RegressionError {
        RegressionError::RankDeficient {
            samples: self.samples,
            coefficients: index::count(self.degree),
            degree: self.degree,
        }
    }
}

/// [`Gram::new`] and [`Gram::solve`] in one.
pub fn fit(
    samples: Samples,
    degree: usize,
    penalty: Penalty,
) -> Result<Coefficients, RegressionError> {
    let solution = Gram::new(samples, degree)?.solve(samples, penalty)?;
    Ok(solution.coefficients)
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

    fn solve(&self, factor: &Llt<f64>, right: &Coefficients) -> Coefficients {
        let size = self.positions.len();
        let mut x = Mat::from_fn(size, 1, |i, _| right.as_slice()[self.positions[i]]);
        factor.solve_in_place(&mut x);
        let mut out = Coefficients::zeros(right.degree());
        for (row, &position) in self.positions.iter().enumerate() {
            out.as_mut_slice()[position] = x[(row, 0)];
        }
        out
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

/// P̄_l^m at every ring, one rings × (L−m+1) matrix an order.
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
