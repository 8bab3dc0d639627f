//! `moduli info`: describes a file.

use std::path::Path;

use moduli::Object;
use moduli::records::stored_shape;
use record::{
    GraspsFile, GraspsFileError, Kind, LibraryObjectRecord, LibraryRecord, ShapeRecord,
    SphericalRecord,
};
use serde_json::{Map, Value, json};
use shape::SphericalShape;
use shape::io::{Geometry, Loaded, Warning};

use crate::args::{Common, InfoOptions};
use crate::failure::Failure;
use crate::{input, output};

/// One line for people, and the same for programs.
struct Fact {
    line: String,
    /// An object; its keys join those of the other facts.
    values: Value,
}

fn fact(line: String, values: Value) -> Fact {
    Fact { line, values }
}

pub(crate) fn run(options: &InfoOptions, common: &Common) -> Result<(), Failure> {
    let facts = facts(&options.file)?;
    if !common.json {
        facts.iter().for_each(|fact| output::say(&fact.line));
        return Ok(());
    }
    let keys = facts.into_iter().filter_map(|fact| match fact.values {
        Value::Object(keys) => Some(keys),
        _ => None,
    });
    output::say_json(&keys.flatten().collect::<Map<String, Value>>())
}

fn facts(path: &Path) -> Result<Vec<Fact>, Failure> {
    let bytes = input::read(path)?;
    let refused = |e: &dyn std::fmt::Display| Failure::input(path, e);
    match record::envelope::kind_of(&bytes) {
        Some(Kind::Shape) => {
            let record = ShapeRecord::from_bytes(&bytes).map_err(|e| refused(&e))?;
            shape_facts(&record).map_err(|e| refused(&e))
        }
        Some(Kind::Spherical) => {
            let record = SphericalRecord::from_bytes(&bytes).map_err(|e| refused(&e))?;
            let object = Object::from_spherical_record(&record).map_err(|e| refused(&e))?;
            Ok(object
                .shape()
                .spherical()
                .map_or_else(Vec::new, |s| spherical_facts(&object, s)))
        }
        Some(Kind::Library) => {
            let record = LibraryRecord::from_bytes(&bytes).map_err(|e| refused(&e))?;
            Ok(library_facts(&record))
        }
        Some(Kind::LibraryObject) => {
            let record = LibraryObjectRecord::from_bytes(&bytes).map_err(|e| refused(&e))?;
            Ok(library_facts(&record.library))
        }
        None => match GraspsFile::from_json(&bytes) {
            Ok(file) => Ok(grasps_facts(&file)),
            // A cloud, a mesh, or something unknown, which the reader of clouds names.
            Err(GraspsFileError::Json(_)) if path.extension().is_none_or(|x| x != "json") => {
                Ok(loaded_facts(&input::loaded(path, &bytes)?))
            }
            Err(e) => Err(refused(&e)),
        },
    }
}

fn shape_facts(record: &ShapeRecord) -> Result<Vec<Fact>, moduli::records::StoredShapeError> {
    let shape = stored_shape(record)?;
    let (low, high) = shape.tight_radius_bounds(1e-3);
    // Rounded outward, so that the printed bounds are proved too.
    let (low_mm, high_mm) = ((1e6 * low).floor() / 1e3, (1e6 * high).ceil() / 1e3);
    let volume = shape.mass_properties().volume;
    let (rms, lambda) = (record.rms_m, record.lambda);
    let centre = record.centre_in_cloud_m;
    Ok(vec![
        fact(
            format!("shape       {}", record.name.escape_debug()),
            json!({ "kind": "shape", "model": "radial", "name": record.name }),
        ),
        fact(
            format!("degree      {}", shape.degree()),
            json!({ "degree": shape.degree() }),
        ),
        fact(
            format!("certified   {low_mm:.3} mm ≤ r ≤ {high_mm:.3} mm"),
            json!({ "r_min_certified_m": low, "r_max_certified_m": high }),
        ),
        fact(
            format!(
                "fit         {} points, rms {:.3} mm, λ {lambda:.3e}",
                record.points,
                1e3 * rms
            ),
            json!({ "points": record.points, "rms_m": rms, "lambda": lambda }),
        ),
        fact(
            format!("volume      {:.2} cm³", 1e6 * volume),
            json!({ "volume_m3": volume }),
        ),
        fact(
            format!("centre      {centre:?} m in the frame of the cloud"),
            json!({ "centre_m": centre }),
        ),
    ])
}

fn spherical_facts(object: &Object, shape: &SphericalShape) -> Vec<Fact> {
    let immersion = shape.immersion();
    let report = object.report();
    let [x, y, z] = report.lambda_xyz.unwrap_or_default();
    let rms = report.rms;
    let volume = shape.mass_properties().volume;
    let centre: [f64; 3] = object.frame().centre_in_cloud().into();
    let mut facts = vec![
        fact(
            format!(
                "shape       {}, a map of the sphere",
                object.name().escape_debug()
            ),
            json!({ "kind": "shape", "model": "spherical", "name": object.name() }),
        ),
        fact(
            format!("degree      {}", shape.degree()),
            json!({ "degree": shape.degree() }),
        ),
        fact(
            format!(
                "immersion   proved: area element at least {:.3e} m²; seen {:.3e} to {:.3e} m²",
                immersion.lower, immersion.seen_lower, immersion.seen_upper
            ),
            json!({ "embedding": "immersion", "area_element_min_certified_m2": immersion.lower }),
        ),
        fact(
            format!(
                "fit         {} points, rms {:.3} mm, λ {x:.3e}, {y:.3e}, {z:.3e}",
                report.points,
                1e3 * rms
            ),
            json!({ "points": report.points, "rms_m": rms, "lambda": [x, y, z] }),
        ),
        fact(
            format!("volume      {:.2} cm³", 1e6 * volume),
            json!({ "volume_m3": volume }),
        ),
        fact(
            format!("centre      {centre:?} m in the frame of the cloud"),
            json!({ "centre_m": centre }),
        ),
    ];
    let holes = object.object_record().closed_holes;
    facts.extend(holes.iter().map(|hole| {
        let [x, y, z] = hole.centre_m;
        let line = format!(
            "closed hole {:.1} cm² at ({x:.4}, {y:.4}, {z:.4}) m",
            1e4 * hole.area_m2
        );
        fact(line, Value::Null)
    }));
    facts.push(fact(
        format!("holes       {} closed", holes.len()),
        json!({ "closed_holes": holes }),
    ));
    facts
}

fn library_facts(record: &LibraryRecord) -> Vec<Fact> {
    let entries: Vec<Value> = record
        .entries
        .iter()
        .map(|e| json!({ "id": e.id, "name": e.name, "grasps": e.grasps.len() }))
        .collect();
    let head = fact(
        format!(
            "library     {} objects, hand {}, convention {}, seed {}",
            record.entries.len(),
            record.hand.escape_debug(),
            record.convention.escape_debug(),
            record.seed
        ),
        json!({
            "kind": "library", "hand": record.hand, "convention": record.convention,
            "seed": record.seed, "objects": entries,
        }),
    );
    let lines = record.entries.iter().map(|e| {
        let best = e.grasps.first().map_or(0.0, |g| g.quality);
        let line = format!(
            "{:4} {:24} {:3} grasps, best {best:.3}",
            e.id.escape_debug().to_string(),
            e.name.escape_debug().to_string(),
            e.grasps.len(),
        );
        fact(line, Value::Null)
    });
    std::iter::once(head).chain(lines).collect()
}

fn grasps_facts(file: &GraspsFile) -> Vec<Fact> {
    let (count, name) = (file.grasps.len(), &file.object.name);
    let best = file.grasps.first().map_or(0.0, |g| g.quality);
    vec![
        fact(
            format!("grasps      {count} on {}", name.escape_debug()),
            json!({ "kind": "grasps", "version": file.version, "grasps": count, "object": name }),
        ),
        fact(
            format!("convention  {}", file.convention.name.escape_debug()),
            json!({ "convention": file.convention.name }),
        ),
        fact(format!("best        {best:.4}"), json!({ "best": best })),
    ]
}

fn loaded_facts(loaded: &Loaded) -> Vec<Fact> {
    let (kind, counts) = match &loaded.geometry {
        Geometry::Points(points) => (
            format!("cloud       {} points", points.len()),
            json!({ "kind": "cloud", "points": points.len() }),
        ),
        Geometry::Mesh(mesh) => (
            format!(
                "mesh        {} vertices, {} triangles",
                mesh.vertices.len(),
                mesh.triangles.len()
            ),
            json!({
                "kind": "mesh", "vertices": mesh.vertices.len(), "triangles": mesh.triangles.len(),
            }),
        ),
    };
    let (mut low, mut high) = (loaded.vertices()[0], loaded.vertices()[0]);
    for p in loaded.vertices() {
        (low, high) = (low.inf(p), high.sup(p));
    }
    let size = high - low;
    let format = loaded.format.to_string();
    let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    let mut facts = vec![
        fact(
            format!("{kind}, {} rows dropped, {format}", loaded.dropped),
            counts,
        ),
        fact(
            format!(
                "extent      {:.1} × {:.1} × {:.1} mm, if the unit is metres",
                1e3 * size.x,
                1e3 * size.y,
                1e3 * size.z
            ),
            json!({
                "dropped": loaded.dropped, "format": format, "extent": [size.x, size.y, size.z],
                "warnings": warnings,
            }),
        ),
    ];
    // The first line has the rows that were dropped.
    let others = loaded
        .warnings
        .iter()
        .filter(|w| !matches!(w, Warning::Dropped { .. }));
    facts.extend(others.map(|w| fact(format!("note        {w}"), Value::Null)));
    facts
}
