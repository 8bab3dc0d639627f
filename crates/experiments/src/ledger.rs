//! Long computations that go on where they were interrupted.
//!
//! Every finished job is a line of JSON in a file beside the results. A run that finds such a file
//! with the same first line (everything that the results depend on) takes what is there and does
//! the rest; a line that was cut off is done again.

use std::collections::hash_map::DefaultHasher;
use std::fs::{File, OpenOptions};
use std::hash::{Hash, Hasher};
use std::io::{Read, Seek, SeekFrom, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Instant;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use space::transfer::{Progress, run_jobs};
use sph::Direction;

use crate::error::ExperimentError;
use crate::pipeline::FittedSet;
use crate::run::Run;

/// Where the lines of an experiment are until its result is written.
pub fn folder(out: &Path, experiment: &str) -> PathBuf {
    out.join(format!(".{experiment}.unfinished"))
}

/// Time that both schemes took, summed over threads, seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThreadSeconds {
    /// The paper's.
    pub paper: f64,
    /// Ours.
    pub ours: f64,
}

/// Results of all jobs of a phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept<R> {
    /// In order of the jobs.
    pub results: Vec<R>,
    /// Time that the jobs took, summed over threads and over interruptions.
    pub thread_seconds: f64,
}

#[derive(Serialize, Deserialize)]
struct Line<T> {
    job: usize,
    timed: T,
}

#[derive(Serialize, Deserialize)]
struct Timed<R> {
    seconds: f64,
    result: R,
}

/// Does jobs over the threads of the pool and keeps every result, in order of the jobs.
///
/// `name` tells the phases of an experiment apart and `key` is what the results depend on. Without
/// a folder in `run` nothing is kept.
pub fn run_kept<J, R>(
    run: &Run,
    name: &str,
    key: &Value,
    jobs: &[J],
    one: impl Fn(&J) -> Result<R, ExperimentError> + Sync,
) -> Result<Kept<R>, ExperimentError>
where
    J: Sync,
    R: Serialize + DeserializeOwned + Send,
{
    let mut results: Vec<Option<Timed<R>>> = Vec::new();
    let ledger = match run.keep {
        Some(folder) => Some(Ledger::open(folder, name, key, jobs.len(), &mut results)?),
        None => None,
    };
    let kept = results.iter().flatten().count();
    if kept > 0 {
        run.say(&format!(
            "{kept} of {} {name} are there already",
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
    // Breaks come with a failure.
    let _ = run_jobs(jobs, &mut results, timed, progress)?;
    match failure.into_inner().unwrap_or_else(|e| e.into_inner()) {
        Some(error) => Err(error),
        None => Ok(Kept {
            thread_seconds: results.iter().flatten().map(|t| t.seconds).sum(),
            results: results.into_iter().flatten().map(|t| t.result).collect(),
        }),
    }
}

/// What makes the results of two runs comparable: objects, surfaces, seed and convention.
pub fn key(run: &Run, set: &FittedSet, starts: &[Vec<Vec<Direction>>], plan: Value) -> Value {
    let mut bits = DefaultHasher::new();
    for object in &set.objects {
        object.id().hash(&mut bits);
        for value in object.shape().coefficients().as_slice() {
            value.to_bits().hash(&mut bits);
        }
    }
    for x in starts.iter().flatten().flatten().flat_map(|d| d.iter()) {
        x.to_bits().hash(&mut bits);
    }
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "seed": run.seed,
        "convention": format!("{:?}", run.convention),
        "objects_and_grasps": bits.finish(),
        "plan": plan,
    })
}

/// The file of one phase.
struct Ledger {
    path: PathBuf,
    file: Mutex<File>,
}

impl Ledger {
    /// Reads what is there into `results`, or begins anew where the key is another.
    fn open<R: DeserializeOwned>(
        folder: &Path,
        name: &str,
        key: &Value,
        jobs: usize,
        results: &mut Vec<Option<R>>,
    ) -> Result<Self, ExperimentError> {
        let path = folder.join(format!("{}.jsonl", name.replace(' ', "_")));
        let failed = |reason| ExperimentError::Output {
            path: path.clone(),
            reason,
        };
        std::fs::create_dir_all(folder).map_err(failed)?;
        let mut file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .read(true)
            .write(true)
            .open(&path)
            .map_err(failed)?;
        let mut text = Vec::new();
        file.read_to_end(&mut text).map_err(failed)?;
        let whole = whole_lines(&text, key, jobs, results);
        // What follows the last whole line was cut off when the run before ended.
        file.set_len(whole as u64).map_err(failed)?;
        let ledger = Self {
            path: path.clone(),
            file: Mutex::new(file),
        };
        if whole == 0 {
            ledger.write(key.to_string())?;
        } else {
            let mut file = ledger.file.lock().unwrap_or_else(|e| e.into_inner());
            file.seek(SeekFrom::End(0)).map_err(failed)?;
        }
        Ok(ledger)
    }

    fn append<R: Serialize>(&self, job: usize, timed: R) -> Result<(), ExperimentError> {
        self.write(serde_json::to_string(&Line { job, timed })?)
    }

    fn write(&self, mut line: String) -> Result<(), ExperimentError> {
        line.push('\n');
        let mut file = self.file.lock().unwrap_or_else(|e| e.into_inner());
        file.write_all(line.as_bytes())
            .map_err(|reason| ExperimentError::Output {
                path: self.path.clone(),
                reason,
            })
    }
}

/// Reads results; the number of bytes that are worth keeping.
fn whole_lines<R: DeserializeOwned>(
    text: &[u8],
    key: &Value,
    jobs: usize,
    results: &mut Vec<Option<R>>,
) -> usize {
    results.clear();
    results.resize_with(jobs, || None);
    let mut lines = text.split_inclusive(|b| *b == b'\n');
    let first = lines.next().unwrap_or_default();
    let same = serde_json::from_slice::<Value>(first).is_ok_and(|found| found == *key);
    if !same || !first.ends_with(b"\n") {
        return 0;
    }
    let mut whole = first.len();
    for line in lines {
        let Ok(Line { job, timed }) = serde_json::from_slice(line) else {
            break;
        };
        let (Some(slot), true) = (results.get_mut(job), line.ends_with(b"\n")) else {
            break;
        };
        *slot = Some(timed);
        whole += line.len();
    }
    whole
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
        key: u64,
        fail_at: Option<u64>,
    ) -> (Result<Vec<f64>, ExperimentError>, usize) {
        let calls = AtomicUsize::new(0);
        let jobs: Vec<u64> = (0..50).collect();
        let found = run_kept(&run_in(folder), "squares", &json!(key), &jobs, |job| {
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
        assert!(squares(out.path(), 1, Some(40)).0.is_err());
        let path = out.path().join("squares.jsonl");
        let kept = std::fs::read_to_string(&path).unwrap().lines().count() - 1;
        // The run ended in the middle of a line.
        let mut text = std::fs::read(&path).unwrap();
        text.extend_from_slice(b"{\"job\":49,\"tim");
        std::fs::write(&path, text).unwrap();
        let (found, calls) = squares(out.path(), 1, None);
        assert_eq!(found.unwrap(), expected());
        assert_eq!(calls, 50 - kept);
        let (again, calls) = squares(out.path(), 1, None);
        assert_eq!((again.unwrap(), calls), (expected(), 0));
    }

    #[test]
    fn another_key_begins_anew() {
        let out = tempfile::tempdir().unwrap();
        squares(out.path(), 1, None).0.unwrap();
        let (found, calls) = squares(out.path(), 2, None);
        assert_eq!((found.unwrap(), calls), (expected(), 50));
        std::fs::write(out.path().join("squares.jsonl"), "not of ours").unwrap();
        assert_eq!(squares(out.path(), 2, None).1, 50);
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_refused_by_name() {
        let out = tempfile::tempdir().unwrap();
        let file = out.path().join("file");
        std::fs::write(&file, "").unwrap();
        let error = squares(&file, 1, None).0.unwrap_err();
        assert!(error.to_string().contains("file"), "{error}");
    }
}
