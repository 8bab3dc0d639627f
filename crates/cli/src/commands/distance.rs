//! `moduli distance`: distances between surfaces in the space of shapes.

use moduli::{Library, Object};
use serde::Serialize;

use crate::args::{Common, DistanceOptions};
use crate::failure::Failure;
use crate::{input, output};

#[derive(Serialize)]
struct DistanceLine {
    a: String,
    b: String,
    distance_m: f64,
}

pub(crate) fn run(options: &DistanceOptions, common: &Common) -> Result<(), Failure> {
    let mut shapes = Vec::new();
    for path in &options.shapes {
        let object = input::object(path)?;
        shapes.push((object.name().to_owned(), object.field().clone()));
    }
    if shapes.len() == 1 {
        let records = Library::builtin().records().map_err(Failure::library)?;
        for entry in records.iter().flat_map(|record| &record.entries) {
            let object = Object::from_record(&entry.shape)
                .map_err(|e| Failure::other(format!("{}: {e}", entry.id)))?;
            shapes.push((
                format!("{} {}", entry.id, entry.name),
                object.field().clone(),
            ));
        }
    }
    let anchors = if options.shapes.len() == 1 {
        1
    } else {
        shapes.len()
    };
    for (i, (a, field_a)) in shapes[..anchors].iter().enumerate() {
        for (b, field_b) in &shapes[i + 1..] {
            let line = DistanceLine {
                a: a.clone(),
                b: b.clone(),
                distance_m: space::distance_of(field_a, field_b),
            };
            if common.json {
                output::say_json(&line)?;
            } else {
                output::say(format!(
                    "{:24} {:32} {:9.3} mm",
                    line.a,
                    line.b,
                    1e3 * line.distance_m
                ));
            }
        }
    }
    Ok(())
}
