//! Fig. 2 and Sec. III-B: surfaces from a cloud with all eigenspaces up to degree L.

mod figure;
mod findings;
mod measurement;

use serde_json::json;

pub use findings::{Fitted, Reconstruction, Settings};
pub use measurement::measure;

use crate::error::ExperimentError;
use crate::objects::Objects;
use crate::output::Results;
use crate::paper;
use crate::run::Run;

/// Runs the section: the measurement, then the table and the figures.
///
/// # Errors
/// Too few objects can be used, or a computation fails.
pub fn run(run: &Run) -> Result<Results, ExperimentError> {
    let settings = Settings::of(run);
    let mut objects = Objects::load(&run.objects, run.seed)?.only(run.only)?;
    if let (Some(numbers), true) = (&settings.objects, run.only.is_empty()) {
        objects = objects.select(numbers);
    }
    let fits = measure(run, &settings, &objects.clouds)?;
    let ours: Vec<&Reconstruction> = fits.iter().map(|f| &f.record).collect();
    let described: Vec<_> = objects
        .clouds
        .iter()
        .map(|o| json!({ "number": o.number, "id": o.id, "name": o.name, "points": o.cloud.points().len() }))
        .collect();
    Ok(Results {
        objects: json!({
            "source": objects.source.to_string(),
            "fitted": described,
            "refused": objects.refused,
        }),
        paper: json!({
            "object": format!("S{}", paper::CLOUD_OBJECT),
            "points": paper::CLOUD_POINTS,
            "degree": paper::DEGREE,
            "degree_for_minute_details": paper::DETAILED_DEGREE,
            "finding": "as L is increased, more and more detail about the surface is captured",
        }),
        table: figure::table(&objects, &ours),
        ours: json!({ "fits": ours }),
        figures: figure::figures(&objects.clouds, &fits),
    })
}
