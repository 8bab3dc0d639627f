//! Fits clouds of raw little-endian f64 triples as radii seen from their origin, and times the fits.
//!
//! Arguments: the degree, `plain` (no penalty) or `automatic`, the number of runs, and the files. The
//! output has one line per file: name, median seconds, root mean square residual, log₁₀ of the penalty
//! per sample.
#![allow(clippy::print_stdout, reason = "a program that prints its result")]

use std::error::Error;
use std::time::Instant;

use nalgebra::Vector3;
use sph::regression::{Gram, Method, Penalty, RegressionError, Samples};
use sph::scattered::Scattered;
use sph::{Coefficients, Direction};

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

fn fit(
    samples: Samples,
    degree: usize,
    automatic: bool,
) -> Result<(Coefficients, Penalty), RegressionError> {
    let gram = Gram::new(samples, degree)?;
    let penalty = if automatic {
        gram.choose_penalty(2)?
    } else {
        Penalty::NONE
    };
    let beta = gram.coefficients(samples, penalty, Method::Automatic)?;
    Ok((beta, penalty))
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [degree, mode, runs, files @ ..] = arguments.as_slice() else {
        return Err("arguments: degree, mode, runs, files".into());
    };
    let automatic = match mode.as_str() {
        "plain" => false,
        "automatic" => true,
        other => return Err(format!("mode `{other}`; expected `plain` or `automatic`").into()),
    };
    let degree = degree.parse()?;
    for file in files {
        let (directions, values) = load(file)?;
        let samples = Samples {
            directions: &directions,
            values: &values,
        };
        let mut seconds = Vec::new();
        let mut last = None;
        for _ in 0..runs.parse::<usize>()?.max(1) {
            let start = Instant::now();
            last = Some(fit(samples, degree, automatic)?);
            seconds.push(start.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        let (beta, penalty) = last.ok_or("no run")?;
        let squares: f64 = Scattered::new(&directions)
            .evaluate(&beta)
            .iter()
            .zip(&values)
            .map(|(h, f)| (h - f).powi(2))
            .sum();
        println!(
            "{file} {:.6} {:.9} {:.2}",
            seconds[seconds.len() / 2],
            (squares / values.len() as f64).sqrt(),
            (penalty.lambda / values.len() as f64).log10(),
        );
    }
    Ok(())
}
