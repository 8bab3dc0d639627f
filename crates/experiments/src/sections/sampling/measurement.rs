//! Samples of random shapes and grasps.

use std::ops::Range;

use rayon::prelude::*;
use space::sample::perturbed;
use sph::{Coefficients, index};

use super::findings::{DrawnBand, Noise, Settings};
use crate::error::ExperimentError;
use crate::paper;
use crate::pipeline::{FittedScan, FittedSet};
use crate::run::{Purpose, Run, generator};
use crate::statistics::{mean, share};

/// Number of samples drawn in the figure for each band.
const DRAWN: usize = 4;

/// One sample: its change, and whether it is valid and closed.
struct Sample {
    in_m_rad: bool,
    force_closed: bool,
    rms: f64,
    roughness: f64,
    slope: f64,
}

/// Computes all samples.
pub fn measure(
    run: &Run,
    settings: &Settings,
    set: &FittedSet,
) -> Result<Vec<Noise>, ExperimentError> {
    let bands = [
        ("coarse", paper::COARSE_BAND, &settings.coarse_sigmas),
        ("fine", paper::FINE_BAND, &settings.fine_sigmas),
    ];
    let mut all = Vec::new();
    let mut stream = 0;
    for (name, band, sigmas) in bands {
        for &sigma in sigmas {
            run.say(&format!("{name} band, deviation {} mm", 1e3 * sigma));
            let first = stream;
            stream += set.objects.len() * settings.samples;
            let samples = (0..set.objects.len() * settings.samples)
                .into_par_iter()
                .map(|k| {
                    let object = &set.objects[k / settings.samples];
                    draw(run, object, band.clone(), sigma, first + k)
                })
                .collect::<Result<Vec<_>, _>>()?;
            all.push(collect(name, &band, sigma, &samples));
        }
    }
    Ok(all)
}

fn draw(
    run: &Run,
    object: &FittedScan,
    band: Range<usize>,
    sigma: f64,
    stream: usize,
) -> Result<Sample, ExperimentError> {
    let shape = object.shape();
    let mut rng = generator(run.seed, Purpose::Noise, stream);
    // Draw the same noise again, to measure the change of samples outside M^rad as well.
    let beta = shape.coefficients();
    let noisy = shape::noise::perturb_band(beta, band.clone(), sigma, &mut rng.clone());
    let change = Coefficients::combination([(1.0, &noisy), (-1.0, beta)]);
    let (size, slope) = norms(&change);
    let sphere = (4.0 * std::f64::consts::PI).sqrt();
    let mean_radius = beta.get(0, 0) / sphere;
    let point = perturbed(shape, band, sigma, paper::CONTACTS, &mut rng).ok();
    let quality = match &point {
        Some(point) => {
            let origin = object.object.frame().cloud_origin();
            space::Objective::new(&run.convention, &point.surface, &origin)
                .quality_at(&point.surface, &point.directions)?
        }
        None => 0.0,
    };
    Ok(Sample {
        in_m_rad: point.is_some(),
        force_closed: quality > 0.0,
        rms: size / sphere,
        roughness: if size > 0.0 { slope / size } else { 0.0 },
        slope: slope / (sphere * mean_radius),
    })
}

/// ‖β‖ and √(Σ l(l+1) β²), the L² norms of a function and of its gradient.
fn norms(beta: &Coefficients) -> (f64, f64) {
    let (mut values, mut gradients) = (0.0, 0.0);
    for (position, b) in beta.as_slice().iter().enumerate() {
        let l = index::degree_order(position).0;
        values += b * b;
        gradients += (l * (l + 1)) as f64 * b * b;
    }
    (values.sqrt(), gradients.sqrt())
}

fn collect(name: &'static str, band: &Range<usize>, sigma: f64, samples: &[Sample]) -> Noise {
    let inside = samples.iter().filter(|s| s.in_m_rad).count();
    let closed = samples.iter().filter(|s| s.force_closed).count();
    let mean_of = |pick: fn(&Sample) -> f64| mean(&samples.iter().map(pick).collect::<Vec<_>>());
    Noise {
        band: name,
        positions: (band.start, band.end - 1),
        sigma_m: sigma,
        samples: samples.len(),
        in_m_rad: inside,
        share_in_m_rad: share(inside, samples.len()),
        rms_radius_change_m: mean_of(|s| s.rms),
        roughness: mean_of(|s| s.roughness),
        rms_slope_change: mean_of(|s| s.slope),
        share_force_closed: share(closed, inside),
    }
}

/// Samples for the figure: one object, at the smallest standard deviation of each band. Samples
/// outside M^rad are omitted.
pub(super) fn drawn_bands(run: &Run, settings: &Settings, set: &FittedSet) -> Vec<DrawnBand> {
    let Some(object) = set.get(paper::DEFORMED_FROM).or(set.objects.last()) else {
        return Vec::new();
    };
    let bands = [
        (paper::COARSE_BAND, &settings.coarse_sigmas),
        (paper::FINE_BAND, &settings.fine_sigmas),
    ];
    let drawn = bands.into_iter().filter_map(|(band, sigmas)| {
        let sigma = *sigmas.first()?;
        let mut rng = generator(run.seed, Purpose::Drawn, band.start);
        let samples = (0..DRAWN)
            .filter_map(|_| {
                perturbed(
                    object.shape(),
                    band.clone(),
                    sigma,
                    paper::CONTACTS,
                    &mut rng,
                )
                .ok()
            })
            .collect();
        Some(DrawnBand {
            title: format!(
                "{}, noise of {} mm on β_{} … β_{}",
                object.id(),
                1e3 * sigma,
                band.start,
                band.end - 1
            ),
            samples,
        })
    });
    drawn.collect()
}
