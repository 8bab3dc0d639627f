//! Fig. 4 and Sec. IV-A: the space of shapes, with spheres and deformations in it.

use catalogue::{ScanNoise, sphere_radii, sphere_scan};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use shape::embedding::{Embedding, classical_scaling};
use shape::{PointCloud, RadialShape, algebra};
use sph::Coefficients;

use crate::error::ExperimentError;
use crate::figures;
use crate::output::Findings;
use crate::paper;
use crate::pipeline::{FittedObject, FittedSet, fitted_objects};
use crate::run::{Purpose, Run, generator};
use crate::table::{Table, millimetres, number, per_cent};

/// What is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Number of spheres.
    pub spheres: usize,
    /// Points of each sphere's cloud.
    pub sphere_points: usize,
    /// Equal steps of a deformation.
    pub deformation_steps: usize,
}

impl Plan {
    /// The plan of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            spheres: run.scale.pick(10, paper::SPHERES),
            sphere_points: run.scale.pick(5_000, paper::CLOUD_POINTS),
            deformation_steps: 10,
        }
    }
}

/// One point of the shape space with its place in the pictures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// What it is: an object's id, "sphere 30.0 mm", "S5→S1 at 0.10".
    pub label: String,
    /// "object", "sphere" or "deformation".
    pub kind: &'static str,
    /// Coordinates of the three-dimensional scaling, metres; the first two are the plane's.
    pub coordinates: Vec<f64>,
}

/// How near a shape is to the straight way between two others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Passing {
    /// The shape.
    pub id: String,
    /// Start of the way.
    pub from: String,
    /// End of the way.
    pub to: String,
    /// Where on the way it is nearest, 0 at the start and 1 at the end.
    pub t: f64,
    /// Distance from that point of the way, metres.
    pub distance_m: f64,
    /// That distance over the distance from the nearer end.
    pub distance_over_nearer_end: f64,
    /// Whether there the way is nearer to this shape than to any other object, its ends included.
    pub nearest_object_there: bool,
}

/// How the spheres lie in the shape space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SphereLine {
    /// Radii, metres.
    pub radii_m: Vec<f64>,
    /// Largest distance of a sphere from the line through the first and the last, over its length.
    pub bend: f64,
    /// Objects by distance from the line, nearest first: id, distance (m), radius of the sphere there (m).
    pub objects_by_distance: Vec<(String, f64, f64)>,
}

/// The numbers behind Fig. 4.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeSpace {
    /// Ids in the order of the table.
    pub ids: Vec<String>,
    /// d(f_i, f_j) = ‖β_i − β_j‖, metres.
    pub distances_m: Vec<Vec<f64>>,
    /// How S7 and S8 lie to the four deformations.
    pub passings: Vec<Passing>,
    /// The spheres.
    pub spheres: Option<SphereLine>,
    /// Share of the squared distances that two and three dimensions keep.
    pub explained: [f64; 2],
    /// All points with their coordinates.
    pub places: Vec<Place>,
}

/// Runs the section.
pub fn run(run: &Run) -> Result<Findings, ExperimentError> {
    let set = fitted_objects(run, None, 2)?;
    let ours = measure(run, &Plan::of(run), &set)?;
    Ok(Findings {
        objects: set.describe(),
        paper: json!({
            "objects": paper::OBJECTS,
            "spheres": paper::SPHERES,
            "sphere_radii_m": paper::SPHERE_RADII,
            "deformed_from": paper::DEFORMED_FROM,
            "deformed_to": paper::DEFORMED_TO,
            "passed_by_deformations": paper::PASSED_BY_DEFORMATIONS,
            "passed_by_spheres": paper::PASSED_BY_SPHERES,
        }),
        table: table(&ours),
        ours: serde_json::to_value(&ours)?,
        figures: figures::shape_space::figures(&set, &ours),
    })
}

/// Builds the space and measures it.
pub fn measure(run: &Run, plan: &Plan, set: &FittedSet) -> Result<ShapeSpace, ExperimentError> {
    run.say(&format!("fitting {} spheres", plan.spheres));
    let spheres = fit_spheres(run, plan)?;
    let ways = deformations(set, plan.deformation_steps)?;
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

fn fit_spheres(run: &Run, plan: &Plan) -> Result<Vec<(f64, RadialShape)>, ExperimentError> {
    let (smallest, largest) = paper::SPHERE_RADII;
    sphere_radii(plan.spheres, smallest, largest)
        .into_par_iter()
        .enumerate()
        .map(|(number, radius)| {
            let mut rng = generator(run.seed, Purpose::Spheres, number);
            let noise = ScanNoise::default();
            let cloud = PointCloud::new(sphere_scan(radius, plan.sphere_points, &noise, &mut rng))?;
            let fit = shape::fit::fit(&cloud, &run.fit).map_err(|source| ExperimentError::Fit {
                id: format!("sphere {number}"),
                source,
            })?;
            Ok((radius, fit.shape))
        })
        .collect()
}

/// The ends of the paper's deformations that exist in the set.
fn ways(set: &FittedSet) -> Vec<(&FittedObject, &FittedObject)> {
    let Some(from) = set.get(paper::DEFORMED_FROM) else {
        return Vec::new();
    };
    let to = paper::DEFORMED_TO.iter().filter_map(|&k| set.get(k));
    to.map(|to| (from, to)).collect()
}

/// Shapes strictly between the ends of every way.
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

/// Share of Σ|eigenvalue| in the first few dimensions.
fn explained(embedding: &Embedding, dimensions: usize) -> f64 {
    let sum = |values: &[f64]| values.iter().map(|v| v.abs()).sum::<f64>();
    let all = &embedding.eigenvalues;
    sum(&all[..dimensions.min(all.len())]) / sum(all)
}

/// Where the line through two coefficient vectors is nearest to a third: the parameter.
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

fn passing(
    set: &FittedSet,
    shape: &FittedObject,
    from: &FittedObject,
    to: &FittedObject,
) -> Passing {
    let beta = |o: &FittedObject| o.shape().coefficients().clone();
    let (here, start, end) = (beta(shape), beta(from), beta(to));
    let t = foot(&here, &start, &end).clamp(0.0, 1.0);
    let there = point_between(&start, &end, t);
    let distance = there.distance(&here);
    let nearer = |o: &FittedObject| beta(o).distance(&there) < distance;
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

fn table(ours: &ShapeSpace) -> Table {
    let mut table = Table::new(
        "Sec. IV-A: which shapes the deformations pass (paper: S7 and S8)",
        &[
            "shape",
            "way",
            "at t",
            "distance mm",
            "of nearer end",
            "nearest there",
        ],
    );
    for p in &ours.passings {
        table.row([
            p.id.clone(),
            format!("{}→{}", p.from, p.to),
            number(Some(p.t), 2),
            millimetres(Some(p.distance_m), 1),
            per_cent(Some(p.distance_over_nearer_end)),
            if p.nearest_object_there { "yes" } else { "no" }.into(),
        ]);
    }
    if let Some(line) = &ours.spheres {
        let nearest: Vec<String> = line
            .objects_by_distance
            .iter()
            .take(3)
            .map(|(id, d, r)| format!("{id} {:.1} mm at radius {:.1} mm", 1e3 * d, 1e3 * r))
            .collect();
        table.note(format!(
            "{} spheres bend by {} of their line; nearest to it (paper: S11 and S12): {}",
            line.radii_m.len(),
            per_cent(Some(line.bend)),
            nearest.join(", "),
        ));
    }
    table.note(format!(
        "MDS of {} shapes keeps {} of the squared distances in 2 dimensions, {} in 3",
        ours.places.len(),
        per_cent(Some(ours.explained[0])),
        per_cent(Some(ours.explained[1])),
    ));
    table
}
