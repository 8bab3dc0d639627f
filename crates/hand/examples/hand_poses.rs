//! What becomes of 1,400 poses of the SDH on each object, and how long they take on one thread.
//!
//! `cargo run --release -p moduli-hand --example hand_poses -- [scan.ply …]`; without scans, on
//! the twelve objects of the built-in library.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::time::Instant;

use grasp::Convention;
use hand::{
    ClosingRules, CollisionObject, Hand, PoseSampling, SynthesisParams, schunk_sdh, synthesize,
};
use nalgebra::Point3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use record::LibraryRecord;
use shape::{FitSettings, PointCloud, RadialShape};
use space::Objective;
use sph::Coefficients;

const LIBRARY: &[u8] = fixtures::LIBRARY;
const POSES: usize = 1400;

fn main() -> Result<(), Box<dyn Error>> {
    let hand = schunk_sdh()?;
    let convention = Convention::named("paper")?;
    println!(
        "object                      stable unstable | base near, starts in, part near, tip missed, parts near, no contact | seconds"
    );
    let scans: Vec<String> = std::env::args().skip(1).collect();
    if scans.is_empty() {
        for entry in &LibraryRecord::from_bytes(LIBRARY)?.entries {
            let name = format!("{} {}", entry.id, entry.name);
            let beta = Coefficients::new(entry.shape.coefficients.clone())?;
            row(&name, &RadialShape::new(beta)?, &hand, &convention)?;
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
        match shape::fit::fit(&PointCloud::new(points.points)?, &settings) {
            Ok(fit) => row(&name, &fit.shape, &hand, &convention)?,
            Err(error) => println!("{name:27} refused: {error}"),
        }
    }
    Ok(())
}

fn row(
    name: &str,
    surface: &RadialShape,
    hand: &Hand,
    convention: &Convention,
) -> Result<(), Box<dyn Error>> {
    let objective = Objective::new(convention, surface, &Point3::origin());
    let params = SynthesisParams {
        tips: hand.tip_model(),
        poses: POSES,
        sampling: PoseSampling::of_hand(hand),
        rules: ClosingRules::default(),
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
