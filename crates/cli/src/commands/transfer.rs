//! `moduli transfer`: grasps on one object, carried to another.

mod matrix;

use std::path::Path;
use std::time::Instant;

use grasp::Convention;
use moduli::Object;
use nalgebra::Point3;
use record::grasps::SourceRecord;
use shape::Surface;
use shape::closed_patch::patch_at;
use space::{
    Constraints, Continuation, Objective, PaperTransfer, Step, Transfer, TransferEnd,
    TransferError, Transferred, distance_of,
};
use sph::Direction;

use crate::args::{Common, TransferOptions, TransferScheme};
use crate::failure::Failure;
use crate::moved::{Given, Moved, TraceStep, given};
use crate::movement::Movement;
use crate::output::warn;
use crate::{input, limits};

/// The scheme of the transfer.
enum Scheme {
    Ours(Continuation, Box<Constraints>),
    Paper,
    Naive,
}

pub(crate) fn run(options: &TransferOptions, common: &Common) -> Result<(), Failure> {
    match (&options.from[..], &options.to[..], &options.grasps[..]) {
        ([from], [to], [grasps]) => one_pair(from, to, grasps, options, common),
        _ => matrix::run(options, common),
    }
}

fn one_pair(
    from: &Path,
    to: &Path,
    path: &Path,
    options: &TransferOptions,
    common: &Common,
) -> Result<(), Failure> {
    let convention = input::convention(&options.moved.convention)?;
    let (from, to) = (input::object(from)?, input::object(to)?);
    let (grasps, mut warnings) = given(&from, path)?;
    let transfer = between(&from, &to, &convention);
    for warning in crossings(&transfer, &to).map_err(|e| Failure::other(e.to_string()))? {
        warn(&warning);
        warnings.push(warning);
    }
    let start = Instant::now();
    let measure = to
        .measure(&convention)
        .map_err(|e| Failure::usage(e.to_string()))?;
    let scheme = prepare(options, &measure.objective())?;
    let origin = Origin::new(&from, &to);
    let movement = Movement {
        doing: "transferring",
        scheme: scheme_name(options),
        measure: &measure,
        warnings,
        start,
    };
    movement.run(&grasps, &options.moved, common, |i, placed| {
        carry(options, &scheme, &transfer, &to, placed, &origin).map_err(|e| failed(path, i, &e))
    })
}

/// The stations of the deformation that cut or fold themselves, a sentence each.
fn crossings(transfer: &Transfer, to: &Object) -> Result<Vec<String>, TransferError> {
    let found = transfer.crossing_stations(Continuation::default().intervals)?;
    let sentence = |(t, place): (f64, Point3<f64>)| {
        let x = to.frame().to_cloud(&place);
        format!(
            "the shape between the two objects at t = {t:.2} cuts or folds itself, around ({:.4}, {:.4}, {:.4}) m in the frame of the target; contacts pass it as it is",
            x.x, x.y, x.z
        )
    };
    Ok(found.into_iter().map(sentence).collect())
}

/// Whether a contact lies on a part of the surface that closes a hole.
fn on_closed_hole(object: &Object, directions: &[Direction]) -> bool {
    let patches = object.field().closed_patches();
    let on = |p: &Direction| patch_at(patches, &object.field().point(p)).is_some();
    !patches.is_empty() && directions.iter().any(on)
}

fn failed(path: &Path, index: usize, error: &TransferError) -> Failure {
    match error {
        TransferError::Constraints(e) => Failure::refused(format!(
            "{}: grasp {index}: {e}; loosen the limits or leave the grasp out",
            path.display()
        )),
        other => Failure::input(path, format!("grasp {index}: {other}")),
    }
}

fn scheme_name(options: &TransferOptions) -> &'static str {
    match options.scheme {
        TransferScheme::Ours => "ours",
        TransferScheme::Paper => "paper",
        TransferScheme::Naive => "naive",
    }
}

/// The pair of objects, each with the origin of its own cloud's frame.
fn between<'a>(from: &'a Object, to: &'a Object, convention: &'a Convention) -> Transfer<'a> {
    let end = |object: &'a Object| TransferEnd {
        surface: object.field(),
        object_origin: object.frame().cloud_origin(),
    };
    Transfer::new(end(from), end(to), convention)
}

/// The scheme that the options ask for; `objective` is that of the target.
fn prepare(options: &TransferOptions, objective: &Objective) -> Result<Scheme, Failure> {
    let constraints = limits::constraints(&options.limits, objective)?;
    if options.scheme != TransferScheme::Ours && !constraints.is_empty() {
        return Err(Failure::usage("only --scheme ours supports limits"));
    }
    Ok(match options.scheme {
        TransferScheme::Ours => {
            let scheme = if options.thorough {
                Continuation::thorough()
            } else {
                Continuation::default()
            };
            Scheme::Ours(scheme, Box::new(constraints))
        }
        TransferScheme::Paper => Scheme::Paper,
        TransferScheme::Naive => Scheme::Naive,
    })
}

/// Where the grasps come from: the name of the object and the distance of its shape, metres.
struct Origin {
    name: String,
    distance: f64,
}

impl Origin {
    fn new(from: &Object, to: &Object) -> Self {
        Self {
            name: from.name().to_owned(),
            distance: distance_of(from.field(), to.field()),
        }
    }
}

fn carry(
    options: &TransferOptions,
    scheme: &Scheme,
    transfer: &Transfer,
    to: &Object,
    given: &Given,
    origin: &Origin,
) -> Result<Moved, TransferError> {
    let mut steps = Vec::new();
    let keep = |t: f64, step: &Step| {
        if options.moved.trace.is_some() {
            steps.push(TraceStep::new(t, step, points(transfer, to, t, step)));
        }
    };
    let start = &given.directions;
    let end: Transferred = match scheme {
        Scheme::Ours(scheme, constraints) => {
            scheme.carry_traced(transfer, start, constraints, keep)?
        }
        Scheme::Paper => PaperTransfer::PAPER.carry_traced(transfer, start, keep)?,
        Scheme::Naive => transfer.naive(start)?,
    };
    let on_hole = on_closed_hole(to, &end.directions);
    let hole = on_hole.then(|| "a contact lies where a hole of the object was closed".to_owned());
    Ok(Moved {
        reason: hole.or_else(|| end.open.map(|open| open.to_string())),
        directions: end.directions,
        start_quality: end.start_quality,
        quality: if on_hole { 0.0 } else { end.quality },
        evaluations: end.evaluations,
        stationarity: end.stationarity,
        source: SourceRecord::Transfer {
            from: Some(origin.name.clone()),
            shape_distance_m: Some(origin.distance),
            source_quality: Some(end.start_quality),
        },
        steps,
    })
}

/// Contacts on γ(t) = (1−t) f₁ + t f₂, in the frame of the target's cloud.
fn points(transfer: &Transfer, to: &Object, t: f64, step: &Step) -> Vec<[f64; 3]> {
    let between = |p| {
        let [from, to] = transfer.ends_of(p);
        Point3::from(from.coords * (1.0 - t) + to.coords * t)
    };
    step.directions
        .iter()
        .map(|p| to.frame().to_cloud(&between(p)).into())
        .collect()
}
