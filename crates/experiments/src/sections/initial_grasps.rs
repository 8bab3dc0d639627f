//! Sec. IV-C: grasps of the Schunk hand from random poses, G_i and Ĝ_i.

mod figure;
mod findings;
mod measurement;

use moduli::records::convention_record;
use serde_json::json;

pub use findings::{ObjectGrasps, Settings, UnderConvention};
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
    let set = fitted_objects(run, None, 1)?;
    let ours = measure(run, &Settings::of(run), &set)?;
    let conventions = measurement::all_conventions();
    let described: Vec<_> = conventions.iter().map(convention_record).collect();
    Ok(Results {
        objects: set.describe(),
        paper: json!({
            "poses": paper::HAND_POSES,
            "stable_above": paper::STABLE_GRASPS_ABOVE,
            "best_grasps": paper::BEST_GRASPS,
            "very_best_grasps": paper::VERY_BEST_GRASPS,
            "collision_mesh_vertices": paper::COLLISION_VERTICES,
        }),
        table: figure::table(&ours, &conventions),
        ours: json!({ "grasps": ours, "conventions": described }),
        figures: figure::figures(&set, &ours),
    })
}
