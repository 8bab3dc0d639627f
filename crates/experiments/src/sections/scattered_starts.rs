//! Beyond Sec. IV-E: our transfer against the best of many runs of the paper's ascent on the target.
//!
//! Who does not mind the cost can start the paper's ascent (Sec. IV-D) many times around the naive
//! transfer and keep the best end. A transfer that does not get stuck is as good as that.

use hand::HandGrasp;
use rand::seq::index;
use serde::{Deserialize, Serialize};
use serde_json::json;
use space::sample::ContactSampling;
use space::{Continuation, PaperAscent};
use sph::Direction;

use crate::error::ExperimentError;
use crate::figures;
use crate::ledger::{self, ThreadSeconds, run_kept};
use crate::output::Findings;
use crate::paper;
use crate::pipeline::{FittedSet, best_grasps, directions, fitted_objects};
use crate::run::{Purpose, Run, generator};
use crate::sections::gradient_ascent::paper_ascent;
use crate::sections::transfer::transfer_between;
use crate::statistics::{mean, share};
use crate::table::{Table, number, per_cent};

/// Standard deviation of a contact's scatter, radians in both tangent coordinates.
const SPREAD: f64 = 0.3;
/// Differences of Q that are told apart in the result.
const MARGINS: [f64; 3] = [0.0, 1e-3, 1e-2];

/// What is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Numbers of the objects; all when absent.
    pub objects: Option<Vec<usize>>,
    /// Hand poses from which Ĝ_i is taken.
    pub poses: usize,
    /// Grasps of Ĝ_i that may be drawn.
    pub grasps: usize,
    /// Transfers that are drawn.
    pub sample: usize,
    /// Runs of the paper's ascent for each.
    pub runs: usize,
    /// The paper's ascent.
    pub ascent: PaperAscent,
}

impl Plan {
    /// The plan of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            objects: run.scale.pick(Some(vec![2, 9, 11]), None),
            poses: run.scale.pick(150, paper::HAND_POSES),
            grasps: run.scale.pick(2, paper::VERY_BEST_GRASPS),
            sample: run.scale.pick(6, 200),
            runs: run.scale.pick(3, 10),
            ascent: paper_ascent(run.scale.pick(100, paper::ASCENT_STEPS)),
        }
    }
}

/// One transfer, and what the runs reach.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// Where it came from.
    pub from: String,
    /// Where it went.
    pub to: String,
    /// Its rank among the grasps of its source, from 0.
    pub rank: usize,
    /// The runs of the paper's ascent.
    #[serde(flatten)]
    pub runs: Runs,
    /// Our transfer with its defaults.
    pub ours: f64,
    /// Our transfer when asked to be thorough.
    pub thorough: f64,
    /// Qualities that the thorough transfer computed.
    pub thorough_evaluations: usize,
}

/// Ends of the paper's ascent from scattered starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Runs {
    /// Q at every end.
    pub ends: Vec<f64>,
    /// Qualities that all runs computed.
    pub evaluations: usize,
}

impl Runs {
    /// The greatest Q of all ends.
    pub fn best(&self) -> f64 {
        self.ends.iter().copied().fold(0.0, f64::max)
    }
}

/// Ends of our transfer: default and thorough.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Ours {
    default: f64,
    thorough: f64,
    thorough_evaluations: usize,
}

/// Which share of ours is at least the best run less a margin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtLeast {
    /// The margin of Q.
    pub margin: f64,
    /// Of the default transfer.
    pub ours: Option<f64>,
    /// Of the thorough transfer.
    pub thorough: Option<f64>,
}

/// Runs the section.
pub fn run(run: &Run) -> Result<Findings, ExperimentError> {
    let plan = Plan::of(run);
    let set = fitted_objects(run, plan.objects.as_deref(), 2)?;
    let grasps = best_grasps(run, &set, plan.poses, plan.grasps)?;
    let (compared, times) = measure(run, &plan, &set, &grasps)?;
    let shares = shares(&compared);
    Ok(Findings {
        objects: set.describe(),
        paper: json!({ "steps": paper::ASCENT_STEPS, "unstable": paper::UNSTABLE_TRANSFERS }),
        table: table(&plan, &compared, &shares, &times),
        ours: json!({
            "runs": plan.runs,
            "spread_rad": SPREAD,
            "steps": plan.ascent.steps,
            "at_least_the_best_run": shares,
            "thread_seconds": times,
            "transfers": compared,
        }),
        figures: figures::scattered_starts::figures(&compared),
    })
}

/// Draws transfers, and carries each by both.
pub fn measure(
    run: &Run,
    plan: &Plan,
    set: &FittedSet,
    grasps: &[Vec<HandGrasp>],
) -> Result<(Vec<Compared>, ThreadSeconds), ExperimentError> {
    let starts = directions(grasps);
    let key = ledger::key(run, set, &starts, plan)?;
    let drawn = draw(run, plan, &starts);
    run.say(&format!(
        "{} transfers, {} runs each",
        drawn.len(),
        plan.runs
    ));
    let numbered: Vec<(usize, [usize; 3])> = drawn.iter().copied().enumerate().collect();
    let runs = run_kept(
        run,
        "scattered runs",
        &key,
        &numbered,
        |&(n, [i, j, rank])| scattered(run, plan, set, n, j, &starts[i][rank]),
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
fn draw(run: &Run, plan: &Plan, starts: &[Vec<Vec<Direction>>]) -> Vec<[usize; 3]> {
    let mut all = Vec::new();
    for (i, grasps) in starts.iter().enumerate() {
        for j in (0..starts.len()).filter(|j| *j != i) {
            all.extend((0..grasps.len()).map(|rank| [i, j, rank]));
        }
    }
    let mut rng = generator(run.seed, Purpose::Starts, 0);
    let mut chosen = index::sample(&mut rng, all.len(), plan.sample.min(all.len())).into_vec();
    chosen.sort_unstable();
    chosen.into_iter().map(|k| all[k]).collect()
}

/// The paper's ascent on the target from starts around the naive transfer, which keeps θ and φ.
fn scattered(
    run: &Run,
    plan: &Plan,
    set: &FittedSet,
    sample: usize,
    to: usize,
    contacts: &[Direction],
) -> Result<Runs, ExperimentError> {
    let target = &set.objects[to];
    let mut rng = generator(run.seed, Purpose::Starts, 1 + sample);
    let mut objective = target.objective(&run.convention);
    let mut runs = Runs {
        ends: Vec::with_capacity(plan.runs),
        evaluations: 0,
    };
    for _ in 0..plan.runs {
        let start = ContactSampling::Around(contacts, SPREAD).draw(&mut rng);
        let end = plan
            .ascent
            .climb(&target.surface, &start, &mut objective, |_| {})?;
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

/// Shares by margin.
pub fn shares(compared: &[Compared]) -> Vec<AtLeast> {
    let of = |margin: f64, pick: fn(&Compared) -> f64| {
        let reached = |c: &&Compared| pick(c) >= c.runs.best() - margin;
        share(compared.iter().filter(reached).count(), compared.len())
    };
    MARGINS
        .iter()
        .map(|&margin| AtLeast {
            margin,
            ours: of(margin, |c| c.ours),
            thorough: of(margin, |c| c.thorough),
        })
        .collect()
}

fn table(plan: &Plan, compared: &[Compared], shares: &[AtLeast], times: &ThreadSeconds) -> Table {
    let mut table = Table::new(
        format!(
            "Transfers against the best of {} runs of the paper's ascent of {} steps from starts scattered by {SPREAD} rad",
            plan.runs, plan.ascent.steps
        ),
        &["at least the best run less", "ours", "ours, thorough"],
    );
    for s in shares {
        table.row([s.margin.to_string(), per_cent(s.ours), per_cent(s.thorough)]);
    }
    let mean_of = |pick: fn(&Compared) -> f64| mean(&compared.iter().map(pick).collect::<Vec<_>>());
    table.note(format!(
        "{} transfers; mean of the best run {}, of ours {}, thorough {}",
        compared.len(),
        number(mean_of(|c| c.runs.best()), 4),
        number(mean_of(|c| c.ours), 4),
        number(mean_of(|c| c.thorough), 4)
    ));
    table.note(format!(
        "Mean qualities computed: all runs {}, thorough {}; seconds summed over threads {:.1} and {:.1}",
        number(mean_of(|c| c.runs.evaluations as f64), 0),
        number(mean_of(|c| c.thorough_evaluations as f64), 0),
        times.paper,
        times.ours
    ));
    table
}
