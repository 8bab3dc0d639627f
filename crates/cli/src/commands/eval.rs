//! `moduli eval`: a shape at given directions.

use nalgebra::Vector3;
use serde::Serialize;
use shape::Surface;
use sph::Direction;

use crate::args::{Common, EvalOptions};
use crate::failure::Failure;
use crate::{input, output};

/// Radius, its gradient (3) and the outward normal (3).
const COLUMNS: usize = 7;

#[derive(Serialize)]
struct EvalLine {
    directions: usize,
    radius_min_m: f64,
    radius_max_m: f64,
}

pub(crate) fn run(options: &EvalOptions, common: &Common) -> Result<(), Failure> {
    let object = input::object(&options.shape)?;
    let shape = object.shape();
    let table = input::table(&options.directions, 3)?;
    let mut values = Vec::with_capacity(table.row_count() * COLUMNS);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (row, v) in table.rows().enumerate() {
        let v = Vector3::new(v[0], v[1], v[2]);
        let length = v.norm();
        if !((length - 1.0).abs() <= 1e-6) {
            return Err(Failure::input(
                &options.directions,
                format!("row {row} has length {length}; expected a unit vector"),
            ));
        }
        let p = Direction::new_unchecked(v / length);
        let (radius, gradient) = shape.radius_and_gradient(&p);
        let (_, inward) = shape.contact(&p);
        values.push(radius);
        values.extend(gradient.iter());
        values.extend((-inward.into_inner()).iter());
        low = low.min(radius);
        high = high.max(radius);
    }
    output::write_file(&options.output, &output::npy(COLUMNS, values)?)?;
    let line = EvalLine {
        directions: table.row_count(),
        radius_min_m: low,
        radius_max_m: high,
    };
    if common.json {
        return output::say_json(&line);
    }
    output::say(format!(
        "{} directions, radius {:.3} to {:.3} mm, written to {}",
        line.directions,
        1e3 * low,
        1e3 * high,
        options.output.display()
    ));
    Ok(())
}
