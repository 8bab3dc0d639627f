//! Beyond Sec. IV-E: our transfer against the best of many runs of the paper's ascent on the target.
//!
//! The paper's ascent (Sec. IV-D) is run many times from starts around the naive transfer, and the
//! best end is kept. This is expensive, and shows whether a transfer ended below what is reachable.

mod figure;
mod findings;
mod measurement;

use serde_json::json;

pub use findings::{AtLeast, Compared, Runs, Settings, shares};
pub use measurement::measure;

use findings::SPREAD;

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
    let (compared, times) = measure(run, &settings, &set, &grasps)?;
    let shares = findings::shares(&compared);
    Ok(Results {
        objects: set.describe(),
        paper: json!({ "steps": paper::ASCENT_STEPS, "unstable": paper::UNSTABLE_TRANSFERS }),
        table: figure::table(&settings, &compared, &shares, &times),
        ours: json!({
            "runs": settings.runs,
            "spread_rad": SPREAD,
            "steps": settings.ascent.steps,
            "at_least_the_best_run": shares,
            "thread_seconds": times,
            "transfers": compared,
        }),
        figures: figure::figures(&compared),
    })
}
