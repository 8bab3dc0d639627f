//! Fig. 9 and Sec. IV-E: grasps carried from every object to every other.

use hand::HandGrasp;
use serde::{Deserialize, Serialize};
use serde_json::json;
use space::{Continuation, PaperTransfer};
use space::{Transfer, TransferEnd};
use sph::Direction;

use crate::error::ExperimentError;
use crate::figures::{self, transfer::DrawnTransfer};
use crate::ledger::{self, ThreadSeconds, run_kept};
use crate::output::Findings;
use crate::paper;
use crate::pipeline::{FittedObject, FittedSet, best_grasps, directions, fitted_objects};
use crate::run::Run;
use crate::sections::gradient_ascent::paper_ascent;
use crate::statistics::{mean, share};
use crate::table::{Table, number};

/// What is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Numbers of the objects; all when absent.
    pub objects: Option<Vec<usize>>,
    /// Hand poses from which Ĝ_i is taken.
    pub poses: usize,
    /// Grasps of Ĝ_i that are carried.
    pub grasps: usize,
    /// The transfer.
    pub transfer: PaperTransfer,
}

impl Plan {
    /// The plan of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            // Two objects from which the paper reports unstable transfers, and a round one.
            objects: run.scale.pick(Some(vec![2, 9, 11]), None),
            poses: run.scale.pick(150, paper::HAND_POSES),
            grasps: run.scale.pick(2, paper::VERY_BEST_GRASPS),
            transfer: PaperTransfer {
                intervals: paper::TRANSFER_STATIONS - 1,
                ascent: paper_ascent(run.scale.pick(40, paper::TRANSFER_STEPS)),
            },
        }
    }
}

/// One grasp carried from one object to another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Carried {
    /// Where it came from.
    pub from: String,
    /// Where it went.
    pub to: String,
    /// Its rank among the grasps of its source, from 0.
    pub rank: usize,
    /// The paper's transfer.
    #[serde(flatten)]
    pub paper: PaperCarried,
    /// Ours.
    pub ours: OurCarried,
}

/// Where the paper's transfer ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PaperCarried {
    /// Q on the source.
    pub initial: f64,
    /// Q on the target.
    pub last: f64,
    /// Q on the target with θ and φ kept.
    pub naive: f64,
    /// Qualities computed.
    pub evaluations: usize,
}

/// Where our transfer ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OurCarried {
    /// Q on the target.
    pub last: f64,
    /// Qualities computed.
    pub evaluations: usize,
    /// Slope of Q left on the target, per radian.
    pub stationarity: Option<f64>,
}

/// Transfers in short.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Count {
    /// The source; "all" for the sum.
    pub from: String,
    /// Transfers.
    pub transfers: usize,
    /// Unstable after the paper's transfer: quality below 0.01 (conventions other than the paper's: open).
    pub unstable: usize,
    /// Unstable after the naive transfer.
    pub unstable_naive: usize,
    /// What the paper counts at full scale; none for objects that it does not have.
    pub unstable_in_paper: Option<usize>,
    /// Mean of Q on the source.
    pub mean_initial: Option<f64>,
    /// Mean of Q on the target.
    pub mean_final: Option<f64>,
    /// Mean of Q on the target, naive.
    pub mean_naive: Option<f64>,
    /// Of quality below 0.01 after our transfer.
    pub unstable_ours: usize,
    /// Mean of Q on the target, ours.
    pub mean_ours: Option<f64>,
    /// Qualities that the paper's transfer computes for one of ours.
    pub evaluations_ratio: Option<f64>,
}

/// Runs the section.
pub fn run(run: &Run) -> Result<Findings, ExperimentError> {
    let plan = Plan::of(run);
    let set = fitted_objects(run, plan.objects.as_deref(), 2)?;
    let grasps = best_grasps(run, &set, plan.poses, plan.grasps)?;
    let (carried, times) = measure(run, &plan, &set, &grasps)?;
    let counts = counts(run, &set, &carried);
    let drawn = drawn(run, &plan, &set, &grasps)?;
    let by_source: Vec<_> = paper::UNSTABLE_BY_SOURCE
        .iter()
        .map(|(source, count)| json!({ "from": format!("S{source}"), "unstable": count }))
        .collect();
    Ok(Findings {
        objects: set.describe(),
        paper: json!({
            "poses": paper::HAND_POSES,
            "grasps_per_source": paper::VERY_BEST_GRASPS,
            "stations": paper::TRANSFER_STATIONS,
            "steps_per_station": paper::TRANSFER_STEPS,
            "transfers": paper::TRANSFERS,
            "transfers_per_source": paper::TRANSFERS_PER_SOURCE,
            "unstable_below": paper::UNSTABLE_BELOW,
            "unstable": paper::UNSTABLE_TRANSFERS,
            "unstable_by_source": by_source,
        }),
        table: table(&plan, &counts, &times),
        ours: json!({
            "poses": plan.poses,
            "grasps_per_source": plan.grasps,
            "stations": plan.transfer.intervals + 1,
            "steps_per_station": plan.transfer.ascent.steps,
            "unstable_below": run.convention.stable_above,
            "counts": counts,
            "thread_seconds": times,
            "transfers": carried,
        }),
        figures: figures::transfer::figures(&carried, &counts, drawn.as_ref()),
    })
}

/// Carries the best hand grasps of every object to every other object: by the paper's scheme, then
/// by ours.
pub fn measure(
    run: &Run,
    plan: &Plan,
    set: &FittedSet,
    grasps: &[Vec<HandGrasp>],
) -> Result<(Vec<Carried>, ThreadSeconds), ExperimentError> {
    let starts = directions(grasps);
    let key = ledger::key(run, set, &starts, plan)?;
    let count = set.objects.len();
    let pairs: Vec<(usize, usize)> = (0..count)
        .flat_map(|i| (0..count).map(move |j| (i, j)))
        .filter(|(i, j)| i != j)
        .collect();
    let total: usize = pairs.iter().map(|(i, _)| starts[*i].len()).sum();
    run.say(&format!("{total} transfers"));
    let transfer = |i: usize, j: usize| transfer_between(run, &set.objects[i], &set.objects[j]);
    let paper = run_kept(run, "pairs by the paper", &key, &pairs, |&(i, j)| {
        carry_as_the_paper(plan, &transfer(i, j), &starts[i])
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

/// What both schemes need, from one object to another.
pub fn transfer_between<'a>(
    run: &'a Run,
    from: &'a FittedObject,
    to: &'a FittedObject,
) -> Transfer<'a> {
    let end = |object: &'a FittedObject| TransferEnd {
        surface: &object.surface,
        object_origin: object.object_origin(),
    };
    Transfer::new(end(from), end(to), &run.convention)
}

/// Carries all grasps of one source to one target, over the same stations.
fn carry_as_the_paper(
    plan: &Plan,
    transfer: &Transfer,
    starts: &[Vec<Direction>],
) -> Result<Vec<PaperCarried>, ExperimentError> {
    starts
        .iter()
        .map(|start| {
            let end = plan.transfer.carry(transfer, start)?;
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

/// The best grasp of the first object that has one on its way to the last object.
fn drawn(
    run: &Run,
    plan: &Plan,
    set: &FittedSet,
    grasps: &[Vec<HandGrasp>],
) -> Result<Option<DrawnTransfer>, ExperimentError> {
    let mut with_grasps = set.objects.iter().zip(grasps);
    let first = with_grasps.find_map(|(o, g)| Some((o, g.first()?)));
    let (Some((from, grasp)), Some(to)) = (first, set.objects.last()) else {
        return Ok(None);
    };
    let transfer = transfer_between(run, from, to);
    let shapes = transfer.stations(plan.transfer.intervals)?;
    let mut ends: Vec<(f64, Vec<Direction>, f64)> = Vec::new();
    let keep = |t: f64, step: &space::Step| {
        let state = (t, step.contacts.to_vec(), step.quality);
        match ends.last_mut() {
            Some(last) if last.0 == t => *last = state,
            _ => ends.push(state),
        }
    };
    plan.transfer
        .carry_traced(&transfer, &grasp.directions, keep)?;
    let stations = shapes
        .iter()
        .zip(ends)
        .map(|(surface, (_, contacts, quality))| (surface.shape().clone(), contacts, quality))
        .collect();
    Ok(Some(DrawnTransfer {
        title: format!("{} → {}", from.id(), to.id()),
        stations,
    }))
}

/// Counts by source, and over all.
fn counts(run: &Run, set: &FittedSet, carried: &[Carried]) -> Vec<Count> {
    let builtin = set.objects.iter().all(|o| o.object.truth.is_some());
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

fn table(plan: &Plan, counts: &[Count], times: &ThreadSeconds) -> Table {
    let mut table = Table::new(
        format!(
            "Sec. IV-E: {} stations of {} steps, the best {} grasps of {} poses (paper: {}, {}, {}, {})",
            plan.transfer.intervals + 1,
            plan.transfer.ascent.steps,
            plan.grasps,
            plan.poses,
            paper::TRANSFER_STATIONS,
            paper::TRANSFER_STEPS,
            paper::VERY_BEST_GRASPS,
            paper::HAND_POSES
        ),
        &[
            "from",
            "transfers",
            "unstable",
            "in the paper",
            "naive unstable",
            "initial",
            "final",
            "naive",
            "ours Q < 0.01",
            "ours",
            "evaluations",
        ],
    );
    for c in counts {
        let of = if c.from == "all" {
            paper::TRANSFERS
        } else {
            paper::TRANSFERS_PER_SOURCE
        };
        let in_paper = c
            .unstable_in_paper
            .map_or("–".to_owned(), |n| format!("{n} of {of}"));
        table.row([
            c.from.clone(),
            c.transfers.to_string(),
            c.unstable.to_string(),
            in_paper,
            c.unstable_naive.to_string(),
            number(c.mean_initial, 3),
            number(c.mean_final, 3),
            number(c.mean_naive, 3),
            c.unstable_ours.to_string(),
            number(c.mean_ours, 3),
            number(c.evaluations_ratio, 1),
        ]);
    }
    table.note(format!(
        "Seconds of all transfers, summed over threads: {:.1}, ours {:.1}",
        times.paper, times.ours
    ));
    table.note("evaluations: qualities that the paper's transfer computes for one of ours");
    table.note(format!(
        "The paper carried {} grasps, {} of which ended unstable",
        paper::TRANSFERS,
        paper::UNSTABLE_TRANSFERS
    ));
    table
}
