//! `moduli ascend`: grasps on an object, made better.

use std::time::Instant;

use moduli::point::contacts_on;
use moduli::{AscentError, Cap, Constraints, MonotoneAscent, Objective, PaperAscent, Step};
use nalgebra::Vector3;
use rayon::prelude::*;
use shape::RadialField;
use sph::Direction;

use crate::args::{AscendOptions, AscentScheme, Common};
use crate::failure::Failure;
use crate::placed::{Delivery, Moved, Object, Placed, TraceStep, deliver};
use crate::{input, output};

/// The paper's ascent (Sec. IV-D).
pub(crate) const PAPER_ASCENT: PaperAscent = PaperAscent {
    steps: 1000,
    delta: 1e-5,
    rate: 0.01,
};

pub(crate) fn run(options: &AscendOptions, common: &Common) -> Result<(), Failure> {
    let convention = input::convention(&options.convention)?;
    let object = Object::read(&options.shape)?;
    let grasps = object.grasps(&options.grasps)?;
    let objective = Objective::new(&convention, &object.surface, &object.origin());
    let constraints = constraints(options, &objective)?;
    let start = Instant::now();
    let bar = output::progress(common.quiet, grasps.len(), "climbing");
    let moved = grasps
        .par_iter()
        .enumerate()
        .map(|(i, placed)| {
            let moved = climb(options, &object, placed, &objective, &constraints)
                .map_err(|e| failed(options, i, &e))?;
            bar.inc(1);
            Ok(moved)
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    bar.finish_and_clear();
    let how = Delivery {
        scheme: match options.scheme {
            AscentScheme::Ours => "ours",
            AscentScheme::Paper => "paper",
        },
        output: options.output.as_deref(),
        trace: options.trace.as_deref(),
        json: common.json,
        seconds: start.elapsed().as_secs_f64(),
    };
    deliver(&object, &objective, &moved, &how)
}

fn failed(options: &AscendOptions, index: usize, error: &AscentError) -> Failure {
    match error {
        AscentError::Quality(e) => Failure::input(&options.grasps, format!("grasp {index}: {e}")),
        AscentError::Constraints(e) => Failure::refused(format!(
            "{}: grasp {index}: {e}; loosen the limits or leave the grasp out",
            options.grasps.display()
        )),
    }
}

fn climb(
    options: &AscendOptions,
    object: &Object,
    placed: &Placed,
    objective: &Objective,
    constraints: &Constraints,
) -> Result<Moved, AscentError> {
    let mut objective = objective.clone();
    let mut steps = Vec::new();
    let centre = object.record.centre_in_cloud().coords;
    let keep = |step: &Step| {
        if options.trace.is_some() {
            let contacts = points(&object.surface, step.contacts, &centre);
            steps.push(TraceStep::new(1.0, step, contacts));
        }
    };
    let (surface, start) = (&object.surface, &placed.directions);
    let ascent = match options.scheme {
        AscentScheme::Ours => MonotoneAscent::default().climb_within(
            surface,
            start,
            &mut objective,
            constraints,
            keep,
        )?,
        AscentScheme::Paper => PAPER_ASCENT.climb(surface, start, &mut objective, keep)?,
    };
    Ok(Moved {
        reason: (ascent.quality <= 0.0)
            .then(|| format!("open; {:.4} from force closure", -ascent.margin)),
        directions: ascent.contacts,
        start_quality: ascent.start_quality,
        quality: ascent.quality,
        evaluations: ascent.evaluations,
        stationarity: Some(ascent.stationarity),
        source: placed.source.clone(),
        steps,
    })
}

fn points(surface: &RadialField, contacts: &[Direction], centre: &Vector3<f64>) -> Vec<[f64; 3]> {
    contacts_on(surface, contacts)
        .iter()
        .map(|c| (c.position + centre).into())
        .collect()
}

fn constraints(options: &AscendOptions, objective: &Objective) -> Result<Constraints, Failure> {
    let constraints = Constraints {
        least_separation: options.least_separation,
        reach: options.reach,
        caps: options
            .allow
            .iter()
            .map(|text| cap(text))
            .collect::<Result<_, _>>()?,
        closed_under: options
            .closed_at_friction
            .map(|friction| objective.with_friction(friction)),
    };
    constraints
        .validate()
        .map_err(|e| Failure::usage(e.to_string()))?;
    if let Some(second) = &constraints.closed_under {
        second
            .convention()
            .validate()
            .map_err(|e| Failure::usage(format!("--closed-at-friction: {e}")))?;
    }
    if options.scheme == AscentScheme::Paper && !constraints.is_empty() {
        return Err(Failure::usage(
            "the paper's ascent knows no limits; use --scheme ours",
        ));
    }
    Ok(constraints)
}

/// X,Y,Z,DEGREES.
fn cap(text: &str) -> Result<Cap, Failure> {
    let numbers: Vec<f64> = text
        .split(',')
        .filter_map(|cell| cell.trim().parse().ok())
        .collect();
    if let [x, y, z, degrees] = numbers[..]
        && text.split(',').count() == 4
        && let Some(axis) = Direction::try_new(Vector3::new(x, y, z), 1e-12)
        && (0.0..=180.0).contains(&degrees)
        && axis.iter().all(|v| v.is_finite())
    {
        return Ok(Cap {
            axis,
            least_cosine: degrees.to_radians().cos(),
        });
    }
    Err(Failure::usage(format!(
        "--allow {text}: expected X,Y,Z,DEGREES with a direction and an angle from 0 to 180"
    )))
}
