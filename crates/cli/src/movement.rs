//! The common part of `ascend` and `transfer`: moving the grasps, the files and the table.

use std::path::PathBuf;
use std::time::Instant;

use moduli::Measure;
use moduli::records::convention_record;
use rayon::prelude::*;
use record::grasps::ConventionRecord;
use serde::Serialize;

use crate::args::{Common, MoveOptions};
use crate::failure::Failure;
use crate::moved::{self, Given, Moved, TraceStep};
use crate::{files, output};

/// Version of the layout of traces.
const TRACE_VERSION: u32 = 1;
/// Rows of the table on standard output.
const SHOWN: usize = 20;

/// A method of moving grasps.
pub(crate) struct Movement<'a> {
    /// The text of the progress bar.
    pub(crate) doing: &'static str,
    /// Its name in results.
    pub(crate) scheme: &'static str,
    /// Quality on the target object.
    pub(crate) measure: &'a Measure<'a>,
    /// Warnings about the grasps, for the result.
    pub(crate) warnings: Vec<String>,
    /// When the work began.
    pub(crate) start: Instant,
}

/// Moves grasps in parallel. Of several failures the one of the first grasp is returned, so that
/// the result does not depend on the threads.
pub(crate) fn move_all(
    grasps: &[Given],
    one: impl Fn(usize, &Given) -> Result<Moved, Failure> + Sync,
) -> Result<Vec<Moved>, Failure> {
    let ends: Vec<Result<Moved, Failure>> = grasps
        .par_iter()
        .enumerate()
        .map(|(i, placed)| one(i, placed))
        .collect();
    ends.into_iter().collect()
}

impl Movement<'_> {
    /// Moves all grasps in parallel, writes the files and prints the result. It is an error if no
    /// grasp is closed.
    pub(crate) fn run(
        &self,
        grasps: &[Given],
        options: &MoveOptions,
        common: &Common,
        one: impl Fn(usize, &Given) -> Result<Moved, Failure> + Sync,
    ) -> Result<(), Failure> {
        let results: Vec<&PathBuf> = options.output.iter().chain(&options.trace).collect();
        run::check_results(&results, &files::read_so_far())?;
        let bar = output::progress(common.quiet, grasps.len(), self.doing);
        let moved = move_all(grasps, |i, placed| {
            bar.inc(1);
            one(i, placed)
        })?;
        bar.finish_and_clear();
        if let Some(path) = &options.trace {
            output::write_file(path, &output::encode(&self.trace_file(&moved))?)?;
        }
        self.refuse_open(&moved)?;
        if let Some(path) = &options.output {
            let file = moved::file(self.measure, &moved)?;
            output::write_file(path, &output::encode(&file)?)?;
        }
        self.say(&moved, options, common.json)
    }

    fn refuse_open(&self, moved: &[Moved]) -> Result<(), Failure> {
        if moved.iter().any(|m| m.quality > 0.0) {
            return Ok(());
        }
        let reason = moved.iter().find_map(|m| m.reason.as_deref());
        Err(Failure::refused(format!(
            "{}: none of {} grasps is force-closed: {}; more friction (--friction) or other grasps may help",
            self.measure.object().name(),
            moved.len(),
            reason.unwrap_or("no closed grasp was found")
        )))
    }

    fn trace_file<'a>(&'a self, moved: &'a [Moved]) -> TraceFile<'a> {
        TraceFile {
            version: TRACE_VERSION,
            object: self.measure.object().name(),
            scheme: self.scheme,
            convention: convention_record(self.measure.convention()),
            grasps: moved
                .iter()
                .map(|m| GraspTrace {
                    start_quality: m.start_quality,
                    quality: m.quality,
                    stationarity: m.stationarity,
                    evaluations: m.evaluations,
                    open: m.reason.as_deref(),
                    steps: &m.steps,
                })
                .collect(),
        }
    }

    fn say(&self, moved: &[Moved], options: &MoveOptions, json: bool) -> Result<(), Failure> {
        let count = moved.len() as f64;
        let path = |p: &Option<PathBuf>| p.as_ref().map(|p| p.display().to_string());
        let line = Summary {
            object: self.measure.object().name(),
            scheme: self.scheme,
            convention: &self.measure.convention().name,
            grasps: moved.len(),
            improved: moved.iter().filter(|m| m.quality > m.start_quality).count(),
            below_start: moved.iter().filter(|m| m.quality < m.start_quality).count(),
            unstable: moved
                .iter()
                .filter(|m| !self.measure.convention().is_stable(m.quality))
                .count(),
            mean_start: moved.iter().map(|m| m.start_quality).sum::<f64>() / count,
            mean_final: moved.iter().map(|m| m.quality).sum::<f64>() / count,
            best: moved.iter().map(|m| m.quality).fold(0.0, f64::max),
            evaluations: moved.iter().map(|m| m.evaluations).sum(),
            seconds: self.start.elapsed().as_secs_f64(),
            output: path(&options.output),
            trace: path(&options.trace),
            warnings: &self.warnings,
        };
        if json {
            return output::say_json(&line);
        }
        for (i, m) in moved.iter().enumerate().take(SHOWN) {
            let reason = m.reason.as_deref().unwrap_or("");
            output::say(format!(
                "{i:5}  {:9.5} → {:9.5}  {reason}",
                m.start_quality, m.quality
            ));
        }
        line.say();
        Ok(())
    }
}

impl Summary<'_> {
    fn say(&self) {
        output::say(format!(
            "{} grasps on {}: mean {:.4} → {:.4}, best {:.4}, {} improved, {} not stable under `{}`; {} qualities, {:.2} s",
            self.grasps,
            self.object,
            self.mean_start,
            self.mean_final,
            self.best,
            self.improved,
            self.unstable,
            self.convention,
            self.evaluations,
            self.seconds
        ));
    }
}

#[derive(Serialize)]
struct TraceFile<'a> {
    version: u32,
    object: &'a str,
    scheme: &'a str,
    convention: ConventionRecord,
    grasps: Vec<GraspTrace<'a>>,
}

/// One grasp, in the order in which it was given.
#[derive(Serialize)]
struct GraspTrace<'a> {
    start_quality: f64,
    quality: f64,
    stationarity: Option<f64>,
    evaluations: usize,
    open: Option<&'a str>,
    steps: &'a [TraceStep],
}

#[derive(Serialize)]
struct Summary<'a> {
    object: &'a str,
    scheme: &'a str,
    convention: &'a str,
    grasps: usize,
    improved: usize,
    below_start: usize,
    unstable: usize,
    mean_start: f64,
    mean_final: f64,
    best: f64,
    evaluations: usize,
    seconds: f64,
    output: Option<String>,
    trace: Option<String>,
    warnings: &'a [String],
}
