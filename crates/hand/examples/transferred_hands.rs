//! How many transferred and improved grasps of the built-in catalogue a hand can make.
//!
//! On each of the twelve objects the SDH closes from 1,400 poses; its ten best grasps there are
//! carried to the eleven others and improved (`space::Continuation`), and a hand pose is sought
//! for each: 1,320 in all. "Reached": tips within 2 mm of the wanted contacts, normals within the
//! friction cone, every clearance kept. "Improved": no such hand was found, so the best grasp that
//! the hand makes near those contacts was sought, and it is no worse than the naive transfer and
//! at least 0.01. Q of the hand is always that of the contacts that it makes.
//!
//! `cargo run --release -p moduli-hand --example transferred_hands -- [every n-th transfer] [poses]`
#![allow(clippy::print_stdout)]

use std::error::Error;

use grasp::{Contact, Convention, GraspModel, Workspace, epsilon};
use hand::{
    ClosingRules, CollisionObject, Hand, HandGrasp, HandState, ImproveParams, PoseSampling,
    ReachOutcome, ReachParams, Reacher, SynthesisParams, carried_pose, schunk_sdh, synthesize,
};
use nalgebra::Point3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;
use record::LibraryRecord;
use shape::{AnyField, RadialField, RadialShape};
use space::Continuation;
use space::point::contacts_on;
use space::transfer::{Job, Transfer, TransferEnd, all_pairs};
use sph::Coefficients;

type Failure = Box<dyn Error + Send + Sync>;

const LIBRARY: &[u8] = fixtures::LIBRARY;
const BEST: usize = 10;
const LEAST_QUALITY: f64 = 0.01;
const SEED: u64 = 2014;

/// What became of one transfer.
struct Row {
    to: usize,
    naive: f64,
    /// After the transfer and its ascent, whatever hand there is.
    free: f64,
    made: Option<Made>,
}

struct Made {
    within_tolerance: bool,
    quality: f64,
}

struct Study {
    hand: Hand,
    convention: Convention,
    surfaces: Vec<AnyField>,
    grasps: Vec<Vec<HandGrasp>>,
}

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1).map(|a| a.parse::<usize>());
    let every = arguments.next().transpose()?.unwrap_or(1).max(1);
    let poses = arguments.next().transpose()?.unwrap_or(1400);
    let library = LibraryRecord::from_bytes(LIBRARY)?;
    let study = Study::new(&library, poses)?;
    let counts: Vec<usize> = study.grasps.iter().map(Vec::len).collect();
    let jobs: Vec<Job> = all_pairs(&counts).into_iter().step_by(every).collect();
    let objects = study
        .surfaces
        .iter()
        .map(CollisionObject::new)
        .collect::<Result<Vec<_>, _>>()?;
    let reachers: Vec<Reacher> = objects
        .iter()
        .map(|o| Reacher::new(o, &study.hand))
        .collect();
    let rows = jobs
        .par_iter()
        .map(|job| study.carry(job, &reachers[job.to]))
        .collect::<Result<Vec<Row>, _>>()?;
    println!(
        "to                          transfers  reached  improved  none  with a hand     naive Q  free Q  hand's Q"
    );
    for (k, entry) in library.entries.iter().enumerate() {
        let name = format!("{} {}", entry.id, entry.name);
        print_row(&name, rows.iter().filter(|r| r.to == k));
    }
    print_row("all", rows.iter());
    Ok(())
}

impl Study {
    /// The surfaces of the library and the best hand grasps on each.
    fn new(library: &LibraryRecord, poses: usize) -> Result<Self, Failure> {
        let hand = schunk_sdh()?;
        let convention = Convention::named("paper")?;
        let params = SynthesisParams {
            tips: hand.tip_model(),
            poses,
            sampling: PoseSampling::of_hand(&hand),
            rules: ClosingRules::default(),
            convention: convention.clone(),
            centre: Point3::origin(),
            least_quality: LEAST_QUALITY,
        };
        let found = library
            .entries
            .par_iter()
            .map(|entry| {
                let beta = Coefficients::new(entry.shape.coefficients.clone())?;
                let shape = RadialShape::new(beta)?;
                let mut rng = ChaCha8Rng::seed_from_u64(SEED);
                let mut grasps = synthesize(&shape, &hand, &params, &mut rng)?.grasps;
                grasps.truncate(BEST);
                Ok((RadialField::new(shape).into(), grasps))
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        let (surfaces, grasps) = found.into_iter().unzip();
        Ok(Study {
            hand,
            convention,
            surfaces,
            grasps,
        })
    }

    fn quality(&self, contacts: &[Contact]) -> Result<f64, Failure> {
        let centre = Point3::origin();
        let model = GraspModel::new(contacts, &centre, &self.convention);
        let found = epsilon(&model, &mut Workspace::new())?;
        Ok(found.value(&self.convention))
    }

    /// Carries one grasp and looks for a hand on the target.
    fn carry(&self, job: &Job, reacher: &Reacher<'_>) -> Result<Row, Failure> {
        let (from, to) = (&self.surfaces[job.from], &self.surfaces[job.to]);
        let source = &self.grasps[job.from][job.grasp];
        let end = |surface| TransferEnd {
            surface,
            object_origin: Point3::origin(),
        };
        let transfer = Transfer::new(end(from), end(to), &self.convention);
        let arrived = Continuation::default().carry(&transfer, &source.directions)?;
        let naive = transfer.naive(&source.directions)?.quality;
        let wanted = contacts_on(to, &arrived.directions);
        let known = HandState {
            object_from_palm: carried_pose(&source.object_from_palm, &source.contacts, &wanted),
            joints: source.joints.clone(),
        };
        Ok(Row {
            to: job.to,
            naive,
            free: arrived.quality,
            made: self.make(job, reacher, &wanted, &known, naive)?,
        })
    }

    /// A hand at the wanted contacts, or the best near them that counts.
    fn make(
        &self,
        job: &Job,
        reacher: &Reacher<'_>,
        wanted: &[Contact],
        known: &HandState,
        naive: f64,
    ) -> Result<Option<Made>, Failure> {
        let params = ReachParams::default();
        let improve = ImproveParams {
            tips: self.hand.tip_model(),
            trials: 40,
            spread: 4e-3,
            convention: self.convention.clone(),
            centre: Point3::origin(),
        };
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        rng.set_stream(((job.from * 12 + job.to) * BEST + job.grasp) as u64);
        let known = std::slice::from_ref(known);
        let near = match reacher.reach(wanted, &params, known, &mut rng) {
            ReachOutcome::Reached(found) => {
                return Ok(Some(Made {
                    within_tolerance: true,
                    quality: self.quality(&found.contacts)?,
                }));
            }
            ReachOutcome::Near(near) => near,
            ReachOutcome::Nothing { .. } | ReachOutcome::WrongCount { .. } => return Ok(None),
        };
        let found = reacher.improve(wanted, near, &params, &improve, &mut rng)?;
        let counts = found.quality >= naive.max(LEAST_QUALITY);
        Ok(counts.then_some(Made {
            within_tolerance: false,
            quality: found.quality,
        }))
    }
}

fn print_row<'a>(name: &str, rows: impl Iterator<Item = &'a Row>) {
    let rows: Vec<&Row> = rows.collect();
    let count = rows.len().max(1) as f64;
    let mean = |value: &dyn Fn(&Row) -> f64| rows.iter().map(|r| value(r)).sum::<f64>() / count;
    let made: Vec<&Made> = rows.iter().filter_map(|r| r.made.as_ref()).collect();
    let reached = made.iter().filter(|m| m.within_tolerance).count();
    let hand = made.iter().map(|m| m.quality).sum::<f64>() / made.len().max(1) as f64;
    println!(
        "{name:27} {:9} {reached:8} {:9} {:5} {:10.1} % {:11.3} {:7.3} {hand:9.3}",
        rows.len(),
        made.len() - reached,
        rows.len() - made.len(),
        100.0 * made.len() as f64 / count,
        mean(&|r| r.naive),
        mean(&|r| r.free),
    );
}
