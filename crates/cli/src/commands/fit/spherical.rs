//! `moduli fit --model spherical`: a surface over given sphere coordinates.

use std::path::Path;
use std::time::Instant;

use moduli::Object;
use serde::Serialize;
use shape::io::Geometry;
use shape::{FitSettings, PointCloud, fit_spherical};

use crate::args::{Common, FitOptions};
use crate::failure::Failure;
use crate::{input, output};

#[derive(Serialize)]
struct SphericalLine {
    cloud: String,
    points: usize,
    model: &'static str,
    degree: usize,
    lambda: [f64; 3],
    rms_m: f64,
    max_abs_m: f64,
    in_m_sph: bool,
    embedding: &'static str,
    area_element_certified_m2: f64,
    condition: f64,
    centre_m: [f64; 3],
    seconds: f64,
}

/// Fits one cloud whose points have the directions of a file.
pub(super) fn run(options: &FitOptions, common: &Common) -> Result<(), Failure> {
    let (path, directions) = match (options.clouds.as_slice(), &options.directions) {
        ([path], Some(directions)) => (path, directions),
        _ => return Err(Failure::usage("--directions takes one cloud")),
    };
    if options.cloud.heat.is_some() {
        return Err(Failure::usage("--heat applies to --model radial only"));
    }
    let cloud = points(path, options, common)?;
    let directions = input::directions(directions)?;
    let start = Instant::now();
    let settings = FitSettings {
        degree: options.cloud.degree,
        lambda: options.cloud.lambda,
    };
    let count = cloud.points().len();
    if directions.len() != count {
        return Err(Failure::usage(format!(
            "`{}` has {count} points, but there are {} directions; expected one per point",
            path.display(),
            directions.len()
        )));
    }
    let fit = fit_spherical(&directions, &cloud, &settings)
        .map_err(|e| Failure::refused(format!("{}: {e}", path.display())))?;
    let (max_abs, condition) = (fit.max_abs, fit.condition);
    let area_element = fit.shape.immersion().lower;
    let object = Object::from_spherical_fit(&input::stem(path), fit, count);
    let seconds = start.elapsed().as_secs_f64();
    if let Some(target) = &options.output {
        let bytes = object.to_shape_file();
        output::write_file(target, &bytes.map_err(|e| Failure::other(e.to_string()))?)?;
    }
    let line = SphericalLine {
        cloud: path.display().to_string(),
        points: count,
        model: "spherical",
        degree: object.shape().degree(),
        lambda: object.report().lambda_xyz.unwrap_or_default(),
        rms_m: object.report().rms,
        max_abs_m: max_abs,
        // A map that is not proved an immersion is refused by the fit.
        in_m_sph: true,
        embedding: "immersion",
        area_element_certified_m2: area_element,
        condition,
        centre_m: object.frame().centre_in_cloud().into(),
        seconds,
    };
    if common.json {
        return output::say_json(&line);
    }
    output::say(format!(
        "{}: {} points, degree {}, rms {:.3} mm, max {:.3} mm; proved an immersion, area element at least {:.3e} m² ({:.2} s)",
        input::stem(path),
        line.points,
        line.degree,
        1e3 * line.rms_m,
        1e3 * line.max_abs_m,
        line.area_element_certified_m2,
        line.seconds
    ));
    Ok(())
}

/// The cloud with every point of its file, so that the rows of the directions match.
fn points(path: &Path, options: &FitOptions, common: &Common) -> Result<PointCloud, Failure> {
    let loaded = input::load(path)?;
    if matches!(loaded.geometry, Geometry::Mesh(_)) {
        return Err(Failure::input(
            path,
            "the file is a mesh, from which points are sampled at random; --model spherical needs a cloud with one direction per point",
        ));
    }
    if loaded.dropped > 0 {
        return Err(Failure::input(
            path,
            format!(
                "{} rows are not finite, so the directions do not match the points; remove these rows from both files",
                loaded.dropped
            ),
        ));
    }
    Ok(input::scan(path, &options.cloud.reading, common.seed)?.cloud)
}
