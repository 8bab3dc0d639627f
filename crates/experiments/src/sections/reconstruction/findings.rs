//! The errors of the fitted surfaces.

use serde::Serialize;
use shape::RadialShape;

use crate::paper;
use crate::run::Run;

/// Amount of computation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Numbers of the objects; `None` for all.
    pub objects: Option<Vec<usize>>,
    /// The degrees L.
    pub degrees: Vec<usize>,
    /// Number of directions in which surfaces are compared with the true ones.
    pub truth_directions: usize,
}

impl Settings {
    /// The settings of a run.
    pub fn of(run: &Run) -> Self {
        let mut degrees = vec![2, 5, 10, 20, 30, paper::DEGREE];
        degrees.extend(run.scale.pick(None, Some(paper::DETAILED_DEGREE)));
        Self {
            objects: run.scale.pick(Some(vec![5, 6, paper::CLOUD_OBJECT]), None),
            degrees,
            truth_directions: 2_000,
        }
    }
}

/// Errors of one surface. Lengths in metres.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reconstruction {
    /// The object.
    pub id: String,
    /// The degree L.
    pub degree: usize,
    /// The number of coefficients, (L+1)².
    pub coefficients: usize,
    /// λ; 0 for plain least squares, as in the paper.
    pub lambda: f64,
    /// Whether λ was chosen from the data.
    pub penalised: bool,
    /// Root mean square of the residuals at the points.
    pub rms_m: f64,
    /// Largest residual.
    pub max_abs_m: f64,
    /// Root mean square residual of a fit to one half of the points, at the other half.
    pub held_out_rms_m: Option<f64>,
    /// Root mean square distance of the surface from the true one, if that is known.
    pub true_rms_m: Option<f64>,
    /// Whether the surface is proved to be in M^rad.
    pub in_m_rad: bool,
}

/// A fit with its surface, if that is in M^rad.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// Errors of the fit.
    pub record: Reconstruction,
    /// The surface, in the frame centred at the mean of the cloud.
    pub shape: Option<RadialShape>,
}
