//! Fig. 1 and Sec. II-C: eigenfunctions of the Laplacian on the sphere.

mod figure;
mod findings;
mod measurement;

use serde_json::json;

pub use findings::{Eigenfunctions, Settings};
pub use measurement::{measure, paper_formula};

use crate::error::ExperimentError;
use crate::output::Results;
use crate::run::Run;

/// Runs the section: the measurement, then the table and the figures.
///
/// # Errors
/// Too few objects can be used, or a computation fails.
pub fn run(run: &Run) -> Result<Results, ExperimentError> {
    let settings = Settings::of(run);
    run.say(&format!("eigenfunctions up to degree {}", settings.degree));
    let ours = measure(&settings);
    Ok(Results {
        objects: json!({ "source": "none", "fitted": [], "refused": [] }),
        paper: json!({
            "orthonormal": true,
            "eigenvalue_printed": "l(l+1)",
            "eigenvalue_of_its_laplacian": "-l(l+1)",
            "functions_per_degree": "2l+1",
        }),
        ours: serde_json::to_value(&ours)?,
        table: figure::table(&ours),
        figures: figure::figures(&ours)?,
    })
}
