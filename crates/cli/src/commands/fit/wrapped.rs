//! `moduli fit --model spherical` without given directions: wrap, map, fit.

use std::path::Path;
use std::time::Instant;

use moduli::Object;
use serde::Serialize;
use shape::{
    Embedding, SphericalCloudError, SphericalCloudFit, SphericalSettings, Surface,
    fit_spherical_cloud,
};

use super::target;
use crate::args::{Common, FitOptions};
use crate::failure::Failure;
use crate::{input, output};

#[derive(Serialize)]
struct WrappedLine {
    cloud: String,
    points: usize,
    points_fitted: usize,
    model: &'static str,
    degree: usize,
    lambda: [f64; 3],
    rms_m: f64,
    max_abs_m: f64,
    noise_m: f64,
    unexplained_share: f64,
    surface_rms_m: f64,
    in_m_sph: bool,
    embedding: &'static str,
    area_element_certified_m2: f64,
    volume_m3: f64,
    closed_holes: Vec<Hole>,
    hidden: usize,
    single_sheet_share: f64,
    centre_m: [f64; 3],
    warnings: Vec<String>,
    seconds: f64,
}

/// A handle that was closed; no contact belongs there.
#[derive(Serialize)]
struct Hole {
    centre_m: [f64; 3],
    area_m2: f64,
    radius_m: f64,
}

/// Fits clouds of any closed objects.
pub(super) fn run(options: &FitOptions, common: &Common) -> Result<(), Failure> {
    if options.cloud.heat.is_some() {
        return Err(Failure::usage("--heat applies to --model radial only"));
    }
    let mut failures = Vec::new();
    for path in &options.clouds {
        match fit_one(path, options, common.seed) {
            Ok(line) if common.json => output::say_json(&line)?,
            Ok(line) => say(path, &line),
            Err(failure) => failures.push(failure),
        }
    }
    Failure::all(failures)
}

fn fit_one(path: &Path, options: &FitOptions, seed: u64) -> Result<WrappedLine, Failure> {
    let scan = input::scan(path, &options.cloud.reading, seed)?;
    let points = scan.cloud.points().len();
    let start = Instant::now();
    let input::Scan {
        cloud,
        mut warnings,
    } = input::isolated(scan, &path.display().to_string(), &options.cloud)?;
    let settings = SphericalSettings {
        degree: options.cloud.degree,
        lambda: options.cloud.lambda,
        accept_misfit: options.cloud.scene.accept_misfit,
    };
    let fit = fit_spherical_cloud(&cloud, &settings).map_err(|e| refused(path, &e))?;
    let closed_holes = fit.closed_holes.iter().map(|hole| Hole {
        centre_m: hole.centre.into(),
        area_m2: hole.area,
        radius_m: hole.radius,
    });
    let closed_holes = closed_holes.collect();
    let max_abs_m = fit.surface_max;
    let (acceptance, walls, hidden) = (fit.acceptance, fit.walls, fit.hidden);
    let (embedding, undecided) = verdict(&fit);
    let notes: Vec<String> = fit.notes().into_iter().chain(undecided).collect();
    for note in &notes {
        output::warn(format!("{}: {note}", path.display()));
    }
    warnings.extend(notes);
    let area_element = fit.shape.immersion().lower;
    let object = Object::from_spherical_cloud_fit(&input::stem(path), fit);
    let seconds = start.elapsed().as_secs_f64();
    if let Some(target) = target(path, options) {
        let bytes = object.to_shape_file();
        output::write_file(&target, &bytes.map_err(|e| Failure::other(e.to_string()))?)?;
    }
    let (shape, report) = (object.shape(), object.report());
    Ok(WrappedLine {
        cloud: path.display().to_string(),
        points,
        points_fitted: report.points,
        model: "spherical",
        degree: shape.degree(),
        lambda: report.lambda_xyz.unwrap_or_default(),
        rms_m: report.rms,
        max_abs_m,
        noise_m: acceptance.noise_m,
        unexplained_share: acceptance.unexplained_share,
        surface_rms_m: acceptance.surface_rms_m,
        // A map that is not proved an immersion is refused by the fit.
        in_m_sph: true,
        embedding,
        area_element_certified_m2: area_element,
        volume_m3: shape.mass_properties().volume,
        closed_holes,
        hidden,
        single_sheet_share: walls.single_sheet_share,
        centre_m: object.frame().centre_in_cloud().into(),
        warnings,
        seconds,
    })
}

/// Why there is no surface, and what to try.
fn refused(path: &Path, error: &SphericalCloudError) -> Failure {
    let hint = match error {
        SphericalCloudError::OneSide { .. } | SphericalCloudError::Unexplained(_) => {
            "; --accept-misfit keeps this surface"
        }
        _ => "",
    };
    Failure::refused(format!("{}: {error}{hint}", path.display()))
}

/// The result of the proof, and where it failed.
fn verdict(fit: &SphericalCloudFit) -> (&'static str, Vec<String>) {
    let (first, second, gap) = match fit.embedding {
        Embedding::Proved { .. } => return ("proved", Vec::new()),
        Embedding::Undecided { first, second, gap } => (first, second, gap),
    };
    let [a, b] = [first, second].map(|p| {
        let p = fit.centre_in_cloud + fit.shape.point(&p).coords;
        format!("({:.4}, {:.4}, {:.4})", p.x, p.y, p.z)
    });
    let warning = format!(
        "not proved that the surface does not touch itself: {:.2e} m between {a} and {b} m; a larger --lambda or a lower --degree may help",
        gap
    );
    ("immersion", vec![warning])
}

fn say(path: &Path, line: &WrappedLine) {
    output::say(format!(
        "{}: {} points, degree {}, rms {:.3} mm, max {:.3} mm; {} ({:.2} s)",
        input::stem(path),
        line.points,
        line.degree,
        1e3 * line.rms_m,
        1e3 * line.max_abs_m,
        proved(line.embedding),
        line.seconds
    ));
}

fn proved(embedding: &str) -> &'static str {
    match embedding {
        "proved" => "proved not to touch itself",
        _ => "proved an immersion",
    }
}
