//! The effect of noise on a band of coefficients.

use serde::Serialize;
use shape::RadialShape;
use space::ModuliPoint;

use crate::run::Run;

/// Amount of computation.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Number of samples of each object, band and standard deviation.
    pub samples: usize,
    /// Standard deviations on the coarse band, metres.
    pub coarse_sigmas: Vec<f64>,
    /// Standard deviations on the fine band, metres.
    pub fine_sigmas: Vec<f64>,
}

impl Settings {
    /// The settings of a run.
    ///
    /// The paper states no standard deviation. These change the radius by 2 to 18 mm (coarse) and 1
    /// to 11 mm (fine) in the root mean square: from barely visible to more than its figures show.
    pub fn of(run: &Run) -> Self {
        Self {
            samples: run.scale.pick(4, 100),
            coarse_sigmas: run
                .scale
                .pick(vec![0.005, 0.02], vec![0.0025, 0.005, 0.01, 0.02]),
            fine_sigmas: run
                .scale
                .pick(vec![0.001, 0.004], vec![0.0005, 0.001, 0.002, 0.004]),
        }
    }
}

/// The effect of noise of one standard deviation on one band, over all objects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// "coarse" or "fine".
    pub band: &'static str,
    /// First and last position of the band.
    pub positions: (usize, usize),
    /// Standard deviation on each coefficient, metres.
    pub sigma_m: f64,
    /// Number of samples.
    pub samples: usize,
    /// Number of samples proved to be in M^rad.
    pub in_m_rad: usize,
    /// Share of samples proved to be in M^rad.
    pub share_in_m_rad: Option<f64>,
    /// Mean of the root mean square change of the radius over the sphere, ‖δβ‖/√(4π), metres.
    pub rms_radius_change_m: Option<f64>,
    /// Mean of √(Σ l(l+1) δβ²)/‖δβ‖, approximately the number of waves of the change around the
    /// sphere.
    pub roughness: Option<f64>,
    /// Mean of the root mean square slope of the change, √(Σ l(l+1) δβ²/4π) over the mean radius.
    pub rms_slope_change: Option<f64>,
    /// Share of the samples in M^rad whose three random contacts are closed.
    pub share_force_closed: Option<f64>,
}

/// Samples of one band, for a figure.
pub struct DrawnBand {
    /// The band and the standard deviation.
    pub title: String,
    /// The samples.
    pub samples: Vec<ModuliPoint<RadialShape>>,
}
