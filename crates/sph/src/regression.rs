//! Least-squares fits of Σ β_{lm} Y_{lm} to samples of a function on the sphere (Sec. II-C of the paper).
//!
//! A fit minimises Σᵢ wᵢ (h(pᵢ) − fᵢ)² + Σ λ (l(l+1))^s β_{lm}² over functions h of degree L. [`Gram`]
//! assembles the normal equations in one pass over the samples and then solves for any [`Penalty`]; it can
//! also choose λ. [`qr`] is the dense reference.
//!
//! ```
//! use sph::direction::even_directions;
//! use sph::regression::{Gram, Samples};
//!
//! # fn main() -> Result<(), sph::regression::RegressionError> {
//! // f(p) = 2 + z with noise of 0.01.
//! let directions = even_directions(500);
//! let values: Vec<f64> = directions
//!     .iter()
//!     .enumerate()
//!     .map(|(i, p)| 2.0 + p.z + 0.01 * (78.233 * i as f64).sin())
//!     .collect();
//! let samples = Samples { directions: &directions, values: &values };
//! let gram = Gram::new(samples, 6)?;
//! let penalty = gram.choose_penalty(2)?;
//! let beta = gram.solve(samples, penalty)?.coefficients;
//! // z = √(4π/3) Y_{1,0}.
//! assert!((beta.get(1, 0) - (4.0 * std::f64::consts::PI / 3.0).sqrt()).abs() < 0.01);
//! # Ok(())
//! # }
//! ```

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

/// The solver of the normal equations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Cholesky for degrees up to 16; above, conjugate gradients, and Cholesky up to degree 80 if they
    /// converge slowly.
    #[default]
    Automatic,
    /// Preconditioned conjugate gradients on the Gram operator: O(L³) flops per iteration and no matrix.
    /// If the condition number of the matrix of harmonics exceeds a few thousand, the result is
    /// [`RegressionError::NotConverged`]. [`Method::Cholesky`] works up to cond(Y) ≈ 1e4, and
    /// [`Method::Qr`] beyond.
    Conjugate,
    /// A Cholesky factor of the dense Gram matrix: O(L⁶) flops, 16 (L+1)⁴ bytes.
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
    /// There are no samples.
    #[error("no samples")]
    Empty,
    /// A value or direction is NaN or infinite.
    #[error("sample {index} has value {value}; expected a finite value at a unit direction")]
    NotFinite {
        /// Index of the sample.
        index: usize,
        /// The value of the sample.
        value: f64,
    },
    /// The samples do not determine the coefficients, and there is no penalty.
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
    /// A weight is missing, negative or not finite, or all weights are zero.
    #[error(
        "weight {index} is {value}; expected one finite weight per sample, none negative and at least one positive"
    )]
    Weight {
        /// Index of the weight; the number of samples if there are more or fewer weights.
        index: usize,
        /// The weight found; NaN if it is missing.
        value: f64,
    },
    /// The iteration did not reach its accuracy, and the degree is too high for a dense factor.
    #[error(
        "degree {degree} not solved within {iterations} iterations; lower the degree or use a larger penalty"
    )]
    NotConverged {
        /// Degree L.
        degree: usize,
        /// Number of iterations.
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
    /// Checks the lengths and that all numbers are finite.
    ///
    /// # Errors
    /// The lengths differ, there are no samples, or a direction or value is not finite.
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
