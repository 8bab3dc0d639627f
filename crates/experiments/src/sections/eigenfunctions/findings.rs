//! The errors of the eigenfunctions.

use serde::Serialize;

use crate::paper;
use crate::run::Run;

/// Amount of computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Highest degree of the tested Y_{l,m}.
    pub degree: usize,
    /// Number of directions at which they are evaluated, besides the poles.
    pub directions: usize,
}

impl Settings {
    /// The settings of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            degree: run.scale.pick(20, paper::DEGREE),
            directions: run.scale.pick(40, 60),
        }
    }
}

/// Largest errors over all Y_{l,m} up to the degree.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Eigenfunctions {
    /// Highest degree.
    pub degree: usize,
    /// Number of functions.
    pub functions: usize,
    /// |∫ Y_a Y_b − δ_ab|, by a quadrature that is exact for these products.
    pub orthonormality_error: f64,
    /// |Y − the formula of Sec. II-C| over √((2l+1)/4π), the largest value that degree l can take.
    pub formula_error: f64,
    /// |ΔY + l(l+1) Y| over l(l+1) √((2l+1)/4π), ΔY the trace of the Hessian.
    pub laplacian_error: f64,
    /// The same with ΔY from differences of the paper's formula along great circles, which have an
    /// error of about 1e-10.
    pub difference_laplacian_error: f64,
    /// Errors of the Laplacian by degree, from the Hessian.
    pub laplacian_error_by_degree: Vec<f64>,
}
