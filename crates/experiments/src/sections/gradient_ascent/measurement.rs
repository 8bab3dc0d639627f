//! The paper's ascent and ours from the best grasps of every object.

use moduli::Grasp;
use space::MonotoneAscent;
use sph::Direction;

use super::findings::{Climb, DrawnClimb, ObjectClimbs, OurClimb, PaperClimb, Settings};
use crate::error::ExperimentError;
use crate::ledger::{self, ThreadSeconds, run_kept};
use crate::paper;
use crate::pipeline::{FittedScan, FittedSet, directions};
use crate::run::Run;

/// Runs ascents from the given grasps of every object: first all of the paper's, then all of ours.
///
/// # Errors
/// A quality cannot be computed, or completed ascents cannot be stored.
pub fn measure(
    run: &Run,
    settings: &Settings,
    set: &FittedSet,
    grasps: &[Vec<Grasp>],
) -> Result<(Vec<ObjectClimbs>, ThreadSeconds), ExperimentError> {
    let starts = directions(grasps);
    let key = ledger::key(run, set, &starts, settings)?;
    let jobs: Vec<(&FittedScan, &[Direction])> = set
        .objects
        .iter()
        .zip(&starts)
        .flat_map(|(fitted, starts)| starts.iter().map(move |start| (fitted, &start[..])))
        .collect();
    run.say(&format!(
        "{} ascents of {} steps, and ours",
        jobs.len(),
        settings.ascent.steps
    ));
    let paper = run_kept(
        run,
        "ascents of the paper",
        &key,
        &jobs,
        |(fitted, start)| climb_as_the_paper(run, settings, fitted, start),
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
    settings: &Settings,
    fitted: &FittedScan,
    start: &[Direction],
) -> Result<PaperClimb, ExperimentError> {
    let mut objective = fitted.objective(&run.convention)?;
    let mut highest = 0.0_f64;
    let end = settings
        .ascent
        .climb(fitted.field(), start, &mut objective, |step| {
            highest = highest.max(step.quality);
        })?;
    let moved = start
        .iter()
        .zip(&end.directions)
        .map(|(p, q)| sph::direction::angle(p, q));
    Ok(PaperClimb {
        initial: end.start_quality,
        last: end.quality,
        highest,
        evaluations: end.evaluations,
        moved_rad: moved.fold(0.0, f64::max),
    })
}

fn climb(run: &Run, fitted: &FittedScan, start: &[Direction]) -> Result<OurClimb, ExperimentError> {
    let mut objective = fitted.objective(&run.convention)?;
    let end = MonotoneAscent::default().climb(fitted.field(), start, &mut objective, |_| {})?;
    Ok(OurClimb {
        last: end.quality,
        evaluations: end.evaluations,
        stationarity: end.stationarity,
    })
}

/// The ascents for the figure: the largest improvements on four objects, and the smallest of all.
pub(super) fn drawn(
    run: &Run,
    settings: &Settings,
    set: &FittedSet,
    grasps: &[Vec<Grasp>],
    found: &[ObjectClimbs],
) -> Result<Vec<DrawnClimb>, ExperimentError> {
    let mut all: Vec<(&FittedScan, &[Direction], &PaperClimb)> = Vec::new();
    for ((fitted, grasps), of) in set.objects.iter().zip(grasps).zip(found) {
        let pairs = grasps.iter().zip(&of.climbs);
        all.extend(pairs.map(|(g, c)| (fitted, g.directions(), &c.paper)));
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
        .map(|(fitted, start, climb)| draw(run, settings, fitted, start, climb))
        .collect()
}

/// Repeats an ascent and keeps every tenth state.
fn draw(
    run: &Run,
    settings: &Settings,
    fitted: &FittedScan,
    start: &[Direction],
    climb: &PaperClimb,
) -> Result<DrawnClimb, ExperimentError> {
    let mut objective = fitted.objective(&run.convention)?;
    let mut states = Vec::new();
    let mut count = 0;
    let keep = |step: &space::Step| {
        if count % 10 == 0 {
            states.push(step.directions.to_vec());
        }
        count += 1;
    };
    let end = settings
        .ascent
        .climb(fitted.field(), start, &mut objective, keep)?;
    states.push(end.directions);
    Ok(DrawnClimb {
        label: format!("{} Q {:.2} → {:.2}", fitted.id(), climb.initial, climb.last),
        shape: fitted.shape().clone(),
        states,
    })
}
