//! Fig. 4 and Sec. IV-A: the space of shapes with spheres and deformations.

mod figure;
mod findings;
mod measurement;

use serde_json::json;

pub use findings::{Passing, Place, Settings, ShapeSpace, SphereLine};
pub use measurement::measure;

use crate::error::ExperimentError;
use crate::output::Results;
use crate::paper;
use crate::pipeline::fitted_objects;
use crate::run::Run;

/// Runs the section: the measurement, then the table and the figures.
///
/// # Errors
/// Too few objects can be used, or a computation fails.
pub fn run(run: &Run) -> Result<Results, ExperimentError> {
    let set = fitted_objects(run, None, 2)?;
    let ours = measure(run, &Settings::of(run), &set)?;
    Ok(Results {
        objects: set.describe(),
        paper: json!({
            "objects": paper::OBJECTS,
            "spheres": paper::SPHERES,
            "sphere_radii_m": paper::SPHERE_RADII,
            "deformed_from": paper::DEFORMED_FROM,
            "deformed_to": paper::DEFORMED_TO,
            "passed_by_deformations": paper::PASSED_BY_DEFORMATIONS,
            "passed_by_spheres": paper::PASSED_BY_SPHERES,
        }),
        table: figure::table(&ours),
        ours: serde_json::to_value(&ours)?,
        figures: figure::figures(&set, &ours),
    })
}
