//! The paper's transfer and ours between all objects.

use moduli::Grasp;
use space::{Continuation, Transfer};
use sph::Direction;

use super::findings::{Carried, Count, DrawnTransfer, OurCarried, PaperCarried, Settings};
use crate::error::ExperimentError;
use crate::ledger::{self, ThreadSeconds, run_kept};
use crate::paper;
use crate::pipeline::{FittedSet, directions, transfer_between};
use crate::run::Run;
use crate::statistics::{mean, share};

/// Transfers the best hand grasps of every object to every other object, first by the paper's
/// scheme and then by ours.
///
/// # Errors
/// A transfer fails, or completed transfers cannot be stored.
pub fn measure(
    run: &Run,
    settings: &Settings,
    set: &FittedSet,
    grasps: &[Vec<Grasp>],
) -> Result<(Vec<Carried>, ThreadSeconds), ExperimentError> {
    let starts = directions(grasps);
    let key = ledger::key(run, set, &starts, settings)?;
    let count = set.objects.len();
    let pairs: Vec<(usize, usize)> = (0..count)
        .flat_map(|i| (0..count).map(move |j| (i, j)))
        .filter(|(i, j)| i != j)
        .collect();
    let total: usize = pairs.iter().map(|(i, _)| starts[*i].len()).sum();
    run.say(&format!("{total} transfers"));
    let transfer = |i: usize, j: usize| transfer_between(run, &set.objects[i], &set.objects[j]);
    let paper = run_kept(run, "pairs by the paper", &key, &pairs, |&(i, j)| {
        carry_as_the_paper(settings, &transfer(i, j), &starts[i])
    })?;
    let ours = run_kept(run, "pairs by ours", &key, &pairs, |&(i, j)| {
        carry(&transfer(i, j), &starts[i])
    })?;
    let times = ThreadSeconds {
        paper: paper.thread_seconds,
        ours: ours.thread_seconds,
    };
    let mut carried = Vec::with_capacity(total);
    for ((&(i, j), paper), ours) in pairs.iter().zip(paper.results).zip(ours.results) {
        for (rank, (paper, ours)) in paper.into_iter().zip(ours).enumerate() {
            carried.push(Carried {
                from: set.objects[i].id().to_owned(),
                to: set.objects[j].id().to_owned(),
                rank,
                paper,
                ours,
            });
        }
    }
    Ok((carried, times))
}

/// Transfers all grasps of one source to one target by the paper's scheme.
fn carry_as_the_paper(
    settings: &Settings,
    transfer: &Transfer,
    starts: &[Vec<Direction>],
) -> Result<Vec<PaperCarried>, ExperimentError> {
    starts
        .iter()
        .map(|start| {
            let end = settings.transfer.carry(transfer, start)?;
            Ok(PaperCarried {
                initial: end.start_quality,
                last: end.quality,
                naive: transfer.naive(start)?.quality,
                evaluations: end.evaluations,
            })
        })
        .collect()
}

fn carry(
    transfer: &Transfer,
    starts: &[Vec<Direction>],
) -> Result<Vec<OurCarried>, ExperimentError> {
    let scheme = Continuation::default();
    starts
        .iter()
        .map(|start| {
            let end = scheme.carry(transfer, start)?;
            Ok(OurCarried {
                last: end.quality,
                evaluations: end.evaluations,
                stationarity: end.stationarity,
            })
        })
        .collect()
}

/// The transfer for the figure: the best grasp of the first object that has one, to the last
/// object.
pub(super) fn drawn(
    run: &Run,
    settings: &Settings,
    set: &FittedSet,
    grasps: &[Vec<Grasp>],
) -> Result<Option<DrawnTransfer>, ExperimentError> {
    let mut with_grasps = set.objects.iter().zip(grasps);
    let first = with_grasps.find_map(|(o, g)| Some((o, g.first()?)));
    let (Some((from, grasp)), Some(to)) = (first, set.objects.last()) else {
        return Ok(None);
    };
    let transfer = transfer_between(run, from, to);
    let shapes = transfer.stations(settings.transfer.intervals)?;
    let mut ends: Vec<(f64, Vec<Direction>, f64)> = Vec::new();
    let keep = |t: f64, step: &space::Step| {
        let state = (t, step.directions.to_vec(), step.quality);
        match ends.last_mut() {
            Some(last) if last.0 == t => *last = state,
            _ => ends.push(state),
        }
    };
    settings
        .transfer
        .carry_traced(&transfer, grasp.directions(), keep)?;
    let stations = shapes
        .iter()
        .zip(ends)
        .filter_map(|(surface, (_, contacts, quality))| {
            Some((surface.radial()?.shape().clone(), contacts, quality))
        })
        .collect();
    Ok(Some(DrawnTransfer {
        title: format!("{} → {}", from.id(), to.id()),
        stations,
    }))
}

/// Counts by source and in total.
pub(super) fn counts(run: &Run, set: &FittedSet, carried: &[Carried]) -> Vec<Count> {
    let builtin = set.objects.iter().all(|o| o.scan.truth.is_some());
    let mut counts: Vec<Count> = set
        .objects
        .iter()
        .map(|source| {
            let of: Vec<&Carried> = carried.iter().filter(|c| c.from == source.id()).collect();
            let paper = builtin.then(|| paper::unstable_from(source.number()));
            count(run, source.id(), &of, paper)
        })
        .collect();
    let all: Vec<&Carried> = carried.iter().collect();
    counts.push(count(
        run,
        "all",
        &all,
        builtin.then_some(paper::UNSTABLE_TRANSFERS),
    ));
    counts
}

fn count(run: &Run, from: &str, carried: &[&Carried], unstable_in_paper: Option<usize>) -> Count {
    let list = |pick: fn(&Carried) -> f64| carried.iter().map(|c| pick(c)).collect::<Vec<f64>>();
    let unstable = |list: &[f64]| {
        list.iter()
            .filter(|q| !run.convention.is_stable(**q))
            .count()
    };
    let (initial, last) = (list(|c| c.paper.initial), list(|c| c.paper.last));
    let (naive, ours) = (list(|c| c.paper.naive), list(|c| c.ours.last));
    let total = |pick: fn(&Carried) -> usize| carried.iter().map(|c| pick(c)).sum::<usize>();
    Count {
        from: from.to_owned(),
        transfers: carried.len(),
        unstable: unstable(&last),
        unstable_naive: unstable(&naive),
        unstable_in_paper,
        mean_initial: mean(&initial),
        mean_final: mean(&last),
        mean_naive: mean(&naive),
        unstable_ours: unstable(&ours),
        mean_ours: mean(&ours),
        evaluations_ratio: share(
            total(|c| c.paper.evaluations),
            total(|c| c.ours.evaluations),
        ),
    }
}
