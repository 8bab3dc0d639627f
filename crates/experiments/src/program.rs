//! The common main function of all experiments' programs.

use std::io::Write;
use std::process::ExitCode;
use std::time::Instant;

use moduli::records::convention_record;
use report::{Page, Section};
use run::WriteError;
use serde_json::{Value, json};

use crate::args::Args;
use crate::error::ExperimentError;
use crate::ledger;
use crate::output::{Results, write};
use crate::run::{Run, fit_settings};
use crate::table::Table;

/// A section of the paper as a function.
pub type Experiment = fn(&Run) -> Result<Results, ExperimentError>;

/// Reads the command line, runs the section on its own thread pool, writes `OUT/<name>.json` and
/// prints the table. Exit codes: 0 success, 2 usage, 3 bad input, 4 numerical refusal, 1 other
/// errors.
pub fn main(name: &'static str, about: &'static str, section: Experiment) -> ExitCode {
    let args = match Args::read(name, about, std::env::args_os()) {
        Ok(args) => args,
        Err(error) => error.exit(),
    };
    match execute(name, about, &args, section) {
        Ok(text) => {
            // A closed pipe is not a failure of the experiment.
            let _ = writeln!(std::io::stdout(), "{text}");
            ExitCode::SUCCESS
        }
        Err(error) => fail(name, &error),
    }
}

/// Prints the error to stderr and returns its exit code.
pub fn fail(name: &str, error: &ExperimentError) -> ExitCode {
    let _ = writeln!(std::io::stderr(), "{name}: {error}");
    ExitCode::from(error.exit_code())
}

/// Runs a section with the given arguments and writes its JSON and its page. Returns the table as
/// text.
pub fn execute(
    name: &str,
    about: &str,
    args: &Args,
    section: Experiment,
) -> Result<String, ExperimentError> {
    let start = Instant::now();
    let progress = |what: &str| {
        if !args.quiet {
            let seconds = start.elapsed().as_secs_f64();
            let _ = writeln!(std::io::stderr(), "{name} {seconds:7.1} s: {what}");
        }
    };
    let unfinished = ledger::folder(&args.out, name);
    let run = Run {
        objects: args.objects.clone(),
        only: &args.only,
        scale: args.scale,
        seed: args.seed,
        convention: args.convention.clone(),
        fit: fit_settings(args.degree, args.lambda),
        keep: Some(&unfinished),
        progress: &progress,
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.unwrap_or(0))
        .build()?;
    let results = pool.install(|| section(&run))?;
    let seconds = start.elapsed().as_secs_f64();
    let refused = refusals(&results.objects);
    let table = results.table.to_string();
    let value = json!({
        "experiment": name,
        "scale": args.scale,
        "seed": args.seed,
        "threads": pool.current_num_threads(),
        "objects": results.objects,
        "convention": convention_record(&args.convention),
        "paper": results.paper,
        "ours": results.ours,
        "seconds": seconds,
    });
    let page = page(name, about, args, results.table, results.figures).to_html()?;
    write(&args.out, &format!("{name}.html"), page.as_bytes())?;
    let bytes = serde_json::to_vec_pretty(&value)?;
    let path = write(&args.out, &format!("{name}.json"), &bytes)?;
    if unfinished.exists() {
        std::fs::remove_dir_all(&unfinished).map_err(|source| WriteError::Io {
            path: unfinished,
            source,
        })?;
    }
    Ok(format!(
        "{table}{refused}{seconds:.1} s, {}",
        path.display()
    ))
}

/// One line for every object that was refused.
fn refusals(objects: &Value) -> String {
    let refused = objects["refused"].as_array().into_iter().flatten();
    let word = |of: &Value, key: &str| of[key].as_str().unwrap_or_default().to_owned();
    refused
        .map(|r| format!("refused {}: {}\n", word(r, "id"), word(r, "reason")))
        .collect()
}

/// The page with the table and the figures.
fn page(name: &str, about: &str, args: &Args, table: Table, figures: Vec<Section>) -> Page {
    let mut sections = vec![table.section()];
    sections.extend(figures);
    Page {
        title: name.to_owned(),
        intro: format!(
            "{about}.\n\nScale {}, seed {}, objects {}, convention {}.",
            args.scale.name(),
            args.seed,
            args.objects,
            args.convention.name
        ),
        sections,
    }
}
