//! Many transfers: every grasp of every object to every other object.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

/// One grasp to transfer from one object to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Job {
    /// Index of the source.
    pub from: usize,
    /// Index of the target.
    pub to: usize,
    /// Index of the grasp on the source.
    pub grasp: usize,
}

/// All pairs of different objects with all grasps of the first, in order of pairs.
pub fn all_pairs(grasps: &[usize]) -> Vec<Job> {
    let objects = grasps.len();
    let mut jobs = Vec::new();
    for (from, &count) in grasps.iter().enumerate() {
        for to in (0..objects).filter(|to| *to != from) {
            jobs.extend((0..count).map(|grasp| Job { from, to, grasp }));
        }
    }
    jobs
}

/// Progress of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Index of the job that was just completed.
    pub job: usize,
    /// Number of completed jobs, including those of earlier runs.
    pub done: usize,
    /// Number of jobs.
    pub total: usize,
}

/// Runs the jobs that have no result yet on the caller's thread pool, and stores each result at its
/// job's index.
///
/// `results` is the state that an earlier run left; it may be empty, shorter than `jobs`, or have
/// gaps. After every job `progress` receives its result and may return `Break`, which cancels the
/// run. After a cancellation or an error, completed results stay in `results` and the next call
/// continues from there. Results do not depend on the number of threads or on interruptions.
///
/// # Errors
/// The error of the failed job with the lowest index. No job starts after a failure.
pub fn run_jobs<J: Sync, R: Send, E: Send>(
    jobs: &[J],
    results: &mut Vec<Option<R>>,
    one: impl Fn(&J) -> Result<R, E> + Sync,
    progress: impl Fn(&Progress, &R) -> ControlFlow<()> + Sync,
) -> Result<ControlFlow<()>, E> {
    results.truncate(jobs.len());
    results.resize_with(jobs.len(), || None);
    let done = AtomicUsize::new(results.iter().flatten().count());
    let stop = AtomicBool::new(false);
    let errors: Vec<E> = jobs
        .par_iter()
        .zip(results.par_iter_mut())
        .enumerate()
        .filter(|(_, (_, slot))| slot.is_none())
        .filter_map(|(index, (job, slot))| {
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            match one(job) {
                Ok(result) => {
                    let now = Progress {
                        job: index,
                        done: 1 + done.fetch_add(1, Ordering::Relaxed),
                        total: jobs.len(),
                    };
                    if progress(&now, slot.insert(result)).is_break() {
                        stop.store(true, Ordering::Relaxed);
                    }
                    None
                }
                Err(error) => {
                    stop.store(true, Ordering::Relaxed);
                    Some(error)
                }
            }
        })
        .collect();
    match errors.into_iter().next() {
        Some(error) => Err(error),
        None if stop.into_inner() => Ok(ControlFlow::Break(())),
        None => Ok(ControlFlow::Continue(())),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn pairs_are_all_but_the_diagonal() {
        let jobs = all_pairs(&[2, 1, 0]);
        let short: Vec<_> = jobs.iter().map(|j| (j.from, j.to, j.grasp)).collect();
        assert_eq!(
            short,
            [
                (0, 1, 0),
                (0, 1, 1),
                (0, 2, 0),
                (0, 2, 1),
                (1, 0, 0),
                (1, 2, 0)
            ]
        );
        assert_eq!(all_pairs(&[10; 12]).len(), 1320);
    }

    #[test]
    fn a_run_stops_when_told_and_goes_on_where_it_was() {
        let jobs: Vec<usize> = (0..200).collect();
        let mut results = vec![None, Some(10)];
        let calls = Mutex::new(Vec::new());
        let ten_times = |j: &usize| {
            calls.lock().unwrap().push(*j);
            Ok::<usize, String>(10 * j)
        };
        let stopped = run_jobs(&jobs, &mut results, ten_times, |now, _| {
            if now.done >= 20 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert_eq!(stopped, Ok(ControlFlow::Break(())));
        let done = results.iter().flatten().count();
        assert!((20..200).contains(&done), "{done}");
        let rest = run_jobs(&jobs, &mut results, ten_times, |now, result| {
            assert_eq!((now.total, *result), (200, 10 * now.job));
            ControlFlow::Continue(())
        });
        assert_eq!(rest, Ok(ControlFlow::Continue(())));
        let all: Vec<_> = (0..200).map(|j| Some(10 * j)).collect();
        assert_eq!(results, all);
        let mut calls = calls.into_inner().unwrap();
        calls.sort_unstable();
        let once: Vec<usize> = (0..200).filter(|j| *j != 1).collect();
        assert_eq!(
            calls, once,
            "every open job is done once, those given are not"
        );
    }

    #[test]
    fn an_error_keeps_what_was_done() {
        let mut results = vec![Some(7)];
        let failed = run_jobs(
            &[1, 2, 3],
            &mut results,
            |j| Err(j.to_string()),
            |_, _| ControlFlow::Continue(()),
        );
        assert!(failed == Err("2".to_owned()) || failed == Err("3".to_owned()));
        assert_eq!(results, [Some(7), None, None]);
    }
}
