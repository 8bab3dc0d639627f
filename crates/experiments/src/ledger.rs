//! The jobs of a long experiment, resumed after an interruption.
//!
//! Completed jobs are stored in one [`run::Ledger`] per phase, in a hidden folder beside the
//! results.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Instant;

use moduli::records::convention_record;
use run::{Key, Ledger};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::json;
use space::transfer::{Progress, run_jobs};
use sph::Direction;

use crate::error::ExperimentError;
use crate::pipeline::FittedSet;
use crate::run::Run;

/// The folder that holds the completed jobs of an experiment until its result is written.
pub fn folder(out: &Path, experiment: &str) -> PathBuf {
    out.join(format!(".{experiment}.unfinished"))
}

/// Time of both schemes, summed over threads, seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThreadSeconds {
    /// Time of the paper's scheme.
    pub paper: f64,
    /// Time of our scheme.
    pub ours: f64,
}

/// Results of all jobs of a phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept<R> {
    /// Results in order of the jobs.
    pub results: Vec<R>,
    /// Time of the jobs, summed over threads and over interruptions.
    pub thread_seconds: f64,
}

#[derive(Serialize, Deserialize)]
struct Timed<R> {
    seconds: f64,
    result: R,
}

/// Runs jobs on the thread pool and stores every result, in order of the jobs.
///
/// `name` identifies the phase of an experiment, and `key` is the digest of what the results depend
/// on. If `run` has no folder, nothing is stored.
///
/// # Errors
/// The first error of a job, or of the ledger.
pub fn run_kept<J, R>(
    run: &Run,
    name: &str,
    key: &Key,
    jobs: &[J],
    one: impl Fn(&J) -> Result<R, ExperimentError> + Sync,
) -> Result<Kept<R>, ExperimentError>
where
    J: Sync,
    R: Serialize + DeserializeOwned + Send,
{
    let (ledger, mut results) = match run.keep {
        Some(folder) => {
            let path = folder.join(format!("{}.jsonl", name.replace(' ', "_")));
            let (ledger, kept) = Ledger::open::<Timed<R>>(&path, key, jobs.len())?;
            (Some(ledger), kept)
        }
        None => (None, Vec::new()),
    };
    let kept = results.iter().flatten().count();
    if kept > 0 {
        run.say(&format!(
            "{kept} of {} {name} are already computed",
            jobs.len()
        ));
    }
    let failure = Mutex::new(None);
    let progress = |now: &Progress, result: &Timed<R>| {
        if now.done.is_multiple_of((now.total / 10).max(1)) {
            run.say(&format!("{} of {} {name}", now.done, now.total));
        }
        match ledger.as_ref().map(|l| l.append(now.job, result)) {
            Some(Err(error)) => {
                failure
                    .lock()
                    .unwrap_or_else(|e| e.into_inner())
                    .replace(error);
                ControlFlow::Break(())
            }
            _ => ControlFlow::Continue(()),
        }
    };
    let timed = |job: &J| {
        let began = Instant::now();
        let result = one(job)?;
        let seconds = began.elapsed().as_secs_f64();
        Ok::<_, ExperimentError>(Timed { seconds, result })
    };
    // The run is only cancelled after an error.
    let _ = run_jobs(jobs, &mut results, timed, progress)?;
    match failure.into_inner().unwrap_or_else(|e| e.into_inner()) {
        Some(error) => Err(error.into()),
        None => Ok(Kept {
            thread_seconds: results.iter().flatten().map(|t| t.seconds).sum(),
            results: results.into_iter().flatten().map(|t| t.result).collect(),
        }),
    }
}

/// Digest of what the results of a run depend on: the program, the surfaces, the initial grasps,
/// the seed, the convention and the settings of the section, whose `Debug` text contains all
/// numbers.
///
/// # Errors
/// The file of the running program cannot be read.
pub fn key(
    run: &Run,
    set: &FittedSet,
    starts: &[Vec<Vec<Direction>>],
    section: &impl std::fmt::Debug,
) -> Result<Key, ExperimentError> {
    let mut surfaces = Vec::new();
    for object in &set.objects {
        surfaces.extend_from_slice(object.id().as_bytes());
        surfaces.push(0);
        let beta = object.shape().coefficients().as_slice();
        surfaces.extend(beta.iter().flat_map(|x| x.to_bits().to_le_bytes()));
    }
    let starts = starts.iter().flatten().flatten().flat_map(|d| d.iter());
    let starts: Vec<u8> = starts.flat_map(|x| x.to_bits().to_le_bytes()).collect();
    let settings = json!({
        "seed": run.seed,
        "convention": convention_record(&run.convention),
        "section": format!("{section:?}"),
    });
    Key::new(&[
        ("surfaces", &surfaces),
        ("starts", &starts),
        ("settings", settings.to_string().as_bytes()),
    ])
    .map_err(ExperimentError::Program)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Scale;
    use grasp::Convention;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn run_in(folder: &Path) -> Run<'_> {
        let convention = Convention::named("paper").unwrap();
        Run {
            keep: Some(folder),
            ..Run::builtin(Scale::Small, 1, convention, &|_| {})
        }
    }

    /// Squares of the jobs; counts calls and fails at one of them.
    fn squares(
        folder: &Path,
        key: &str,
        fail_at: Option<u64>,
    ) -> (Result<Vec<f64>, ExperimentError>, usize) {
        let calls = AtomicUsize::new(0);
        let jobs: Vec<u64> = (0..50).collect();
        let key = Key::new(&[("key", key.as_bytes())]).unwrap();
        let found = run_kept(&run_in(folder), "all squares", &key, &jobs, |job| {
            calls.fetch_add(1, Ordering::Relaxed);
            if Some(*job) == fail_at {
                return Err(ExperimentError::NoGrasps { poses: 0 });
            }
            Ok((*job as f64 / 3.0).powi(2))
        });
        (found.map(|kept| kept.results), calls.into_inner())
    }

    fn expected() -> Vec<f64> {
        (0..50).map(|j| (f64::from(j) / 3.0).powi(2)).collect()
    }

    #[test]
    fn an_interrupted_run_goes_on_and_gives_the_same_bits() {
        let out = tempfile::tempdir().unwrap();
        assert!(squares(out.path(), "a", Some(40)).0.is_err());
        let path = out.path().join("all_squares.jsonl");
        let kept = std::fs::read_to_string(path).unwrap().lines().count() - 1;
        let (found, calls) = squares(out.path(), "a", None);
        assert_eq!(found.unwrap(), expected());
        assert_eq!(calls, 50 - kept);
        let (again, calls) = squares(out.path(), "a", None);
        assert_eq!((again.unwrap(), calls), (expected(), 0));
        assert_eq!(squares(out.path(), "b", None).1, 50);
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let out = tempfile::tempdir().unwrap();
        let file = out.path().join("file");
        std::fs::write(&file, "").unwrap();
        let error = squares(&file, "a", None).0.unwrap_err();
        assert!(error.to_string().contains("file"), "{error}");
        assert_eq!(error.exit_code(), 1);
    }
}
