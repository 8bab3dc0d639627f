//! Distances, deformations and spheres in the space of shapes.

use catalogue::{ScanNoise, sphere_radii, sphere_scan};
use rayon::prelude::*;
use shape::embedding::{Embedding, classical_scaling};
use shape::{PointCloud, RadialShape, algebra};
use sph::Coefficients;

use super::findings::{Passing, Place, Settings, ShapeSpace, SphereLine};
use crate::error::ExperimentError;
use crate::paper;
use crate::pipeline::{FittedScan, FittedSet};
use crate::run::{Purpose, Run, generator};

/// Computes the shape space and its findings.
pub fn measure(
    run: &Run,
    settings: &Settings,
    set: &FittedSet,
) -> Result<ShapeSpace, ExperimentError> {
    run.say(&format!("fitting {} spheres", settings.spheres));
    let spheres = fit_spheres(run, settings)?;
    let ways = deformations(set, settings.deformation_steps)?;
    let objects = set
        .objects
        .iter()
        .map(|o| (o.id().to_owned(), "object", o.shape()));
    let round = spheres
        .iter()
        .map(|(radius, shape)| (format!("sphere {:.1} mm", 1e3 * radius), "sphere", shape));
    let between = ways
        .iter()
        .map(|(label, shape)| (label.clone(), "deformation", shape));
    let all: Vec<_> = objects.chain(round).chain(between).collect();
    let shapes: Vec<&RadialShape> = all.iter().map(|(_, _, shape)| *shape).collect();
    run.say(&format!("scaling {} shapes", shapes.len()));
    let embedding = classical_scaling(&distances(&shapes), 3);
    let places = all
        .iter()
        .zip(&embedding.coordinates)
        .map(|((label, kind, _), coordinates)| Place {
            label: label.clone(),
            kind,
            coordinates: coordinates.clone(),
        })
        .collect();
    Ok(ShapeSpace {
        ids: set.objects.iter().map(|o| o.id().to_owned()).collect(),
        distances_m: distances(&shapes[..set.objects.len()]),
        passings: passings(set),
        spheres: sphere_line(&spheres, set),
        explained: [2, 3].map(|dimensions| explained(&embedding, dimensions)),
        places,
    })
}

fn fit_spheres(run: &Run, settings: &Settings) -> Result<Vec<(f64, RadialShape)>, ExperimentError> {
    let (smallest, largest) = paper::SPHERE_RADII;
    sphere_radii(settings.spheres, smallest, largest)
        .into_par_iter()
        .enumerate()
        .map(|(number, radius)| {
            let mut rng = generator(run.seed, Purpose::Spheres, number);
            let noise = ScanNoise::default();
            let cloud = PointCloud::new(sphere_scan(
                radius,
                settings.sphere_points,
                &noise,
                &mut rng,
            ))?;
            let fit = shape::fit::fit(&cloud, &run.fit).map_err(|source| ExperimentError::Fit {
                id: format!("sphere {number}"),
                source,
            })?;
            Ok((radius, fit.shape))
        })
        .collect()
}

/// The ends of those of the paper's deformations that exist in the set.
fn ways(set: &FittedSet) -> Vec<(&FittedScan, &FittedScan)> {
    let Some(from) = set.get(paper::DEFORMED_FROM) else {
        return Vec::new();
    };
    let to = paper::DEFORMED_TO.iter().filter_map(|&k| set.get(k));
    to.map(|to| (from, to)).collect()
}

/// Shapes strictly between the ends of every deformation.
fn deformations(
    set: &FittedSet,
    steps: usize,
) -> Result<Vec<(String, RadialShape)>, ExperimentError> {
    let mut shapes = Vec::new();
    for (from, to) in ways(set) {
        for step in 1..steps {
            let t = step as f64 / steps as f64;
            let label = format!("{}→{} at {t:.2}", from.id(), to.id());
            shapes.push((label, algebra::deformation(from.shape(), to.shape(), t)?));
        }
    }
    Ok(shapes)
}

fn distances(shapes: &[&RadialShape]) -> Vec<Vec<f64>> {
    let row = |a: &&RadialShape| shapes.iter().map(|b| algebra::distance(a, b)).collect();
    shapes.par_iter().map(row).collect()
}

/// Share of Σ|eigenvalue| of the first dimensions.
fn explained(embedding: &Embedding, dimensions: usize) -> f64 {
    let sum = |values: &[f64]| values.iter().map(|v| v.abs()).sum::<f64>();
    let all = &embedding.eigenvalues;
    sum(&all[..dimensions.min(all.len())]) / sum(all)
}

/// Parameter of the point of the line through two coefficient vectors that is nearest to a third.
fn foot(beta: &Coefficients, from: &Coefficients, to: &Coefficients) -> f64 {
    let along = Coefficients::combination([(1.0, to), (-1.0, from)]);
    let towards = Coefficients::combination([(1.0, beta), (-1.0, from)]);
    let dot = |a: &Coefficients, b: &Coefficients| -> f64 {
        a.as_slice()
            .iter()
            .zip(b.as_slice())
            .map(|(x, y)| x * y)
            .sum()
    };
    dot(&along, &towards) / dot(&along, &along)
}

fn point_between(from: &Coefficients, to: &Coefficients, t: f64) -> Coefficients {
    Coefficients::combination([(1.0 - t, from), (t, to)])
}

fn passings(set: &FittedSet) -> Vec<Passing> {
    let passed = paper::PASSED_BY_DEFORMATIONS
        .iter()
        .filter_map(|&k| set.get(k));
    passed
        .flat_map(|shape| ways(set).into_iter().map(move |way| (shape, way)))
        .map(|(shape, (from, to))| passing(set, shape, from, to))
        .collect()
}

fn passing(set: &FittedSet, shape: &FittedScan, from: &FittedScan, to: &FittedScan) -> Passing {
    let beta = |o: &FittedScan| o.shape().coefficients().clone();
    let (here, start, end) = (beta(shape), beta(from), beta(to));
    let t = foot(&here, &start, &end).clamp(0.0, 1.0);
    let there = point_between(&start, &end, t);
    let distance = there.distance(&here);
    let nearer = |o: &FittedScan| beta(o).distance(&there) < distance;
    Passing {
        id: shape.id().to_owned(),
        from: from.id().to_owned(),
        to: to.id().to_owned(),
        t,
        distance_m: distance,
        distance_over_nearer_end: distance / here.distance(&start).min(here.distance(&end)),
        nearest_object_there: !set.objects.iter().any(nearer),
    }
}

fn sphere_line(spheres: &[(f64, RadialShape)], set: &FittedSet) -> Option<SphereLine> {
    let (first, last) = (spheres.first()?, spheres.last()?);
    let (start, end) = (first.1.coefficients(), last.1.coefficients());
    let length = start.distance(end);
    let from_line = |beta: &Coefficients| {
        let t = foot(beta, start, end);
        (point_between(start, end, t).distance(beta), t)
    };
    let bend = spheres
        .iter()
        .map(|(_, shape)| from_line(shape.coefficients()).0)
        .fold(0.0, f64::max);
    let mut objects_by_distance: Vec<(String, f64, f64)> = set
        .objects
        .iter()
        .map(|o| {
            let (distance, t) = from_line(o.shape().coefficients());
            (
                o.id().to_owned(),
                distance,
                first.0 + t * (last.0 - first.0),
            )
        })
        .collect();
    objects_by_distance.sort_by(|a, b| a.1.total_cmp(&b.1));
    (length > 0.0).then(|| SphereLine {
        radii_m: spheres.iter().map(|(radius, _)| *radius).collect(),
        bend: bend / length,
        objects_by_distance,
    })
}
