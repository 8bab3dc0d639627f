//! Fig. 7, Fig. 8 and Sec. IV-D: the paper's ascent and ours from the grasps of G_i.

mod figure;
mod findings;
mod measurement;

use serde_json::json;

pub use findings::{
    Climb, DrawnClimb, ObjectClimbs, OurClimb, Overall, PaperClimb, Settings, overall,
};
pub use measurement::measure;

use crate::error::ExperimentError;
use crate::output::Results;
use crate::paper;
use crate::pipeline::{best_grasps, fitted_objects};
use crate::run::Run;

/// Runs the section: the measurement, then the table and the figures.
///
/// # Errors
/// Too few objects can be used, or a computation fails.
pub fn run(run: &Run) -> Result<Results, ExperimentError> {
    let settings = Settings::of(run);
    let set = fitted_objects(run, None, 1)?;
    let grasps = best_grasps(run, &set, settings.poses, settings.grasps)?;
    let (ours, times) = measure(run, &settings, &set, &grasps)?;
    let all: Vec<Climb> = ours.iter().flat_map(|o| o.climbs.iter().cloned()).collect();
    let overall = overall(&all);
    Ok(Results {
        objects: set.describe(),
        paper: json!({
            "poses": paper::HAND_POSES,
            "grasps_per_object": paper::BEST_GRASPS,
            "steps": paper::ASCENT_STEPS,
            "delta": paper::DIFFERENCE_STEP,
            "rate": paper::ASCENT_RATE,
            "examples_initial_final": paper::ASCENT_EXAMPLES,
            "finding": "quality typically improves significantly; some ascents do not converge and end worse",
        }),
        table: figure::table(&settings, &ours, &overall, &times),
        ours: json!({
            "poses": settings.poses,
            "grasps_per_object": settings.grasps,
            "steps": settings.ascent.steps,
            "overall": overall,
            "thread_seconds": times,
            "largest_improvements_initial_final": findings::examples(&all),
            "by_object": ours,
        }),
        figures: figure::figures(
            &ours,
            &measurement::drawn(run, &settings, &set, &grasps, &ours)?,
        ),
    })
}
