//! `moduli ascend`: raises the quality of grasps on their object.

use std::time::Instant;

use moduli::Object;
use space::point::contacts_on;
use space::{AscentError, Constraints, MonotoneAscent, Objective, PaperAscent, Step};
use sph::Direction;

use crate::args::{AscendOptions, AscentScheme, Common};
use crate::failure::Failure;
use crate::moved::{Given, Moved, TraceStep, given};
use crate::movement::Movement;
use crate::{input, limits};

pub(crate) fn run(options: &AscendOptions, common: &Common) -> Result<(), Failure> {
    let convention = input::convention(&options.moved.convention)?;
    let object = input::object(&options.shape)?;
    let (grasps, warnings) = given(&object, &options.grasps)?;
    let measure = object
        .measure(&convention)
        .map_err(|e| Failure::usage(e.to_string()))?;
    let objective = measure.objective();
    let mut constraints = limits::constraints(&options.limits, &objective)?;
    constraints.closed_holes = object.field().closed_patches().to_vec();
    if options.scheme == AscentScheme::Paper && !constraints.is_empty() {
        return Err(Failure::usage(
            "--scheme paper supports neither limits nor surfaces that close holes; use --scheme ours",
        ));
    }
    let movement = Movement {
        doing: "climbing",
        scheme: match options.scheme {
            AscentScheme::Ours => "ours",
            AscentScheme::Paper => "paper",
        },
        measure: &measure,
        warnings,
        start: Instant::now(),
    };
    movement.run(&grasps, &options.moved, common, |i, start| {
        climb(options, &object, start, &objective, &constraints).map_err(|e| failed(options, i, &e))
    })
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
    given: &Given,
    objective: &Objective,
    constraints: &Constraints,
) -> Result<Moved, AscentError> {
    let mut objective = objective.clone();
    let mut steps = Vec::new();
    let keep = |step: &Step| {
        if options.moved.trace.is_some() {
            let contacts = points(object, step.directions);
            steps.push(TraceStep::new(1.0, step, contacts));
        }
    };
    let (surface, start) = (object.field(), &given.directions);
    let ascent = match options.scheme {
        AscentScheme::Ours => MonotoneAscent::default().climb_within(
            surface,
            start,
            &mut objective,
            constraints,
            keep,
        )?,
        AscentScheme::Paper => PaperAscent::PAPER.climb(surface, start, &mut objective, keep)?,
    };
    Ok(Moved {
        reason: (ascent.quality <= 0.0)
            .then(|| format!("open; {:.4} from force closure", -ascent.margin)),
        directions: ascent.directions,
        start_quality: ascent.start_quality,
        quality: ascent.quality,
        evaluations: ascent.evaluations,
        stationarity: Some(ascent.stationarity),
        source: given.source.clone(),
        steps,
    })
}

/// Points of the surface in the frame of the cloud.
fn points(object: &Object, directions: &[Direction]) -> Vec<[f64; 3]> {
    let on = contacts_on(object.field(), directions);
    on.iter()
        .map(|c| object.frame().to_cloud(&c.position).into())
        .collect()
}
