//! Fig. 7, Fig. 8 and Sec. IV-D: the paper's ascent and ours from the grasps of G_i.

use hand::HandGrasp;
use serde::{Deserialize, Serialize};
use serde_json::json;
use space::{MonotoneAscent, PaperAscent};
use sph::Direction;

use crate::error::ExperimentError;
use crate::figures::{self, gradient_ascent::DrawnClimb};
use crate::ledger::{self, ThreadSeconds, run_kept};
use crate::output::Findings;
use crate::paper;
use crate::pipeline::{FittedObject, FittedSet, best_grasps, directions, fitted_objects};
use crate::run::Run;
use crate::statistics::{mean, share, summary};
use crate::table::{Table, number, per_cent};

/// What is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Hand poses from which G_i is taken.
    pub poses: usize,
    /// Grasps of G_i that climb.
    pub grasps: usize,
    /// The ascent.
    pub ascent: PaperAscent,
}

impl Plan {
    /// The plan of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            poses: run.scale.pick(150, paper::HAND_POSES),
            grasps: run.scale.pick(4, paper::BEST_GRASPS),
            ascent: paper_ascent(run.scale.pick(200, paper::ASCENT_STEPS)),
        }
    }
}

/// The paper's ascent with some number of steps.
pub fn paper_ascent(steps: usize) -> PaperAscent {
    PaperAscent {
        steps,
        delta: paper::DIFFERENCE_STEP,
        rate: paper::ASCENT_RATE,
    }
}

/// One ascent.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Climb {
    /// The paper's ascent.
    #[serde(flatten)]
    pub paper: PaperClimb,
    /// Our ascent from the same start.
    pub ours: OurClimb,
}

/// Where the paper's ascent ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PaperClimb {
    /// Q at the start.
    pub initial: f64,
    /// Q at the end.
    pub last: f64,
    /// The largest Q on the way.
    pub highest: f64,
    /// Qualities computed.
    pub evaluations: usize,
    /// Largest angle between where a contact began and where it ended, radians.
    pub moved_rad: f64,
}

/// Where our ascent ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OurClimb {
    /// Q at the end.
    pub last: f64,
    /// Qualities computed.
    pub evaluations: usize,
    /// Slope of Q left at the end, per radian.
    pub stationarity: f64,
}

/// The ascents on one object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectClimbs {
    /// The object.
    pub id: String,
    /// Its ascents, by rank of the start.
    pub climbs: Vec<Climb>,
}

/// All ascents in short.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Overall {
    /// Ascents.
    pub climbs: usize,
    /// Share that ended higher than they began.
    pub share_improved: Option<f64>,
    /// Share that ended lower.
    pub share_worsened: Option<f64>,
    /// Mean of Q at the starts.
    pub mean_initial: Option<f64>,
    /// Mean of Q at the ends.
    pub mean_final: Option<f64>,
    /// Mean change of Q.
    pub mean_change: Option<f64>,
    /// Mean of Q lost between the highest state and the end: what the fixed step throws away.
    pub mean_lost_from_highest: Option<f64>,
    /// Our ascent from the same starts: share that ended higher.
    pub ours_share_improved: Option<f64>,
    /// Ours that ended lower than they began.
    pub ours_below_start: usize,
    /// Ours: mean of Q at the ends.
    pub ours_mean_final: Option<f64>,
    /// Largest slope of Q left at an end of ours, per radian.
    pub ours_largest_stationarity: f64,
    /// Qualities that the paper's ascent computes for one of ours.
    pub evaluations_ratio: Option<f64>,
}

/// Runs the section.
pub fn run(run: &Run) -> Result<Findings, ExperimentError> {
    let plan = Plan::of(run);
    let set = fitted_objects(run, None, 1)?;
    let grasps = best_grasps(run, &set, plan.poses, plan.grasps)?;
    let (ours, times) = measure(run, &plan, &set, &grasps)?;
    let all: Vec<Climb> = ours.iter().flat_map(|o| o.climbs.iter().cloned()).collect();
    let overall = overall(&all);
    Ok(Findings {
        objects: set.describe(),
        paper: json!({
            "poses": paper::HAND_POSES,
            "grasps_per_object": paper::BEST_GRASPS,
            "steps": paper::ASCENT_STEPS,
            "delta": paper::DIFFERENCE_STEP,
            "rate": paper::ASCENT_RATE,
            "examples_initial_final": paper::ASCENT_EXAMPLES,
            "finding": "quality typically improves significantly; some ascents do not converge and end worse",
        }),
        table: table(&plan, &ours, &overall, &times),
        ours: json!({
            "poses": plan.poses,
            "grasps_per_object": plan.grasps,
            "steps": plan.ascent.steps,
            "overall": overall,
            "thread_seconds": times,
            "largest_improvements_initial_final": examples(&all),
            "by_object": ours,
        }),
        figures: figures::gradient_ascent::figures(
            &ours,
            &drawn(run, &plan, &set, &grasps, &ours)?,
        ),
    })
}

/// Climbs from given grasps of every object: all ascents of the paper, then all of ours.
pub fn measure(
    run: &Run,
    plan: &Plan,
    set: &FittedSet,
    grasps: &[Vec<HandGrasp>],
) -> Result<(Vec<ObjectClimbs>, ThreadSeconds), ExperimentError> {
    let starts = directions(grasps);
    let key = ledger::key(run, set, &starts, plan)?;
    let jobs: Vec<(&FittedObject, &[Direction])> = set
        .objects
        .iter()
        .zip(&starts)
        .flat_map(|(fitted, starts)| starts.iter().map(move |start| (fitted, &start[..])))
        .collect();
    run.say(&format!(
        "{} ascents of {} steps, and ours",
        jobs.len(),
        plan.ascent.steps
    ));
    let paper = run_kept(
        run,
        "ascents of the paper",
        &key,
        &jobs,
        |(fitted, start)| climb_as_the_paper(run, plan, fitted, start),
    )?;
    let ours = run_kept(run, "ascents of ours", &key, &jobs, |(fitted, start)| {
        climb(run, fitted, start)
    })?;
    let times = ThreadSeconds {
        paper: paper.thread_seconds,
        ours: ours.thread_seconds,
    };
    let mut climbs = paper
        .results
        .into_iter()
        .zip(ours.results)
        .map(|(paper, ours)| Climb { paper, ours });
    let by_object = set
        .objects
        .iter()
        .zip(&starts)
        .map(|(fitted, starts)| ObjectClimbs {
            id: fitted.id().to_owned(),
            climbs: climbs.by_ref().take(starts.len()).collect(),
        })
        .collect();
    Ok((by_object, times))
}

fn climb_as_the_paper(
    run: &Run,
    plan: &Plan,
    fitted: &FittedObject,
    start: &[Direction],
) -> Result<PaperClimb, ExperimentError> {
    let mut objective = fitted.objective(&run.convention);
    let mut highest = 0.0_f64;
    let end = plan
        .ascent
        .climb(&fitted.surface, start, &mut objective, |step| {
            highest = highest.max(step.quality);
        })?;
    let moved = start
        .iter()
        .zip(&end.contacts)
        .map(|(p, q)| sph::direction::angle(p, q));
    Ok(PaperClimb {
        initial: end.start_quality,
        last: end.quality,
        highest,
        evaluations: end.evaluations,
        moved_rad: moved.fold(0.0, f64::max),
    })
}

fn climb(
    run: &Run,
    fitted: &FittedObject,
    start: &[Direction],
) -> Result<OurClimb, ExperimentError> {
    let mut objective = fitted.objective(&run.convention);
    let end = MonotoneAscent::default().climb(&fitted.surface, start, &mut objective, |_| {})?;
    Ok(OurClimb {
        last: end.quality,
        evaluations: end.evaluations,
        stationarity: end.stationarity,
    })
}

/// The ascents that gained most on four objects and the one that gained least, to be drawn.
fn drawn<'a>(
    run: &Run,
    plan: &Plan,
    set: &'a FittedSet,
    grasps: &[Vec<HandGrasp>],
    found: &[ObjectClimbs],
) -> Result<Vec<DrawnClimb<'a>>, ExperimentError> {
    let mut all: Vec<(&'a FittedObject, &[Direction], &PaperClimb)> = Vec::new();
    for ((fitted, grasps), of) in set.objects.iter().zip(grasps).zip(found) {
        let pairs = grasps.iter().zip(&of.climbs);
        all.extend(pairs.map(|(g, c)| (fitted, &g.directions[..], &c.paper)));
    }
    let gain = |climb: &PaperClimb| climb.last - climb.initial;
    all.sort_by(|a, b| gain(b.2).total_cmp(&gain(a.2)));
    let mut chosen = Vec::new();
    let mut ids: Vec<&str> = Vec::new();
    for one in &all {
        if ids.len() < paper::ASCENT_EXAMPLES.len() && !ids.contains(&one.0.id()) {
            ids.push(one.0.id());
            chosen.push(one);
        }
    }
    chosen.extend(all.last());
    chosen
        .into_iter()
        .map(|(fitted, start, climb)| draw(run, plan, fitted, start, climb))
        .collect()
}

/// An ascent once more, with every tenth state.
fn draw<'a>(
    run: &Run,
    plan: &Plan,
    fitted: &'a FittedObject,
    start: &[Direction],
    climb: &PaperClimb,
) -> Result<DrawnClimb<'a>, ExperimentError> {
    let mut objective = fitted.objective(&run.convention);
    let mut states = Vec::new();
    let mut count = 0;
    let keep = |step: &space::Step| {
        if count % 10 == 0 {
            states.push(step.contacts.to_vec());
        }
        count += 1;
    };
    let end = plan
        .ascent
        .climb(&fitted.surface, start, &mut objective, keep)?;
    states.push(end.contacts);
    Ok(DrawnClimb {
        label: format!("{} Q {:.2} → {:.2}", fitted.id(), climb.initial, climb.last),
        shape: fitted.shape(),
        states,
    })
}

/// All ascents in short.
pub fn overall(climbs: &[Climb]) -> Overall {
    let mean_of = |pick: fn(&Climb) -> f64| mean(&climbs.iter().map(pick).collect::<Vec<_>>());
    let share_of =
        |which: fn(&&Climb) -> bool| share(climbs.iter().filter(which).count(), climbs.len());
    let total = |pick: fn(&Climb) -> usize| climbs.iter().map(pick).sum::<usize>();
    let slopes = climbs.iter().map(|c| c.ours.stationarity);
    Overall {
        climbs: climbs.len(),
        share_improved: share_of(|c| c.paper.last > c.paper.initial),
        share_worsened: share_of(|c| c.paper.last < c.paper.initial),
        mean_initial: mean_of(|c| c.paper.initial),
        mean_final: mean_of(|c| c.paper.last),
        mean_change: mean_of(|c| c.paper.last - c.paper.initial),
        mean_lost_from_highest: mean_of(|c| c.paper.highest - c.paper.last),
        ours_share_improved: share_of(|c| c.ours.last > c.paper.initial),
        ours_below_start: climbs
            .iter()
            .filter(|c| c.ours.last < c.paper.initial)
            .count(),
        ours_mean_final: mean_of(|c| c.ours.last),
        ours_largest_stationarity: slopes.fold(0.0, f64::max),
        evaluations_ratio: share(
            total(|c| c.paper.evaluations),
            total(|c| c.ours.evaluations),
        ),
    }
}

/// The four ascents that gained most, to stand beside those of Fig. 8.
fn examples(climbs: &[Climb]) -> Vec<(f64, f64)> {
    let mut sorted: Vec<&Climb> = climbs.iter().collect();
    let gain = |c: &Climb| c.paper.last - c.paper.initial;
    sorted.sort_by(|a, b| gain(b).total_cmp(&gain(a)));
    sorted
        .iter()
        .take(paper::ASCENT_EXAMPLES.len())
        .map(|c| (c.paper.initial, c.paper.last))
        .collect()
}

fn table(plan: &Plan, ours: &[ObjectClimbs], overall: &Overall, times: &ThreadSeconds) -> Table {
    let mut table = Table::new(
        format!(
            "Sec. IV-D: {} steps of the paper's ascent from the best {} grasps of {} poses (paper: {}, {}, {})",
            plan.ascent.steps,
            plan.grasps,
            plan.poses,
            paper::ASCENT_STEPS,
            paper::BEST_GRASPS,
            paper::HAND_POSES
        ),
        &[
            "object",
            "ascents",
            "improved",
            "worse",
            "initial",
            "final",
            "best final",
            "ours",
            "ours worse",
        ],
    );
    for o in ours {
        let of = self::overall(&o.climbs);
        let ends: Vec<f64> = o.climbs.iter().map(|c| c.paper.last).collect();
        table.row([
            o.id.clone(),
            of.climbs.to_string(),
            per_cent(of.share_improved),
            per_cent(of.share_worsened),
            number(of.mean_initial, 3),
            number(of.mean_final, 3),
            number(summary(&ends).map(|s| s.greatest), 3),
            number(of.ours_mean_final, 3),
            of.ours_below_start.to_string(),
        ]);
    }
    table.row([
        "all".into(),
        overall.climbs.to_string(),
        per_cent(overall.share_improved),
        per_cent(overall.share_worsened),
        number(overall.mean_initial, 3),
        number(overall.mean_final, 3),
        String::new(),
        number(overall.ours_mean_final, 3),
        overall.ours_below_start.to_string(),
    ]);
    let pairs = |list: &[(f64, f64)]| {
        let text: Vec<String> = list.iter().map(|(a, b)| format!("{a:.2}→{b:.2}")).collect();
        text.join(", ")
    };
    let all: Vec<Climb> = ours.iter().flat_map(|o| o.climbs.iter().cloned()).collect();
    table.note(format!(
        "Ours from the same starts: {} improved, none of its steps down; the paper's computes {} times as many qualities",
        per_cent(overall.ours_share_improved),
        number(overall.evaluations_ratio, 1)
    ));
    table.note(format!(
        "Seconds of all ascents, summed over threads: {:.1}, ours {:.1}",
        times.paper, times.ours
    ));
    table.note(format!(
        "Largest improvements {}; examples of the paper {}",
        pairs(&examples(&all)),
        pairs(&paper::ASCENT_EXAMPLES)
    ));
    table
}
