//! How well each surface fits.

use serde::Serialize;
use shape::RadialShape;

use crate::paper;
use crate::run::Run;

/// How much is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Numbers of the objects; all when absent.
    pub objects: Option<Vec<usize>>,
    /// The degrees L.
    pub degrees: Vec<usize>,
    /// Directions in which surfaces are compared with the true ones.
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

/// How well one surface fits its cloud. Lengths in metres.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reconstruction {
    /// The object.
    pub id: String,
    /// L.
    pub degree: usize,
    /// (L+1)².
    pub coefficients: usize,
    /// λ; 0 for plain least squares, as in the paper.
    pub lambda: f64,
    /// Whether λ was chosen from the data.
    pub penalised: bool,
    /// Root mean square of the residuals at the points.
    pub rms_m: f64,
    /// Largest residual.
    pub max_abs_m: f64,
    /// Root mean square residual, at one half of the points, of a fit to the other half.
    pub held_out_rms_m: Option<f64>,
    /// Root mean square distance of the surface from the true one, where that is known.
    pub true_rms_m: Option<f64>,
    /// Whether the surface is proved to be in M^rad.
    pub in_m_rad: bool,
}

/// A fit with its surface, where that is in M^rad.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// How well it fits.
    pub record: Reconstruction,
    /// The surface, seen from the mean of the cloud.
    pub shape: Option<RadialShape>,
}
