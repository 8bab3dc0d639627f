//! Dense least squares by Householder QR: the reference that faster fits are compared with.

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;

use super::{Penalty, RegressionError, Samples};
use crate::basis::Basis;
use crate::coefficients::Coefficients;
use crate::index;

/// argmin Σᵢ (h(pᵢ) − fᵢ)² + Σ λ(l(l+1))^s β_{lm}² over h of degree L (Sec. II-C of the paper).
///
/// The penalty adds (L+1)² rows to the matrix, so the normal equations are never formed. Needs
/// 8·(N + (L+1)²)·(L+1)² bytes and about 2·N·(L+1)⁴ flops: 520 MB and several seconds for N = 25,000 and
/// L = 50.
///
/// # Errors
/// As [`Samples::check`]; λ is not a finite number ≥ 0; or there are fewer rows than coefficients or the
/// triangle is numerically singular ([`RegressionError::RankDeficient`]).
pub fn fit(
    samples: Samples,
    degree: usize,
    penalty: Penalty,
) -> Result<Coefficients, RegressionError> {
    fit_weighted(samples, None, degree, penalty)
}

/// [`fit`] with one weight ≥ 0 per sample: Σᵢ wᵢ (h(pᵢ) − fᵢ)².
pub(super) fn fit_weighted(
    samples: Samples,
    weights: Option<&[f64]>,
    degree: usize,
    penalty: Penalty,
) -> Result<Coefficients, RegressionError> {
    samples.check()?;
    penalty.check()?;
    let unknowns = index::count(degree);
    let rank_deficient = RegressionError::RankDeficient {
        samples: samples.values.len(),
        coefficients: unknowns,
        degree,
    };
    let (matrix, right) = system(samples, weights, degree, penalty);
    if matrix.nrows() < unknowns {
        return Err(rank_deficient);
    }
    let qr = matrix.qr();
    let diagonal = (0..unknowns).map(|i| qr.R()[(i, i)].abs());
    let (least, most) = diagonal.fold((f64::INFINITY, 0.0_f64), |(a, b), d| (a.min(d), b.max(d)));
    if least.is_nan() || least <= most * 1e-13 {
        return Err(rank_deficient);
    }
    let solution = qr.solve_lstsq(&right);
    let values = (0..unknowns).map(|i| solution[(i, 0)]).collect();
    Coefficients::new(values).map_err(|_| rank_deficient)
}

/// Rows Y_{lm}(pᵢ), then the penalty's rows; and the right-hand side.
fn system(
    samples: Samples,
    weights: Option<&[f64]>,
    degree: usize,
    penalty: Penalty,
) -> (Mat<f64>, Mat<f64>) {
    let (points, unknowns) = (samples.values.len(), index::count(degree));
    let extra = if penalty.lambda > 0.0 { unknowns } else { 0 };
    let basis = Basis::new(degree);
    let mut work = basis.workspace();
    let mut row = vec![0.0; unknowns];
    let mut matrix = Mat::zeros(points + extra, unknowns);
    let mut right = Mat::zeros(points + extra, 1);
    for (i, (p, f)) in samples.directions.iter().zip(samples.values).enumerate() {
        basis.values(p, &mut work, &mut row);
        let root = weights.map_or(1.0, |w| w[i].sqrt());
        for (j, y) in row.iter().enumerate() {
            matrix[(i, j)] = root * y;
        }
        right[(i, 0)] = root * f;
    }
    for j in 0..extra {
        let (l, _) = index::degree_order(j);
        matrix[(points + j, j)] = penalty.weight(l).sqrt();
    }
    (matrix, right)
}
