//! What becomes of 1,400 poses of a hand on each object, and how long they take on one thread.
//!
//! `RAYON_NUM_THREADS=1 cargo run --release -p moduli-hand --example hand_poses -- [HAND] [scan.ply …]`:
//! HAND is a built-in hand, the SDH by default. Scans stand on the lowest point along z; without scans
//! the objects are the twelve of the built-in library, which stand on nothing.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::time::Instant;

use grasp::Convention;
use hand::{
    ClosingRules, CollisionObject, Hand, PoseSampling, Rejection, SynthesisParams, schunk_sdh,
    synthesize,
};
use nalgebra::{Point3, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use record::LibraryRecord;
use shape::{FitSettings, PointCloud, RadialShape, Support};
use space::Objective;
use sph::Coefficients;

const LIBRARY: &[u8] = fixtures::LIBRARY;
const POSES: usize = 1400;

fn main() -> Result<(), Box<dyn Error>> {
    let mut scans: Vec<String> = std::env::args().skip(1).collect();
    let named = scans.first().and_then(|name| Hand::built_in(name));
    let hand = match named {
        Some(hand) => {
            scans.remove(0);
            hand?
        }
        None => schunk_sdh()?,
    };
    let convention = Convention::named("paper")?;
    println!(
        "object                      stable unstable | {} | seconds",
        Rejection::REASONS.join(", ")
    );
    if scans.is_empty() {
        for entry in &LibraryRecord::from_bytes(LIBRARY)?.entries {
            let name = format!("{} {}", entry.id, entry.name);
            let beta = Coefficients::new(entry.shape.coefficients.clone())?;
            row(&name, &RadialShape::new(beta)?, None, &hand, &convention)?;
        }
    }
    for path in &scans {
        let points = shape::io::read_ply(&std::fs::read(path)?)?;
        let settings = FitSettings {
            degree: 50,
            lambda: None,
        };
        let stem = std::path::Path::new(path).file_stem().unwrap_or_default();
        let name = stem.to_string_lossy();
        let cloud = PointCloud::new(points.points)?;
        match shape::fit::fit(&cloud, &settings) {
            Ok(fit) => {
                let lowest = cloud.points().iter().map(|p| p.z - fit.centre_in_cloud.z);
                let support = Support {
                    normal: Vector3::z_axis(),
                    offset_m: lowest.fold(f64::INFINITY, f64::min),
                };
                row(&name, &fit.shape, Some(support), &hand, &convention)?;
            }
            Err(error) => println!("{name:27} refused: {error}"),
        }
    }
    Ok(())
}

fn row(
    name: &str,
    surface: &RadialShape,
    support: Option<Support>,
    hand: &Hand,
    convention: &Convention,
) -> Result<(), Box<dyn Error>> {
    let rules = ClosingRules {
        support,
        ..ClosingRules::default()
    };
    let objective = Objective::new(convention, surface, &Point3::origin());
    let params = SynthesisParams {
        tips: hand.tip_model(),
        poses: POSES,
        sampling: PoseSampling {
            support: support.map(|s| (s, rules.support_clearance)),
            ..PoseSampling::of_hand(hand)
        },
        rules,
        convention: objective.convention().clone(),
        centre: objective.centre(),
        least_quality: 0.01,
    };
    if let Err(error) = CollisionObject::new(surface) {
        println!("{name:27} refused: {error}");
        return Ok(());
    }
    let start = Instant::now();
    let run = synthesize(surface, hand, &params, &mut ChaCha8Rng::seed_from_u64(2014))?;
    let seconds = start.elapsed().as_secs_f64();
    let reasons: Vec<String> = run
        .outcomes
        .by_reason()
        .iter()
        .map(|(_, count)| format!("{count:9}"))
        .collect();
    println!(
        "{name:27} {:6} {:8} | {} | {seconds:.2}",
        run.outcomes.stable,
        run.outcomes.unstable,
        reasons.join(", ")
    );
    Ok(())
}
