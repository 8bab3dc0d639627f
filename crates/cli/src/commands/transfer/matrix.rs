//! Grasps of many objects, each carried to many others, a file for each pair of objects.
//!
//! Each finished pair has a file; an interrupted run computes the remaining pairs.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use grasp::Convention;
use moduli::Object;
use rayon::prelude::*;
use record::GraspsFile;
use run::ledger::{is_sealed, seal};
use run::{Digest, Key};
use serde::Serialize;
use serde_json::json;
use space::transfer::run_jobs;

use super::{Origin, between, carry, crossings, failed, prepare, scheme_name};
use crate::args::{Common, TransferOptions};
use crate::failure::Failure;
use crate::moved::{self, Given, given};
use crate::movement::move_all;
use crate::output::warn;
use crate::{files, input, output};

/// A table of all pairs, written when all are done.
const TABLE: &str = "transfers.json";
/// The key of a pair's file under which the transfer is described.
const MADE_BY: &str = "transfer";

/// A shape file, its stem and the digest of its bytes.
struct Side {
    stem: String,
    object: Object,
    digest: Digest,
}

struct Source {
    side: Side,
    path: PathBuf,
    grasps: Vec<Given>,
    warnings: Vec<String>,
    digest: Digest,
}

/// One pair of objects and where its grasps go.
struct Pair<'a> {
    from: &'a Source,
    to: &'a Side,
    /// How quality is measured.
    rule: &'a Convention,
    file: PathBuf,
    /// Digest of everything on which the result depends.
    key: Key,
}

/// The content of a pair's file.
#[derive(Clone, Serialize)]
struct PairLine {
    from: String,
    to: String,
    file: String,
    grasps: usize,
    unstable: usize,
    mean_start: f64,
    mean_final: f64,
    best: f64,
}

/// Transfers all pairs, and resumes an earlier run into the same folder.
pub(super) fn run(options: &TransferOptions, common: &Common) -> Result<(), Failure> {
    let start = Instant::now();
    let Some(folder) = &options.moved.output else {
        return Err(Failure::usage(
            "several shapes need a folder for the results; add -o DIR",
        ));
    };
    if options.moved.trace.is_some() {
        return Err(Failure::usage("--trace works for one pair of shapes only"));
    }
    let convention = input::convention(&options.moved.convention)?;
    let sources = sources(options)?;
    let targets = distinct(&options.to)?;
    let pairs = pairs(&sources, &targets, folder, options, &convention)?;
    if pairs.is_empty() {
        return Err(Failure::usage(
            "--from and --to name the same single shape; expected two different ones",
        ));
    }
    let table = folder.join(TABLE);
    let results: Vec<&PathBuf> = pairs
        .iter()
        .map(|pair| &pair.file)
        .chain([&table])
        .collect();
    run::check_results(&results, &files::read_so_far())?;
    let mut lines: Vec<Option<PairLine>> = pairs.iter().map(|pair| pair.done()).collect();
    let kept = lines.iter().flatten().count();
    let bar = output::progress(common.quiet, pairs.len(), "transferring pairs");
    bar.set_position(kept as u64);
    let one = |pair: &Pair| pair.transfer(options);
    let ended = run_jobs(&pairs, &mut lines, one, |_, _| {
        bar.inc(1);
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    ended.map(|_| ())?;
    let lines: Vec<PairLine> = lines.into_iter().flatten().collect();
    output::write_file(&table, &output::encode(&lines)?)?;
    let warnings: Vec<&String> = sources.iter().flat_map(|s| &s.warnings).collect();
    if common.json {
        say_json(&lines, kept, folder, start, &warnings)?;
    } else {
        say(&lines, kept, folder, start);
    }
    refuse_unstable(&lines)
}

fn sources(options: &TransferOptions) -> Result<Vec<Source>, Failure> {
    if options.from.len() != options.grasps.len() {
        return Err(Failure::usage(format!(
            "shapes given with --from: {}, files of grasps: {}; expected one file per shape, in the same order",
            options.from.len(),
            options.grasps.len()
        )));
    }
    let sides = distinct(&options.from)?;
    let read = |(side, path): (Side, &PathBuf)| {
        let (grasps, warnings) = given(&side.object, path)?;
        Ok(Source {
            grasps,
            warnings,
            digest: Digest::of(&input::read(path)?),
            path: path.clone(),
            side,
        })
    };
    sides.into_iter().zip(&options.grasps).map(read).collect()
}

/// Shapes by their stems, which name the files of results.
fn distinct(paths: &[PathBuf]) -> Result<Vec<Side>, Failure> {
    let mut stems = BTreeSet::new();
    for path in paths {
        if !stems.insert(input::stem(path)) {
            return Err(Failure::usage(format!(
                "two shapes are named {}; their results would have one name",
                input::stem(path)
            )));
        }
    }
    let read = |path: &PathBuf| {
        Ok(Side {
            stem: input::stem(path),
            object: input::object(path)?,
            digest: Digest::of(&input::read(path)?),
        })
    };
    paths.par_iter().map(read).collect()
}

/// All pairs of different shapes.
fn pairs<'a>(
    sources: &'a [Source],
    targets: &'a [Side],
    folder: &Path,
    options: &TransferOptions,
    convention: &'a Convention,
) -> Result<Vec<Pair<'a>>, Failure> {
    let how = format!(
        "{} {} {:?} {convention:?}",
        scheme_name(options),
        options.thorough,
        options.limits
    );
    let all = sources
        .iter()
        .flat_map(|from| targets.iter().map(move |to| (from, to)));
    all.filter(|(from, to)| from.side.digest != to.digest)
        .map(|(from, to)| {
            Ok(Pair {
                from,
                to,
                rule: convention,
                file: folder.join(format!("{}-to-{}.json", from.side.stem, to.stem)),
                key: Key::new(&[
                    ("from", from.side.digest.hex().as_bytes()),
                    ("to", to.digest.hex().as_bytes()),
                    ("grasps", from.digest.hex().as_bytes()),
                    ("how", how.as_bytes()),
                ])
                .map_err(|e| Failure::other(format!("cannot read this program: {e}")))?,
            })
        })
        .collect()
}

impl Pair<'_> {
    /// The result of an earlier run of the same transfer.
    fn done(&self) -> Option<PairLine> {
        let bytes = std::fs::read(&self.file).ok()?;
        let value = serde_json::from_slice(&bytes).ok()?;
        if !is_sealed(&value, MADE_BY, &self.key) {
            return None;
        }
        Some(self.line(&GraspsFile::from_json(&bytes).ok()?))
    }

    fn transfer(&self, options: &TransferOptions) -> Result<PairLine, Failure> {
        let convention = self.rule;
        let (from, to) = (&self.from.side.object, &self.to.object);
        let transfer = between(from, to, convention);
        let measure = to
            .measure(convention)
            .map_err(|e| Failure::usage(e.to_string()))?;
        let scheme = prepare(options, &measure.objective())?;
        let origin = Origin::new(from, to);
        let moved = move_all(&self.from.grasps, |i, placed| {
            carry(options, &scheme, &transfer, to, placed, &origin)
                .map_err(|e| failed(&self.from.path, i, &e))
        })?;
        let mut file = moved::file(&measure, &moved)?;
        let crossings = crossings(&transfer, to).map_err(|e| Failure::other(e.to_string()))?;
        for warning in &crossings {
            warn(format!(
                "{} to {}: {warning}",
                self.from.side.stem, self.to.stem
            ));
        }
        file.object.warnings.extend(crossings);
        let value = self
            .sealed(&file, scheme_name(options))
            .map_err(unencodable)?;
        output::write_file(&self.file, &output::encode(&value)?)?;
        Ok(self.line(&file))
    }

    /// The file with a note on how it was made, by which a later run knows it.
    fn sealed(
        &self,
        file: &GraspsFile,
        scheme: &str,
    ) -> serde_json::Result<serde_json::Map<String, serde_json::Value>> {
        let mut value = serde_json::from_value(serde_json::to_value(file)?)?;
        let made_by = json!({"from": self.from.side.stem, "to": self.to.stem, "scheme": scheme});
        serde_json::Map::insert(&mut value, MADE_BY.to_owned(), made_by);
        seal(&mut value, MADE_BY, &self.key)?;
        Ok(value)
    }

    fn line(&self, file: &GraspsFile) -> PairLine {
        let count = file.grasps.len() as f64;
        let qualities = || file.grasps.iter().map(|g| g.quality);
        let starts = file.grasps.iter().filter_map(|g| g.source.source_quality());
        PairLine {
            from: self.from.side.stem.clone(),
            to: self.to.stem.clone(),
            file: self.file.display().to_string(),
            grasps: file.grasps.len(),
            unstable: qualities().filter(|q| !self.rule.is_stable(*q)).count(),
            mean_start: starts.sum::<f64>() / count,
            mean_final: qualities().sum::<f64>() / count,
            best: qualities().fold(0.0, f64::max),
        }
    }
}

fn unencodable(error: serde_json::Error) -> Failure {
    Failure::other(format!("cannot encode the result as JSON: {error}"))
}

/// The sums over all pairs.
struct Totals {
    grasps: usize,
    unstable: usize,
    mean_start: f64,
    mean_final: f64,
}

impl Totals {
    fn of(lines: &[PairLine]) -> Self {
        let grasps: usize = lines.iter().map(|l| l.grasps).sum();
        let mean = |of: fn(&PairLine) -> f64| {
            lines.iter().map(|l| of(l) * l.grasps as f64).sum::<f64>() / grasps as f64
        };
        Totals {
            grasps,
            unstable: lines.iter().map(|l| l.unstable).sum(),
            mean_start: mean(|l| l.mean_start),
            mean_final: mean(|l| l.mean_final),
        }
    }
}

fn say_json(
    lines: &[PairLine],
    kept: usize,
    folder: &Path,
    start: Instant,
    warnings: &[&String],
) -> Result<(), Failure> {
    let totals = Totals::of(lines);
    output::say_json(&json!({
        "pairs": lines, "kept_pairs": kept, "grasps": totals.grasps, "unstable": totals.unstable,
        "mean_start": totals.mean_start, "mean_final": totals.mean_final,
        "output": folder.display().to_string(), "warnings": warnings,
        "seconds": start.elapsed().as_secs_f64(),
    }))
}

fn say(lines: &[PairLine], kept: usize, folder: &Path, start: Instant) {
    for line in lines {
        output::say(format!(
            "{:24} {:24} {:4} grasps  {:.4} → {:.4}, best {:.4}, {} not stable",
            line.from,
            line.to,
            line.grasps,
            line.mean_start,
            line.mean_final,
            line.best,
            line.unstable
        ));
    }
    let Totals {
        grasps,
        unstable,
        mean_start,
        mean_final,
    } = Totals::of(lines);
    output::say(format!(
        "{} pairs ({kept} done before), {grasps} grasps: mean {mean_start:.4} → {mean_final:.4}, {unstable} not stable; {:.2} s\n{}",
        lines.len(),
        start.elapsed().as_secs_f64(),
        folder.display()
    ));
}

fn refuse_unstable(lines: &[PairLine]) -> Result<(), Failure> {
    let Totals {
        grasps, unstable, ..
    } = Totals::of(lines);
    if unstable == grasps {
        return Err(Failure::refused(format!(
            "none of {grasps} transferred grasps is stable; more friction (--friction) or other grasps may help"
        )));
    }
    Ok(())
}
