//! Regression of x, y and z over given sphere coordinates.

use nalgebra::{Point3, Vector3};
use sph::regression::{Gram, Penalty, RegressionError, Samples};
use sph::{Coefficients, Direction, batch};

use crate::fit::{FitSettings, PENALTY_POWER, choose_penalty};
use crate::immersion::SphericalError;
use crate::point_cloud::PointCloud;
use crate::spherical::SphericalShape;

/// Why no surface in M^sph was fitted to points with sphere coordinates.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SphericalFitError {
    /// A regression failed.
    #[error(transparent)]
    Regression(#[from] RegressionError),
    /// The fitted map is not an immersion.
    #[error(transparent)]
    Spherical(#[from] SphericalError),
}

/// A fitted map and its residuals.
#[derive(Clone, Debug)]
pub struct SphericalFit {
    /// The surface, in the centred frame.
    pub shape: SphericalShape,
    /// Origin of the centred frame in the frame of the cloud: the mean of the cloud. Metres.
    pub centre_in_cloud: Point3<f64>,
    /// λ used for x, y and z.
    pub lambda: [f64; 3],
    /// Root mean square of |f(pᵢ) − xᵢ|, metres.
    pub rms: f64,
    /// Largest |f(pᵢ) − xᵢ|, metres.
    pub max_abs: f64,
    /// Largest condition number of the three regressions.
    pub condition: f64,
}

/// Fits f(pᵢ) ≈ xᵢ, coordinate by coordinate, and proves the result an immersion.
///
/// `directions` has one direction per point of the cloud, chosen by the caller. λ is chosen for
/// each coordinate unless it is given. Costs three radial fits.
pub fn fit_spherical(
    directions: &[Direction],
    cloud: &PointCloud,
    settings: &FitSettings,
) -> Result<SphericalFit, SphericalFitError> {
    let centre = cloud.mean();
    let offsets: Vec<Vector3<f64>> = cloud.points().iter().map(|p| p - centre).collect();
    let mut squares = vec![0.0; offsets.len()];
    let mut lambdas = [0.0; 3];
    let mut condition = 0.0_f64;
    let mut coordinates = Vec::with_capacity(3);
    for (axis, lambda) in lambdas.iter_mut().enumerate() {
        let values: Vec<f64> = offsets.iter().map(|x| x[axis]).collect();
        let samples = Samples {
            directions,
            values: &values,
        };
        let gram = Gram::new(samples, settings.degree)?;
        let penalty = match settings.lambda {
            Some(lambda) => Penalty {
                lambda,
                power: PENALTY_POWER,
            },
            None => choose_penalty(&gram, values.len(), settings.degree)?,
        };
        let solution = gram.solve(samples, penalty)?;
        let fitted = batch::evaluate(&solution.coefficients, directions);
        for (square, (f, x)) in squares.iter_mut().zip(fitted.iter().zip(&values)) {
            *square += (f - x).powi(2);
        }
        *lambda = penalty.lambda;
        condition = condition.max(solution.condition);
        coordinates.push(solution.coefficients);
    }
    let axis = |k: usize| -> Coefficients { coordinates[k].clone() };
    Ok(SphericalFit {
        shape: SphericalShape::new(axis(0), axis(1), axis(2))?,
        centre_in_cloud: centre,
        lambda: lambdas,
        rms: (squares.iter().sum::<f64>() / squares.len() as f64).sqrt(),
        max_abs: squares.iter().fold(0.0_f64, |a, b| a.max(*b)).sqrt(),
        condition,
    })
}
