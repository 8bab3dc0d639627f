//! Fig. 2 and Sec. III-B: surfaces from a cloud with all eigenspaces up to degree L.

use nalgebra::Point3;
use rand::RngExt;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use shape::fit::PENALTY_POWER;
use shape::point_cloud::RadialSamples;
use shape::{PointCloud, RadialShape, Surface};
use sph::direction::even_directions;
use sph::regression::{Gram, Penalty, RegressionError, Samples};
use sph::{Coefficients, batch, index};

use crate::error::ExperimentError;
use crate::figures;
use crate::objects::{ObjectCloud, Objects};
use crate::output::Findings;
use crate::paper;
use crate::run::{Purpose, Run, generator};
use crate::statistics::root_mean_square;
use crate::table::{Table, millimetres};

/// What is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Numbers of the objects; all when absent.
    pub objects: Option<Vec<usize>>,
    /// The degrees L.
    pub degrees: Vec<usize>,
    /// Directions in which surfaces are compared with the true ones.
    pub truth_directions: usize,
}

impl Plan {
    /// The plan of a run.
    pub fn of(run: &Run) -> Self {
        let mut degrees = vec![2, 5, 10, 20, 30, paper::DEGREE];
        degrees.extend(run.scale.pick(None, Some(paper::DETAILED_DEGREE)));
        Self {
            objects: run.scale.pick(Some(vec![5, 6, paper::CLOUD_OBJECT]), None),
            degrees,
            truth_directions: 2_000,
        }
    }
}

/// How well one fit does. Lengths in metres.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reconstruction {
    /// The object.
    pub id: String,
    /// L.
    pub degree: usize,
    /// (L+1)².
    pub coefficients: usize,
    /// λ; 0 for plain least squares, as in the paper.
    pub lambda: f64,
    /// Whether λ was chosen from the data.
    pub penalised: bool,
    /// Root mean square of the residuals at the points.
    pub rms_m: f64,
    /// Largest residual.
    pub max_abs_m: f64,
    /// Root mean square residual at the half of the points that another fit did not see.
    pub held_out_rms_m: Option<f64>,
    /// Root mean square distance of the surface from the true one, where that is known.
    pub true_rms_m: Option<f64>,
    /// Whether the surface is proved to be in M^rad.
    pub in_m_rad: bool,
}

/// A fit with its surface, where that is in M^rad.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// How well it does.
    pub record: Reconstruction,
    /// The surface, seen from the mean of the cloud.
    pub shape: Option<RadialShape>,
}

/// Runs the section.
pub fn run(run: &Run) -> Result<Findings, ExperimentError> {
    let plan = Plan::of(run);
    let mut objects = Objects::load(&run.objects, run.seed)?.only(run.only)?;
    if let (Some(numbers), true) = (&plan.objects, run.only.is_empty()) {
        objects = objects.select(numbers);
    }
    let fits = measure(run, &plan, &objects.clouds)?;
    let ours: Vec<&Reconstruction> = fits.iter().map(|f| &f.record).collect();
    let described: Vec<_> = objects
        .clouds
        .iter()
        .map(|o| json!({ "number": o.number, "id": o.id, "name": o.name, "points": o.cloud.points().len() }))
        .collect();
    Ok(Findings {
        objects: json!({
            "source": objects.source.to_string(),
            "fitted": described,
            "refused": objects.refused,
        }),
        paper: json!({
            "object": format!("S{}", paper::CLOUD_OBJECT),
            "points": paper::CLOUD_POINTS,
            "degree": paper::DEGREE,
            "degree_for_minute_details": paper::DETAILED_DEGREE,
            "finding": "as L is increased, more and more detail about the surface is captured",
        }),
        table: table(&objects, &ours),
        ours: json!({ "fits": ours }),
        figures: figures::reconstruction::figures(&objects.clouds, &fits),
    })
}

/// All fits of all objects, plain and penalised.
pub fn measure(
    run: &Run,
    plan: &Plan,
    objects: &[ObjectCloud],
) -> Result<Vec<Fitted>, ExperimentError> {
    let mut all = Vec::new();
    for object in objects {
        run.say(&format!(
            "fitting {} at degrees {:?}",
            object.id, plan.degrees
        ));
        let halves = halves(object, run.seed)?;
        let fits = plan
            .degrees
            .par_iter()
            .map(|&degree| fits_at(object, &halves, degree, plan.truth_directions))
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
        // Too few points determine nothing without a penalty; that fit is left out.
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

/// The normal equations of a cloud at one degree, with what they were made of.
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

    /// β and λ; none where the points do not determine β.
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

/// Distance of a fitted surface from the true one, over directions even on the sphere.
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

fn table(objects: &Objects, fits: &[&Reconstruction]) -> Table {
    let mut table = Table::new(
        "Fig. 2: error against L, in mm: plain least squares (as the paper) | with the penalty",
        &[
            "object",
            "L",
            "rms",
            "held out",
            "from truth",
            "M^rad",
            "rms",
            "held out",
            "from truth",
            "M^rad",
        ],
    );
    for object in &objects.clouds {
        let mut degrees: Vec<usize> = fits.iter().map(|f| f.degree).collect();
        degrees.sort_unstable();
        degrees.dedup();
        for degree in degrees {
            let of = |penalised| {
                let fit = fits
                    .iter()
                    .find(|f| f.id == object.id && f.degree == degree && f.penalised == penalised);
                cells(fit.copied())
            };
            let head = vec![object.id.clone(), degree.to_string()];
            table.rows.push([head, of(false), of(true)].concat());
        }
    }
    table.note("The paper shows pictures and no numbers here.");
    table
}

fn cells(fit: Option<&Reconstruction>) -> Vec<String> {
    let yes_no = fit.map_or("–", |f| if f.in_m_rad { "yes" } else { "no" });
    vec![
        millimetres(fit.map(|f| f.rms_m), 3),
        millimetres(fit.and_then(|f| f.held_out_rms_m), 3),
        millimetres(fit.and_then(|f| f.true_rms_m), 3),
        yes_no.to_owned(),
    ]
}
