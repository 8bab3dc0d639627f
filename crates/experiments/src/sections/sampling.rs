//! Fig. 5 and Sec. IV-B: random shapes and grasps, by Gaussian noise on a band of coefficients.

mod figure;
mod findings;
mod measurement;

use std::ops::Range;

use serde_json::json;

pub use findings::{DrawnBand, Noise, Settings};
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
    let settings = Settings::of(run);
    let ours = measure(run, &settings, &set)?;
    let inclusive = |band: Range<usize>| (band.start, band.end - 1);
    Ok(Results {
        objects: set.describe(),
        paper: json!({
            "coarse_positions": inclusive(paper::COARSE_BAND),
            "fine_positions": inclusive(paper::FINE_BAND),
            "sigma_m": null,
            "contacts": paper::CONTACTS,
            "finding": "the first coefficients are large-scale properties, the later ones higher frequencies",
        }),
        table: figure::table(&ours),
        ours: json!({ "noise": ours }),
        figures: figure::figures(&measurement::drawn_bands(run, &settings, &set)),
    })
}
