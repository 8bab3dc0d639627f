//! `moduli info`: describes a file.

use moduli::SphericalObject;
use moduli::records::{StoredShapeError, stored_shape};
use record::{
    GraspsFile, GraspsFileError, Kind, LibraryRecord, ShapeRecord, SphericalRecord, envelope,
};

use shape::io::{Geometry, Loaded};

use crate::args::InfoOptions;
use crate::failure::Failure;
use crate::{input, output};

pub(crate) fn run(options: &InfoOptions) -> Result<(), Failure> {
    let path = &options.file;
    let bytes = input::read(path)?;
    let lines = match envelope::kind_of(&bytes) {
        Some(Kind::Shape) => {
            let record = ShapeRecord::from_bytes(&bytes).map_err(|e| Failure::input(path, e))?;
            shape_lines(&record).map_err(|e| Failure::input(path, e))?
        }
        Some(Kind::Spherical) => {
            let record =
                SphericalRecord::from_bytes(&bytes).map_err(|e| Failure::input(path, e))?;
            let object =
                SphericalObject::from_record(&record).map_err(|e| Failure::input(path, e))?;
            spherical_lines(&object)
        }
        Some(Kind::Library) => {
            let record = LibraryRecord::from_bytes(&bytes).map_err(|e| Failure::input(path, e))?;
            library_lines(&record)
        }
        None => match GraspsFile::from_json(&bytes) {
            Ok(file) => grasps_lines(&file),
            Err(e @ (GraspsFileError::Version { .. } | GraspsFileError::Lengths { .. })) => {
                return Err(Failure::input(path, e));
            }
            Err(GraspsFileError::Json(_)) => {
                let loaded = input::load(path)?;
                loaded_lines(&loaded)
            }
        },
    };
    lines.iter().for_each(output::say);
    Ok(())
}

fn shape_lines(record: &ShapeRecord) -> Result<Vec<String>, StoredShapeError> {
    let shape = stored_shape(record)?;
    let (low, high) = shape.tight_radius_bounds(1e-3);
    // Rounded outward: what is printed is proved as well.
    let (low, high) = ((1e6 * low).floor() / 1e3, (1e6 * high).ceil() / 1e3);
    let mass = shape.mass_properties();
    Ok(vec![
        format!("shape       {}", record.name.escape_debug()),
        format!("degree      {}", shape.degree()),
        format!("certified   {low:.3} mm ≤ r ≤ {high:.3} mm"),
        format!(
            "fit         {} points, rms {:.3} mm, λ {:.3e}",
            record.points,
            1e3 * record.rms_m,
            record.lambda
        ),
        format!("volume      {:.2} cm³", 1e6 * mass.volume),
        format!(
            "centre      {:?} m in the frame of the cloud",
            record.centre_in_cloud_m
        ),
    ])
}

fn spherical_lines(object: &SphericalObject) -> Vec<String> {
    let shape = object.shape();
    let immersion = shape.immersion();
    vec![
        format!("shape       {}, a map of the sphere", object.name()),
        format!("degree      {}", shape.degree()),
        format!(
            "immersion   proved: area element at least {:.3e} m²; seen {:.3e} to {:.3e} m²",
            immersion.lower, immersion.seen_lower, immersion.seen_upper
        ),
        format!(
            "fit         {} points, rms {:.3} mm, λ {:.3e}, {:.3e}, {:.3e}",
            object.points(),
            1e3 * object.rms(),
            object.lambda()[0],
            object.lambda()[1],
            object.lambda()[2]
        ),
        format!(
            "volume      {:.2} cm³",
            1e6 * shape.mass_properties().volume
        ),
        format!(
            "centre      {:?} m in the frame of the cloud",
            <[f64; 3]>::from(object.frame().centre_in_cloud())
        ),
    ]
}

fn library_lines(record: &LibraryRecord) -> Vec<String> {
    let head = format!(
        "library     {} objects, hand {}, convention {}, seed {}",
        record.entries.len(),
        record.hand,
        record.convention,
        record.seed
    );
    let entries = record.entries.iter().map(|e| {
        let best = e.grasps.first().map_or(0.0, |g| g.quality);
        format!(
            "{:4} {:24} {:3} grasps, best {:.3}",
            e.id,
            e.name,
            e.grasps.len(),
            best
        )
    });
    std::iter::once(head).chain(entries).collect()
}

fn grasps_lines(file: &GraspsFile) -> Vec<String> {
    let best = file.grasps.first().map_or(0.0, |g| g.quality);
    vec![
        format!("grasps      {} on {}", file.grasps.len(), file.object.name),
        format!("convention  {}", file.convention.name),
        format!("best        {best:.4}"),
    ]
}

fn loaded_lines(loaded: &Loaded) -> Vec<String> {
    let kind = match &loaded.geometry {
        Geometry::Points(points) => format!("cloud       {} points", points.len()),
        Geometry::Mesh(mesh) => format!(
            "mesh        {} vertices, {} triangles",
            mesh.vertices.len(),
            mesh.triangles.len()
        ),
    };
    let (mut low, mut high) = (loaded.vertices()[0], loaded.vertices()[0]);
    for p in loaded.vertices() {
        (low, high) = (low.inf(p), high.sup(p));
    }
    let size = 1e3 * (high - low);
    vec![
        format!("{kind}, {} rows dropped, {}", loaded.dropped, loaded.format),
        format!(
            "extent      {:.1} × {:.1} × {:.1} mm, if the unit is metres",
            size.x, size.y, size.z
        ),
    ]
}
