//! Fig. 9 and Sec. IV-E: grasps transferred from every object to every other.

mod figure;
mod findings;
mod measurement;

use serde_json::json;

pub use findings::{Carried, Count, DrawnTransfer, OurCarried, PaperCarried, Settings};
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
    let set = fitted_objects(run, settings.objects.as_deref(), 2)?;
    let grasps = best_grasps(run, &set, settings.poses, settings.grasps)?;
    let (carried, times) = measure(run, &settings, &set, &grasps)?;
    let counts = measurement::counts(run, &set, &carried);
    let drawn = measurement::drawn(run, &settings, &set, &grasps)?;
    let by_source: Vec<_> = paper::UNSTABLE_BY_SOURCE
        .iter()
        .map(|(source, count)| json!({ "from": format!("S{source}"), "unstable": count }))
        .collect();
    Ok(Results {
        objects: set.describe(),
        paper: json!({
            "poses": paper::HAND_POSES,
            "grasps_per_source": paper::VERY_BEST_GRASPS,
            "stations": paper::TRANSFER_STATIONS,
            "steps_per_station": paper::TRANSFER_STEPS,
            "transfers": paper::TRANSFERS,
            "transfers_per_source": paper::TRANSFERS_PER_SOURCE,
            "unstable_below": paper::UNSTABLE_BELOW,
            "unstable": paper::UNSTABLE_TRANSFERS,
            "unstable_by_source": by_source,
        }),
        table: figure::table(&settings, &counts, &times),
        ours: json!({
            "poses": settings.poses,
            "grasps_per_source": settings.grasps,
            "stations": settings.transfer.intervals + 1,
            "steps_per_station": settings.transfer.ascent.steps,
            "unstable_below": run.convention.stable_above,
            "counts": counts,
            "thread_seconds": times,
            "transfers": carried,
        }),
        figures: figure::figures(&carried, &counts, drawn.as_ref()),
    })
}
