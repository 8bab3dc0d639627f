//! Many transfers: every grasp of every object to every other object.

use std::ops::ControlFlow;

use grasp::Convention;
use nalgebra::Point3;
use shape::RadialField;
use sph::Direction;

use super::{Continuation, Transfer, TransferError, Transferred};

/// One grasp to carry from one object to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Job {
    /// Index of the source.
    pub from: usize,
    /// Index of the target.
    pub to: usize,
    /// Which grasp of the source.
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

/// What a matrix of transfers is made of.
#[derive(Clone, Copy, Debug)]
pub struct Matrix<'a> {
    /// The objects.
    pub surfaces: &'a [RadialField],
    /// The origin of every object's own frame in its centred frame.
    pub origins: &'a [Point3<f64>],
    /// The grasps of every object.
    pub grasps: &'a [Vec<Vec<Direction>>],
    /// How quality is measured.
    pub convention: &'a Convention,
    /// How grasps are carried.
    pub scheme: &'a Continuation,
}

impl Matrix<'_> {
    /// All jobs of the matrix.
    pub fn jobs(&self) -> Vec<Job> {
        all_pairs(&self.grasps.iter().map(Vec::len).collect::<Vec<_>>())
    }

    /// Carries one grasp. Depends on nothing but the job: any thread may do it, in any order.
    ///
    /// Errors: [`TransferError::Job`] when an index is out of range.
    pub fn carry(&self, job: &Job) -> Result<Transferred, TransferError> {
        let outside = || TransferError::Job { job: *job };
        let grasp = self
            .grasps
            .get(job.from)
            .and_then(|grasps| grasps.get(job.grasp))
            .ok_or_else(outside)?;
        let transfer = Transfer {
            from: self.surfaces.get(job.from).ok_or_else(outside)?,
            to: self.surfaces.get(job.to).ok_or_else(outside)?,
            convention: self.convention,
            object_origin: *self.origins.get(job.to).ok_or_else(outside)?,
        };
        let stations = self.scheme.stations(&transfer)?;
        self.scheme.carry(&transfer, &stations, grasp, |_, _| {})
    }
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Index of the job that was just done.
    pub job: usize,
    /// Jobs done, those from before included.
    pub done: usize,
    /// Jobs in all.
    pub total: usize,
}

/// Does the jobs that have no result yet, in order, and puts the results at the jobs' indices.
///
/// `results` is what an earlier run left: shorter, or with gaps, or empty. After every job
/// `progress` sees its result and may break; then, as after an error, what was done stays in
/// `results` and the next call goes on from there. For several threads, split the jobs and the
/// results; see [`Matrix::carry`].
pub fn run_jobs<J, R, E>(
    jobs: &[J],
    results: &mut Vec<Option<R>>,
    mut one: impl FnMut(&J) -> Result<R, E>,
    mut progress: impl FnMut(&Progress, &R) -> ControlFlow<()>,
) -> Result<ControlFlow<()>, E> {
    results.truncate(jobs.len());
    results.resize_with(jobs.len(), || None);
    let mut done = results.iter().flatten().count();
    for (index, (job, slot)) in jobs.iter().zip(results.iter_mut()).enumerate() {
        if slot.is_some() {
            continue;
        }
        let result = slot.insert(one(job)?);
        done += 1;
        let now = Progress {
            job: index,
            done,
            total: jobs.len(),
        };
        if progress(&now, result).is_break() {
            return Ok(ControlFlow::Break(()));
        }
    }
    Ok(ControlFlow::Continue(()))
}

#[cfg(test)]
mod tests {
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
        let jobs = [1, 2, 3, 4, 5];
        let mut results = vec![None, Some(20)];
        let mut calls = Vec::new();
        let ten_times = |calls: &mut Vec<i32>, j: &i32| {
            calls.push(*j);
            Ok::<i32, String>(10 * j)
        };
        let stopped = run_jobs(
            &jobs,
            &mut results,
            |j| ten_times(&mut calls, j),
            |now, _| {
                if now.done == 3 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        assert_eq!(stopped, Ok(ControlFlow::Break(())));
        assert_eq!(results, [Some(10), Some(20), Some(30), None, None]);
        let rest = run_jobs(
            &jobs,
            &mut results,
            |j| ten_times(&mut calls, j),
            |now, _| {
                assert_eq!(now.total, 5);
                ControlFlow::Continue(())
            },
        );
        assert_eq!(rest, Ok(ControlFlow::Continue(())));
        assert_eq!(results, [10, 20, 30, 40, 50].map(Some));
        assert_eq!(calls, [1, 3, 4, 5]);
    }

    #[test]
    fn an_error_keeps_what_was_done() {
        let mut results = Vec::new();
        let failed = run_jobs(
            &[1, 2, 3],
            &mut results,
            |j| if *j == 2 { Err("two") } else { Ok(*j) },
            |_, _| ControlFlow::Continue(()),
        );
        assert_eq!(failed, Err("two"));
        assert_eq!(results, [Some(1), None, None]);
    }
}
