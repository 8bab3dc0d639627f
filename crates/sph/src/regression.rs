//! Least-squares fits of Σ β_{lm} Y_{lm} to samples of a function on the sphere.

mod conjugate;
mod dense;
pub mod gram;
mod lanczos;
mod operator;
pub mod penalty;
mod points;
pub mod qr;
mod refine;

use crate::direction::Direction;

pub use gram::Gram;
pub use penalty::Penalty;

/// Samples fᵢ at directions pᵢ.
#[derive(Clone, Copy, Debug)]
pub struct Samples<'a> {
    /// pᵢ.
    pub directions: &'a [Direction],
    /// fᵢ.
    pub values: &'a [f64],
}

/// How the least-squares problem is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Cholesky for degrees up to 16; above, conjugate gradients, and Cholesky where they are slow.
    #[default]
    Automatic,
    /// Preconditioned conjugate gradients on the Gram operator: O(L³) an iteration, no matrix. Where
    /// the matrix of harmonics has a condition beyond some thousands it gives up with
    /// [`RegressionError::NotConverged`]; a factor serves there, and beyond
    /// cond(Y) ≈ 1e4, where corrections no longer settle, [`Method::Qr`].
    Conjugate,
    /// The dense factor of the Gram matrix: O(L⁶) flops, 16 (L+1)⁴ bytes.
    Cholesky,
    /// Householder QR of the dense N × (L+1)² matrix: the reference.
    Qr,
}

/// Why a regression has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RegressionError {
    /// The lists differ in length.
    #[error("{directions} directions but {values} values")]
    Lengths {
        /// Number of directions.
        directions: usize,
        /// Number of values.
        values: usize,
    },
    /// There is nothing to fit.
    #[error("no samples")]
    Empty,
    /// A value or direction is NaN or infinite.
    #[error("sample {index} has value {value}; expected a finite value at a unit direction")]
    NotFinite {
        /// Which sample.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Without a penalty the samples do not determine the coefficients.
    #[error(
        "{samples} samples do not determine the {coefficients} coefficients of degree {degree}; lower the degree or use a penalty"
    )]
    RankDeficient {
        /// Number of samples.
        samples: usize,
        /// Number of unknowns.
        coefficients: usize,
        /// Degree L.
        degree: usize,
    },
    /// The weights do not fit the samples: one finite weight ≥ 0 a sample, not all zero.
    #[error(
        "weight {index} is {value}; expected one finite weight a sample, none negative, one positive"
    )]
    Weight {
        /// Which weight; the number of samples when their number is wrong.
        index: usize,
        /// The value found; NaN when there is none.
        value: f64,
    },
    /// The iteration did not reach its accuracy and the problem is too large to factor.
    #[error(
        "degree {degree} not solved within {iterations} iterations; lower the degree or use a larger penalty"
    )]
    NotConverged {
        /// Degree L.
        degree: usize,
        /// Iterations spent.
        iterations: usize,
    },
    /// The penalty is not a finite number ≥ 0.
    #[error("penalty {lambda}; expected a finite number that is not negative")]
    Penalty {
        /// The value given.
        lambda: f64,
    },
}

impl Samples<'_> {
    /// Checks lengths and finiteness.
    pub fn check(&self) -> Result<(), RegressionError> {
        if self.directions.len() != self.values.len() {
            return Err(RegressionError::Lengths {
                directions: self.directions.len(),
                values: self.values.len(),
            });
        }
        if self.values.is_empty() {
            return Err(RegressionError::Empty);
        }
        let bad = |(p, v): (&Direction, &f64)| !v.is_finite() || !p.iter().all(|x| x.is_finite());
        match self.directions.iter().zip(self.values).position(bad) {
            Some(index) => Err(RegressionError::NotFinite {
                index,
                value: self.values[index],
            }),
            None => Ok(()),
        }
    }
}
