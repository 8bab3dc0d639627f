//! Fig. 5 and Sec. IV-B: random shapes and grasps, by Gaussian noise on a band of coefficients.

use std::ops::Range;

use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use space::sample::perturbed;
use sph::{Coefficients, index};

use crate::error::ExperimentError;
use crate::figures::{self, sampling::DrawnBand};
use crate::output::Findings;
use crate::paper;
use crate::pipeline::{FittedObject, FittedSet, fitted_objects};
use crate::run::{Purpose, Run, generator};
use crate::statistics::{mean, share};
use crate::table::{Table, millimetres, number, per_cent};

/// Samples drawn of each band.
const DRAWN: usize = 4;

/// What is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Samples of each object, band and deviation.
    pub samples: usize,
    /// Standard deviations on the coarse band, metres.
    pub coarse_sigmas: Vec<f64>,
    /// Standard deviations on the fine band, metres.
    pub fine_sigmas: Vec<f64>,
}

impl Plan {
    /// The plan of a run.
    ///
    /// The paper states no deviation. These change the radius by 2 to 18 mm (coarse) and 1 to 11 mm
    /// (fine) in the root mean square, from barely visible to beyond what its pictures show.
    pub fn of(run: &Run) -> Self {
        Self {
            samples: run.scale.pick(4, 100),
            coarse_sigmas: run
                .scale
                .pick(vec![0.005, 0.02], vec![0.0025, 0.005, 0.01, 0.02]),
            fine_sigmas: run
                .scale
                .pick(vec![0.001, 0.004], vec![0.0005, 0.001, 0.002, 0.004]),
        }
    }
}

/// What noise of one deviation on one band does, over all objects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// "coarse" or "fine".
    pub band: &'static str,
    /// First and last position of the band.
    pub positions: (usize, usize),
    /// Standard deviation on each coefficient, metres.
    pub sigma_m: f64,
    /// Samples drawn.
    pub samples: usize,
    /// Samples proved to be in M^rad.
    pub in_m_rad: usize,
    /// Their share.
    pub share_in_m_rad: Option<f64>,
    /// Mean of the root mean square change of the radius over the sphere, ‖δβ‖/√(4π), metres.
    pub rms_radius_change_m: Option<f64>,
    /// Mean of √(Σ l(l+1) δβ²)/‖δβ‖: how many waves the change has around the sphere, over 2π.
    pub roughness: Option<f64>,
    /// Mean of the root mean square slope of the change, √(Σ l(l+1) δβ²/4π) over the mean radius.
    pub rms_slope_change: Option<f64>,
    /// Share of the samples' three random contacts that are force-closed.
    pub share_force_closed: Option<f64>,
}

/// One sample: how it differs, and what it is.
struct Sample {
    in_m_rad: bool,
    force_closed: bool,
    rms: f64,
    roughness: f64,
    slope: f64,
}

/// Runs the section.
pub fn run(run: &Run) -> Result<Findings, ExperimentError> {
    let set = fitted_objects(run, None, 1)?;
    let plan = Plan::of(run);
    let ours = measure(run, &plan, &set)?;
    let inclusive = |band: Range<usize>| (band.start, band.end - 1);
    Ok(Findings {
        objects: set.describe(),
        paper: json!({
            "coarse_positions": inclusive(paper::COARSE_BAND),
            "fine_positions": inclusive(paper::FINE_BAND),
            "sigma_m": null,
            "contacts": paper::CONTACTS,
            "finding": "the first coefficients are large-scale properties, the later ones higher frequencies",
        }),
        table: table(&ours),
        ours: json!({ "noise": ours }),
        figures: figures::sampling::figures(&drawn_bands(run, &plan, &set)),
    })
}

/// Draws all samples.
pub fn measure(run: &Run, plan: &Plan, set: &FittedSet) -> Result<Vec<Noise>, ExperimentError> {
    let bands = [
        ("coarse", paper::COARSE_BAND, &plan.coarse_sigmas),
        ("fine", paper::FINE_BAND, &plan.fine_sigmas),
    ];
    let mut all = Vec::new();
    let mut stream = 0;
    for (name, band, sigmas) in bands {
        for &sigma in sigmas {
            run.say(&format!("{name} band, deviation {} mm", 1e3 * sigma));
            let first = stream;
            stream += set.objects.len() * plan.samples;
            let samples = (0..set.objects.len() * plan.samples)
                .into_par_iter()
                .map(|k| {
                    let object = &set.objects[k / plan.samples];
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
    object: &FittedObject,
    band: Range<usize>,
    sigma: f64,
    stream: usize,
) -> Result<Sample, ExperimentError> {
    let shape = object.shape();
    let mut rng = generator(run.seed, Purpose::Noise, stream);
    // The same numbers once more, to see the change of samples that leave M^rad too.
    let beta = shape.coefficients();
    let noisy = shape::noise::perturb_band(beta, band.clone(), sigma, &mut rng.clone());
    let change = Coefficients::combination([(1.0, &noisy), (-1.0, beta)]);
    let (size, slope) = norms(&change);
    let sphere = (4.0 * std::f64::consts::PI).sqrt();
    let mean_radius = beta.get(0, 0) / sphere;
    let point = perturbed(shape, band, sigma, paper::CONTACTS, &mut rng).ok();
    let quality = match &point {
        Some(point) => {
            let origin = object.object_origin();
            space::Objective::new(&run.convention, &point.surface, &origin)
                .quality_at(&point.surface, &point.contacts)?
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

/// Samples of one object at the least deviation of each band, to be drawn; those that leave M^rad
/// are passed over.
fn drawn_bands(run: &Run, plan: &Plan, set: &FittedSet) -> Vec<DrawnBand> {
    let Some(object) = set.get(paper::DEFORMED_FROM).or(set.objects.last()) else {
        return Vec::new();
    };
    let bands = [
        (paper::COARSE_BAND, &plan.coarse_sigmas),
        (paper::FINE_BAND, &plan.fine_sigmas),
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

fn table(noise: &[Noise]) -> Table {
    let mut table = Table::new(
        "Sec. IV-B: noise on β_0…β_9 (coarse) and β_499…β_599 (fine)",
        &[
            "band",
            "σ mm",
            "samples",
            "in M^rad",
            "rms change mm",
            "waves",
            "rms slope",
            "force-closed",
        ],
    );
    for n in noise {
        table.row([
            n.band.into(),
            millimetres(Some(n.sigma_m), 1),
            n.samples.to_string(),
            per_cent(n.share_in_m_rad),
            millimetres(n.rms_radius_change_m, 2),
            number(n.roughness, 1),
            number(n.rms_slope_change, 3),
            per_cent(n.share_force_closed),
        ]);
    }
    table.note("The paper shows pictures, states no deviation and no numbers here.");
    table
}
