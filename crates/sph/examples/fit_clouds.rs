//! Fits clouds of raw little-endian f64 triples seen from their origin, and says how long it took.
//!
//! Arguments: degree, `plain` or `automatic` or `robust`, runs, then files. A line a file: name, median
//! seconds, root mean square residual, log₁₀ of the penalty a sample.
#![allow(clippy::print_stdout, reason = "a program that prints its result")]

use std::error::Error;
use std::time::Instant;

use nalgebra::Vector3;
use sph::Direction;
use sph::regression::{Fitted, Penalty, Robust, Samples, Settings, fit};
use sph::scattered::Scattered;

fn load(file: &str) -> Result<(Vec<Direction>, Vec<f64>), Box<dyn Error>> {
    let bytes = std::fs::read(file)?;
    let numbers: Vec<f64> = bytes
        .as_chunks::<8>()
        .0
        .iter()
        .map(|c| f64::from_le_bytes(*c))
        .collect();
    let points = numbers.as_chunks::<3>().0.iter().map(|c| Vector3::from(*c));
    let seen = points.filter_map(|v| sph::direction::direction_and_radius(&v));
    Ok(seen.unzip())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [degree, mode, runs, files @ ..] = arguments.as_slice() else {
        return Err("arguments: degree, mode, runs, files".into());
    };
    let settings = Settings {
        penalty: (mode == "plain").then_some(Penalty::NONE),
        robust: (mode == "robust").then(Robust::default),
        ..Settings::of_degree(degree.parse()?)
    };
    for file in files {
        let (directions, values) = load(file)?;
        let samples = Samples {
            directions: &directions,
            values: &values,
        };
        let mut seconds = Vec::new();
        let mut last: Option<Fitted> = None;
        for _ in 0..runs.parse::<usize>()?.max(1) {
            let start = Instant::now();
            last = Some(fit(samples, &settings)?);
            seconds.push(start.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        let fitted = last.ok_or("no run")?;
        let squares: f64 = Scattered::new(&directions)
            .evaluate(&fitted.coefficients)
            .iter()
            .zip(&values)
            .map(|(h, f)| (h - f).powi(2))
            .sum();
        println!(
            "{file} {:.6} {:.9} {:.2} {}",
            seconds[seconds.len() / 2],
            (squares / values.len() as f64).sqrt(),
            (fitted.penalty.lambda / values.len() as f64).log10(),
            fitted.rounds
        );
    }
    Ok(())
}
