//! From a cloud to a proved member of M^rad.

use nalgebra::Point3;
use sph::regression::{Gram, Penalty, RegressionError, Samples};

use crate::point_cloud::PointCloud;
use crate::radial::{RadialError, RadialShape};

/// How a cloud is turned into a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSettings {
    /// Highest degree L; the paper uses 50.
    pub degree: usize,
    /// λ of the penalty λ Σ (l(l+1))² β²; chosen from the data when absent.
    pub lambda: Option<f64>,
}

/// Exponent of l(l+1) in the penalty: the spherical thin-plate spline.
pub const PENALTY_POWER: i32 = 2;

/// Why a cloud has no surface in M^rad.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// The regression failed.
    #[error(transparent)]
    Regression(#[from] RegressionError),
    /// The fitted function is no radius.
    #[error(transparent)]
    Radial(#[from] RadialError),
}

/// A fitted surface and how well it fits.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The surface, in the centred frame.
    pub shape: RadialShape,
    /// Origin of the centred frame in the frame of the cloud: the mean of the cloud. Metres.
    pub centre_in_cloud: Point3<f64>,
    /// λ used.
    pub lambda: f64,
    /// Root mean square of |rᵢ − r(pᵢ)|, metres.
    pub rms: f64,
    /// Largest |rᵢ − r(pᵢ)|, metres.
    pub max_abs: f64,
    /// Condition number of the penalised regression.
    pub condition: f64,
}

/// Fits r(p) = Σ β Y to the cloud seen from its mean (Sec. III-B and IV-A of the paper), with a
/// penalty, and proves the result positive.
pub fn fit(cloud: &PointCloud, settings: &FitSettings) -> Result<Fit, FitError> {
    let centre = cloud.mean();
    let seen = cloud.seen_from(&centre);
    let samples = Samples {
        directions: &seen.directions,
        values: &seen.radii,
    };
    let gram = Gram::new(samples, settings.degree)?;
    let penalty = match settings.lambda {
        Some(lambda) => Penalty {
            lambda,
            power: PENALTY_POWER,
        },
        None => gram.choose_penalty(PENALTY_POWER)?,
    };
    let solution = gram.solve(samples, penalty)?;
    let shape = RadialShape::new(solution.coefficients)?;
    let (mut squares, mut max_abs) = (0.0, 0.0_f64);
    for (fitted, radius) in shape.radii(&seen.directions).iter().zip(&seen.radii) {
        squares += (fitted - radius).powi(2);
        max_abs = max_abs.max((fitted - radius).abs());
    }
    Ok(Fit {
        shape,
        centre_in_cloud: centre,
        lambda: penalty.lambda,
        rms: (squares / seen.radii.len() as f64).sqrt(),
        max_abs,
        condition: solution.condition,
    })
}
