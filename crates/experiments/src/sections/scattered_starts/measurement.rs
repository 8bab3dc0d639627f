//! A sample of transfers, computed by both schemes.

use moduli::Grasp;
use rand::seq::index;
use serde::{Deserialize, Serialize};
use space::Continuation;
use space::sample::ContactSampling;
use sph::Direction;

use super::findings::{Compared, Runs, SPREAD, Settings};
use crate::error::ExperimentError;
use crate::ledger::{self, ThreadSeconds, run_kept};
use crate::pipeline::{FittedSet, directions, transfer_between};
use crate::run::{Purpose, Run, generator};

/// Ends of our transfer: default and thorough.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Ours {
    default: f64,
    thorough: f64,
    thorough_evaluations: usize,
}

/// Draws a sample of transfers and computes each by both schemes.
///
/// # Errors
/// A transfer or an ascent fails, or completed results cannot be stored.
pub fn measure(
    run: &Run,
    settings: &Settings,
    set: &FittedSet,
    grasps: &[Vec<Grasp>],
) -> Result<(Vec<Compared>, ThreadSeconds), ExperimentError> {
    let starts = directions(grasps);
    let key = ledger::key(run, set, &starts, settings)?;
    let drawn = draw(run, settings, &starts);
    run.say(&format!(
        "{} transfers, {} runs each",
        drawn.len(),
        settings.runs
    ));
    let numbered: Vec<(usize, [usize; 3])> = drawn.iter().copied().enumerate().collect();
    let runs = run_kept(
        run,
        "scattered runs",
        &key,
        &numbered,
        |&(n, [i, j, rank])| scattered(run, settings, set, n, j, &starts[i][rank]),
    )?;
    let ours = run_kept(run, "transfers of ours", &key, &drawn, |&[i, j, rank]| {
        carry(run, set, [i, j], &starts[i][rank])
    })?;
    let times = ThreadSeconds {
        paper: runs.thread_seconds,
        ours: ours.thread_seconds,
    };
    let ends = runs.results.into_iter().zip(ours.results);
    let compared = drawn
        .iter()
        .zip(ends)
        .map(|(&[i, j, rank], (runs, ours))| Compared {
            from: set.objects[i].id().to_owned(),
            to: set.objects[j].id().to_owned(),
            rank,
            runs,
            ours: ours.default,
            thorough: ours.thorough,
            thorough_evaluations: ours.thorough_evaluations,
        });
    Ok((compared.collect(), times))
}

/// Source, target and rank of the sample, in order.
fn draw(run: &Run, settings: &Settings, starts: &[Vec<Vec<Direction>>]) -> Vec<[usize; 3]> {
    let mut all = Vec::new();
    for (i, grasps) in starts.iter().enumerate() {
        for j in (0..starts.len()).filter(|j| *j != i) {
            all.extend((0..grasps.len()).map(|rank| [i, j, rank]));
        }
    }
    let mut rng = generator(run.seed, Purpose::Starts, 0);
    let mut chosen = index::sample(&mut rng, all.len(), settings.sample.min(all.len())).into_vec();
    chosen.sort_unstable();
    chosen.into_iter().map(|k| all[k]).collect()
}

/// The paper's ascent on the target from starts around the naive transfer, which keeps θ and φ.
fn scattered(
    run: &Run,
    settings: &Settings,
    set: &FittedSet,
    sample: usize,
    to: usize,
    contacts: &[Direction],
) -> Result<Runs, ExperimentError> {
    let target = &set.objects[to];
    let mut rng = generator(run.seed, Purpose::Starts, 1 + sample);
    let mut objective = target.objective(&run.convention)?;
    let mut runs = Runs {
        ends: Vec::with_capacity(settings.runs),
        evaluations: 0,
    };
    for _ in 0..settings.runs {
        let start = ContactSampling::Around(contacts, SPREAD).draw(&mut rng);
        let end = settings
            .ascent
            .climb(target.field(), &start, &mut objective, |_| {})?;
        runs.ends.push(end.quality);
        runs.evaluations += end.evaluations;
    }
    Ok(runs)
}

fn carry(
    run: &Run,
    set: &FittedSet,
    [from, to]: [usize; 2],
    contacts: &[Direction],
) -> Result<Ours, ExperimentError> {
    let transfer = transfer_between(run, &set.objects[from], &set.objects[to]);
    let with = |scheme: &Continuation| scheme.carry(&transfer, contacts);
    let thorough = with(&Continuation::thorough())?;
    Ok(Ours {
        default: with(&Continuation::default())?.quality,
        thorough: thorough.quality,
        thorough_evaluations: thorough.evaluations,
    })
}
