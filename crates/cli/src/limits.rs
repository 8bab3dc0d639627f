//! Limits of a grasp from the command line.

use nalgebra::Vector3;
use space::{Cap, Constraints, Objective};
use sph::Direction;

use crate::args::LimitOptions;
use crate::failure::Failure;

/// The limits that the options name; `objective` is that of the object whose grasps are held.
pub(crate) fn constraints(
    options: &LimitOptions,
    objective: &Objective,
) -> Result<Constraints, Failure> {
    let constraints = Constraints {
        least_separation: metres("--separation", options.separation)?,
        largest_separation: metres("--reach", options.reach)?,
        caps: options
            .allow
            .iter()
            .map(|text| cap(text))
            .collect::<Result<_, _>>()?,
        closed_holes: Vec::new(),
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
    Ok(constraints)
}

/// Millimetres of an option as metres.
fn metres(name: &str, millimetres: Option<f64>) -> Result<Option<f64>, Failure> {
    match millimetres {
        Some(value) if !(value.is_finite() && value >= 0.0) => Err(Failure::usage(format!(
            "{name} {value}: expected a length in millimetres, at least 0"
        ))),
        _ => Ok(millimetres.map(|value| 1e-3 * value)),
    }
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
