//! Fits of every object at every degree, plain and penalised.

use nalgebra::Point3;
use rand::RngExt;
use rayon::prelude::*;
use shape::fit::PENALTY_POWER;
use shape::point_cloud::RadialSamples;
use shape::{PointCloud, RadialShape, Surface};
use sph::direction::even_directions;
use sph::regression::{Gram, Penalty, RegressionError, Samples};
use sph::{Coefficients, batch, index};

use super::findings::{Fitted, Reconstruction, Settings};
use crate::error::ExperimentError;
use crate::objects::ObjectCloud;
use crate::run::{Purpose, Run, generator};
use crate::statistics::root_mean_square;

/// Computes all fits of all objects, plain and penalised.
pub fn measure(
    run: &Run,
    settings: &Settings,
    objects: &[ObjectCloud],
) -> Result<Vec<Fitted>, ExperimentError> {
    let mut all = Vec::new();
    for object in objects {
        run.say(&format!(
            "fitting {} at degrees {:?}",
            object.id, settings.degrees
        ));
        let halves = halves(object, run.seed)?;
        let fits = settings
            .degrees
            .par_iter()
            .map(|&degree| fits_at(object, &halves, degree, settings.truth_directions))
            .collect::<Result<Vec<_>, _>>()?;
        all.extend(fits.into_iter().flatten());
    }
    Ok(all)
}

/// A random half of a cloud and the rest.
fn halves(object: &ObjectCloud, seed: u64) -> Result<[PointCloud; 2], ExperimentError> {
    let mut rng = generator(seed, Purpose::Halves, object.number);
    let (seen, held_out): (Vec<Point3<f64>>, Vec<Point3<f64>>) = object
        .cloud
        .points()
        .iter()
        .partition(|_| rng.random::<bool>());
    Ok([PointCloud::new(seen)?, PointCloud::new(held_out)?])
}

fn fits_at(
    object: &ObjectCloud,
    halves: &[PointCloud; 2],
    degree: usize,
    truth_directions: usize,
) -> Result<Vec<Fitted>, ExperimentError> {
    let centre = object.cloud.mean();
    let samples = object.cloud.seen_from(&centre);
    let [seen, held_out] = [&halves[0], &halves[1]].map(|half| half.seen_from(&centre));
    let whole = System::new(&samples, degree)?;
    let half = System::new(&seen, degree)?;
    let mut fits = Vec::new();
    for penalised in [false, true] {
        // Without a penalty too few points do not determine β; that fit is omitted.
        let Some((beta, lambda)) = whole.solve(penalised)? else {
            continue;
        };
        let held_out_rms_m = half
            .solve(penalised)?
            .map(|(beta, _)| root_mean_square(residuals(&beta, &held_out)));
        let errors = residuals(&beta, &samples);
        let shape = RadialShape::new(beta).ok();
        let distance = |shape| true_distance(object, shape, &centre, truth_directions);
        let record = Reconstruction {
            id: object.id.clone(),
            degree,
            coefficients: index::count(degree),
            lambda,
            penalised,
            max_abs_m: errors.iter().fold(0.0, |worst, e| e.abs().max(worst)),
            rms_m: root_mean_square(errors),
            held_out_rms_m,
            true_rms_m: shape.as_ref().and_then(distance),
            in_m_rad: shape.is_some(),
        };
        fits.push(Fitted { record, shape });
    }
    Ok(fits)
}

/// The normal equations of a cloud at one degree, and the samples.
struct System<'a> {
    samples: Samples<'a>,
    gram: Gram,
}

impl<'a> System<'a> {
    fn new(seen: &'a RadialSamples, degree: usize) -> Result<Self, RegressionError> {
        let samples = Samples {
            directions: &seen.directions,
            values: &seen.radii,
        };
        Ok(Self {
            samples,
            gram: Gram::new(samples, degree)?,
        })
    }

    /// β and λ; `None` if the points do not determine β.
    fn solve(&self, penalised: bool) -> Result<Option<(Coefficients, f64)>, RegressionError> {
        let penalty = if penalised {
            self.gram.choose_penalty(PENALTY_POWER)?
        } else {
            Penalty {
                lambda: 0.0,
                power: PENALTY_POWER,
            }
        };
        match self.gram.solve(self.samples, penalty) {
            Ok(solution) => Ok(Some((solution.coefficients, penalty.lambda))),
            Err(RegressionError::RankDeficient { .. }) => Ok(None),
            Err(other) => Err(other),
        }
    }
}

fn residuals(beta: &Coefficients, samples: &RadialSamples) -> Vec<f64> {
    batch::evaluate(beta, &samples.directions)
        .iter()
        .zip(&samples.radii)
        .map(|(fitted, radius)| fitted - radius)
        .collect()
}

/// Distances of a fitted surface from the true one, over directions spread evenly on the sphere.
fn true_distance(
    object: &ObjectCloud,
    shape: &RadialShape,
    centre: &Point3<f64>,
    directions: usize,
) -> Option<f64> {
    let truth = object.truth?;
    let distances = even_directions(directions)
        .into_iter()
        .map(|p| truth.signed_distance(&(shape.point(&p) + centre.coords)));
    Some(root_mean_square(distances))
}
