//! Sec. IV-C: grasps of the Schunk hand from random poses, G_i and Ĝ_i.

use grasp::Convention;
use hand::{HandGrasp, OutcomeCounts, Synthesis};
use moduli::records::convention_record;
use serde::Serialize;
use serde_json::{Map, Value, json};
use sph::Direction;

use crate::error::ExperimentError;
use crate::figures;
use crate::output::Findings;
use crate::paper;
use crate::pipeline::{FittedObject, FittedSet, fitted_objects, synthesize};
use crate::run::Run;
use crate::statistics::{Summary, rank_correlation, share, summary};
use crate::table::{Table, number, per_cent};

/// What is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Poses a surface.
    pub poses: usize,
}

impl Plan {
    /// The plan of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            poses: run.scale.pick(150, paper::HAND_POSES),
        }
    }
}

/// The grasps of one object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectGrasps {
    /// The object.
    pub id: String,
    /// Poses tried.
    pub poses: usize,
    /// Stable grasps: quality at least 0.01 under the paper's convention, force-closed under others.
    pub stable: usize,
    /// Closed on the object, but of less quality.
    pub unstable: usize,
    /// Rejected poses by reason.
    pub rejected: Map<String, Value>,
    /// Stable grasps to be expected of as many poses as in the paper.
    pub stable_of_1400: f64,
    /// Stable grasps by pre-shape: parallel, spread.
    pub stable_by_preshape: Vec<usize>,
    /// Qualities of G_i, the best 50, best first.
    pub best_qualities: Vec<f64>,
    /// Contacts of the best grasp.
    #[serde(skip)]
    pub best_contacts: Option<Vec<Direction>>,
    /// G_i in short.
    pub best: Option<Summary>,
    /// Ĝ_i, the best 10, in short.
    pub very_best: Option<Summary>,
    /// The same grasps under every convention.
    pub conventions: Vec<UnderConvention>,
}

/// What a convention says of the stable grasps that were ranked under the run's.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnderConvention {
    /// The convention.
    pub name: String,
    /// Quality of the stable grasps; 0 where it calls one open.
    pub quality: Option<Summary>,
    /// Share that it calls force-closed.
    pub share_closed: Option<f64>,
    /// Spearman's correlation of its ranking with the run's.
    pub rank_correlation: Option<f64>,
}

/// Runs the section.
pub fn run(run: &Run) -> Result<Findings, ExperimentError> {
    let set = fitted_objects(run, None, 1)?;
    let ours = measure(run, &Plan::of(run), &set)?;
    let conventions = all_conventions();
    let described: Vec<_> = conventions.iter().map(convention_record).collect();
    Ok(Findings {
        objects: set.describe(),
        paper: json!({
            "poses": paper::HAND_POSES,
            "stable_above": paper::STABLE_GRASPS_ABOVE,
            "best_grasps": paper::BEST_GRASPS,
            "very_best_grasps": paper::VERY_BEST_GRASPS,
            "collision_mesh_vertices": paper::COLLISION_VERTICES,
        }),
        table: table(&ours, &conventions),
        ours: json!({ "grasps": ours, "conventions": described }),
        figures: figures::initial_grasps::figures(&set, &ours),
    })
}

/// Closes the hand on every object.
pub fn measure(
    run: &Run,
    plan: &Plan,
    set: &FittedSet,
) -> Result<Vec<ObjectGrasps>, ExperimentError> {
    let hand = hand::schunk_sdh()?;
    let conventions = all_conventions();
    let preshapes = hand.preshapes().len();
    let mut all = Vec::with_capacity(set.objects.len());
    for fitted in &set.objects {
        run.say(&format!("{} poses around {}", plan.poses, fitted.id()));
        let found = synthesize(fitted, &hand, &run.convention, plan.poses, run.seed)?;
        let under = conventions
            .iter()
            .map(|convention| under(convention, fitted, &found.grasps))
            .collect::<Result<_, _>>()?;
        all.push(describe(fitted, &found, preshapes, under));
    }
    Ok(all)
}

fn all_conventions() -> Vec<Convention> {
    let named = |name: &&str| Convention::named(name).ok();
    Convention::NAMES.iter().filter_map(named).collect()
}

fn describe(
    fitted: &FittedObject,
    found: &Synthesis,
    preshapes: usize,
    conventions: Vec<UnderConvention>,
) -> ObjectGrasps {
    let OutcomeCounts {
        stable, unstable, ..
    } = found.outcomes;
    let poses = found.outcomes.total();
    let rejected = found.outcomes.by_reason();
    let qualities: Vec<f64> = found.grasps.iter().map(|g| g.quality).collect();
    let first = |count: usize| &qualities[..count.min(qualities.len())];
    let of_preshape = |k| found.grasps.iter().filter(|g| g.preshape == k).count();
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
        best_contacts: found.grasps.first().map(|g| g.directions.clone()),
        best: summary(first(paper::BEST_GRASPS)),
        very_best: summary(first(paper::VERY_BEST_GRASPS)),
        conventions,
    }
}

fn under(
    convention: &Convention,
    fitted: &FittedObject,
    grasps: &[HandGrasp],
) -> Result<UnderConvention, ExperimentError> {
    let mut objective = fitted.objective(convention);
    let qualities = grasps
        .iter()
        .map(|grasp| objective.quality(&grasp.contacts))
        .collect::<Result<Vec<f64>, _>>()?;
    let ranked: Vec<f64> = grasps.iter().map(|g| g.quality).collect();
    let closed = qualities.iter().filter(|q| **q > 0.0).count();
    Ok(UnderConvention {
        name: convention.name.clone(),
        quality: summary(&qualities),
        share_closed: share(closed, qualities.len()),
        rank_correlation: rank_correlation(&ranked, &qualities),
    })
}

fn table(ours: &[ObjectGrasps], conventions: &[Convention]) -> Table {
    let poses = ours.first().map_or(0, |o| o.poses);
    let mut table = Table::new(
        format!(
            "Sec. IV-C: {poses} hand poses a surface; then the mean quality of the stable grasps under each convention"
        ),
        &[
            "object", "stable", "of 1400", "unstable", "rejected", "best", "10th", "50th",
        ],
    );
    table
        .header
        .extend(conventions.iter().map(|c| c.name.clone()));
    for o in ours {
        let ranked = |rank: usize| number(o.best_qualities.get(rank - 1).copied(), 3);
        let mut row = vec![
            o.id.clone(),
            o.stable.to_string(),
            number(Some(o.stable_of_1400), 0),
            o.unstable.to_string(),
            (o.poses - o.stable - o.unstable).to_string(),
            ranked(1),
            ranked(paper::VERY_BEST_GRASPS),
            ranked(paper::BEST_GRASPS),
        ];
        row.extend(
            o.conventions
                .iter()
                .map(|c| number(c.quality.map(|q| q.mean), 4)),
        );
        table.rows.push(row);
    }
    let least = ours
        .iter()
        .map(|o| o.stable_of_1400)
        .fold(f64::INFINITY, f64::min);
    table.note(format!(
        "Stable grasps of 1400 poses: at least {least:.0} on every object; paper: more than {}",
        paper::STABLE_GRASPS_ABOVE
    ));
    for convention in conventions {
        table.note(rank_note(ours, &convention.name));
    }
    table
}

fn rank_note(ours: &[ObjectGrasps], name: &str) -> String {
    let of = |o: &ObjectGrasps| {
        let found = o.conventions.iter().find(|c| c.name == name)?;
        Some((found.rank_correlation?, found.share_closed?))
    };
    let found: Vec<(f64, f64)> = ours.iter().filter_map(of).collect();
    let mean = |pick: fn(&(f64, f64)) -> f64| {
        crate::statistics::mean(&found.iter().map(pick).collect::<Vec<_>>())
    };
    format!(
        "{name}: {} force-closed, rank correlation {}",
        per_cent(mean(|f| f.1)),
        number(mean(|f| f.0), 2)
    )
}
