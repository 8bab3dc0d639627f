//! Synthesis of hand grasps on every object.

use grasp::Convention;
use hand::OutcomeCounts;
use moduli::{Grasp, Grasps, Hand, Source};

use super::findings::{ObjectGrasps, Settings, UnderConvention};
use crate::error::ExperimentError;
use crate::paper;
use crate::pipeline::{FittedScan, FittedSet, synthesize};
use crate::run::Run;
use crate::statistics::{rank_correlation, share, summary};

/// Closes the hand on every object from random poses.
pub fn measure(
    run: &Run,
    settings: &Settings,
    set: &FittedSet,
) -> Result<Vec<ObjectGrasps>, ExperimentError> {
    let hand = Hand::schunk_sdh()?;
    let conventions = all_conventions();
    let preshapes = hand.preshapes().len();
    let mut all = Vec::with_capacity(set.objects.len());
    for fitted in &set.objects {
        run.say(&format!("{} poses around {}", settings.poses, fitted.id()));
        let found = synthesize(fitted, &hand, &run.convention, settings.poses, run.seed)?;
        let under = conventions
            .iter()
            .map(|convention| under(convention, fitted, &found))
            .collect::<Result<_, _>>()?;
        all.push(describe(fitted, &found, preshapes, under));
    }
    Ok(all)
}

pub(super) fn all_conventions() -> Vec<Convention> {
    let named = |name: &&str| Convention::named(name).ok();
    Convention::NAMES.iter().filter_map(named).collect()
}

fn describe(
    fitted: &FittedScan,
    found: &Grasps,
    preshapes: usize,
    conventions: Vec<UnderConvention>,
) -> ObjectGrasps {
    let none = OutcomeCounts::default();
    let outcomes = found.outcomes().unwrap_or(&none);
    let (stable, unstable) = (outcomes.stable, outcomes.unstable);
    let poses = outcomes.total();
    let rejected = outcomes.by_reason();
    let qualities: Vec<f64> = found.iter().map(Grasp::quality).collect();
    let first = |count: usize| &qualities[..count.min(qualities.len())];
    let of_preshape = |k| {
        let from =
            |g: &&Grasp| matches!(g.source(), Source::Synthesis { preshape } if *preshape == k);
        found.iter().filter(from).count()
    };
    ObjectGrasps {
        id: fitted.id().to_owned(),
        poses,
        stable,
        unstable,
        rejected: rejected
            .into_iter()
            .map(|(why, n)| (why.to_owned(), n.into()))
            .collect(),
        stable_of_1400: (stable * paper::HAND_POSES) as f64 / poses.max(1) as f64,
        stable_by_preshape: (0..preshapes).map(of_preshape).collect(),
        best_qualities: first(paper::BEST_GRASPS).to_vec(),
        best_contacts: found.iter().next().map(|g| g.directions().to_vec()),
        best: summary(first(paper::BEST_GRASPS)),
        very_best: summary(first(paper::VERY_BEST_GRASPS)),
        conventions,
    }
}

fn under(
    convention: &Convention,
    fitted: &FittedScan,
    grasps: &Grasps,
) -> Result<UnderConvention, ExperimentError> {
    let mut objective = fitted.objective(convention)?;
    let qualities = grasps
        .iter()
        .map(|grasp| objective.quality(grasp.contacts()))
        .collect::<Result<Vec<f64>, _>>()?;
    let ranked: Vec<f64> = grasps.iter().map(Grasp::quality).collect();
    let closed = qualities.iter().filter(|q| **q > 0.0).count();
    Ok(UnderConvention {
        name: convention.name.clone(),
        quality: summary(&qualities),
        share_closed: share(closed, qualities.len()),
        rank_correlation: rank_correlation(&ranked, &qualities),
    })
}
