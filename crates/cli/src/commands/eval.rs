//! `moduli eval`: evaluates a surface at given directions.

use moduli::Object;
use serde::Serialize;
use shape::{AnyShape, RadialShape, Surface};
use sph::Direction;

use crate::args::{Common, EvalOptions};
use crate::failure::Failure;
use crate::{input, output};

/// Radius, its gradient (3) and the outward normal (3).
const RADIAL: usize = 7;
/// Point (3), outward normal (3), mean curvature and the two principal curvatures.
const SPHERICAL: usize = 9;

#[derive(Serialize)]
struct EvalLine {
    directions: usize,
    model: &'static str,
    radius_min_m: f64,
    radius_max_m: f64,
}

/// Rows of numbers, and the least and the largest distance from the centre.
struct Evaluated {
    columns: usize,
    values: Vec<f64>,
    radii: (f64, f64),
}

pub(crate) fn run(options: &EvalOptions, common: &Common) -> Result<(), Failure> {
    let object = input::object(&options.shape)?;
    let directions = input::directions(&options.directions)?;
    let (model, evaluated) = match object.shape() {
        AnyShape::Radial(shape) => ("radial", radial(shape, &directions)),
        AnyShape::Spherical(_) => ("spherical", spherical(&object, &directions)),
    };
    let bytes = output::npy(evaluated.columns, evaluated.values)?;
    output::write_file(&options.output, &bytes)?;
    let line = EvalLine {
        directions: directions.len(),
        model,
        radius_min_m: evaluated.radii.0,
        radius_max_m: evaluated.radii.1,
    };
    if common.json {
        return output::say_json(&line);
    }
    output::say(format!(
        "{} directions, radius {:.3} to {:.3} mm, written to {}",
        line.directions,
        1e3 * line.radius_min_m,
        1e3 * line.radius_max_m,
        options.output.display()
    ));
    Ok(())
}

fn radial(shape: &RadialShape, directions: &[Direction]) -> Evaluated {
    let mut values = Vec::with_capacity(directions.len() * RADIAL);
    let mut radii = (f64::INFINITY, f64::NEG_INFINITY);
    for p in directions {
        let (radius, gradient) = shape.radius_and_gradient(p);
        let (_, inward) = shape.contact(p);
        values.push(radius);
        values.extend(gradient.iter());
        values.extend((-inward.into_inner()).iter());
        radii = (radii.0.min(radius), radii.1.max(radius));
    }
    Evaluated {
        columns: RADIAL,
        values,
        radii,
    }
}

fn spherical(object: &Object, directions: &[Direction]) -> Evaluated {
    let centre = object.frame().centre_in_cloud();
    let mut values = Vec::with_capacity(directions.len() * SPHERICAL);
    let mut radii = (f64::INFINITY, f64::NEG_INFINITY);
    for p in directions {
        let at = object.at(p);
        values.extend(at.position.iter());
        values.extend(at.outward_normal.iter());
        values.push(at.mean_curvature());
        values.extend(at.principal_curvatures);
        let radius = (at.position - centre).norm();
        radii = (radii.0.min(radius), radii.1.max(radius));
    }
    Evaluated {
        columns: SPHERICAL,
        values,
        radii,
    }
}
