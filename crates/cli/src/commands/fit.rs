//! `moduli fit`: smooth surfaces of clouds, proved valid.

mod spherical;
mod wrapped;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use moduli::records::scene_record;
use moduli::{Fitted, Object};
use record::grasps::SceneRecord;
use serde::Serialize;
use shape::Fit;

use self::wrapped::WrappedLine;
use crate::args::{Common, FitOptions, SurfaceChoice};
use crate::failure::Failure;
use crate::{input, output};

#[derive(Serialize)]
struct FitLine {
    cloud: String,
    points: usize,
    model: &'static str,
    degree: usize,
    lambda: f64,
    rms_m: f64,
    max_abs_m: f64,
    noise_m: Option<f64>,
    unexplained_share: Option<f64>,
    surface_rms_m: Option<f64>,
    r_min_certified_m: f64,
    r_max_certified_m: f64,
    in_m_rad: bool,
    condition: f64,
    outliers: usize,
    unseen_share: f64,
    multivalued_share: f64,
    centre_m: [f64; 3],
    scene: Option<SceneRecord>,
    warnings: Vec<String>,
    seconds: f64,
    seconds_regression: f64,
}

pub(crate) fn run(options: &FitOptions, common: &Common) -> Result<(), Failure> {
    refuse_shared_names(options)?;
    if options.directions.is_some() {
        return match options.model {
            SurfaceChoice::Spherical => spherical::run(options, common),
            _ => Err(Failure::usage("--directions needs --model spherical")),
        };
    }
    if options.cloud.heat.is_some() && options.model == SurfaceChoice::Spherical {
        return Err(Failure::usage("--heat applies to --model radial only"));
    }
    let mut failures = Vec::new();
    let mut header = !common.json;
    for path in &options.clouds {
        match fit_one(path, options, common.seed) {
            Ok(line) if common.json => output::say_json(&line)?,
            Ok(Line::Radial(line)) => {
                if header {
                    output::say(HEADER);
                    header = false;
                }
                say(path, &line);
            }
            Ok(Line::Spherical(line)) => line.say(path),
            Err(failure) => failures.push(failure),
        }
    }
    Failure::all(failures)
}

const HEADER: &str = "cloud                         points   L    lambda   rms mm   max mm    r certified mm      cond       s";

fn say(path: &Path, line: &FitLine) {
    output::say(format!(
        "{:28} {:>7} {:>3} {:>9.2e} {:>8.3} {:>8.3} {:>8.2} {:>8.2} {:>9.2} {:>7.2}",
        input::stem(path),
        line.points,
        line.degree,
        line.lambda,
        1e3 * line.rms_m,
        1e3 * line.max_abs_m,
        1e3 * line.r_min_certified_m,
        1e3 * line.r_max_certified_m,
        line.condition,
        line.seconds
    ));
}

/// The result for one cloud.
#[derive(Serialize)]
#[serde(untagged)]
enum Line {
    Radial(Box<FitLine>),
    Spherical(Box<WrappedLine>),
}

fn fit_one(path: &Path, options: &FitOptions, seed: u64) -> Result<Line, Failure> {
    let scan = input::scan(path, &options.cloud.reading, seed)?;
    let start = Instant::now();
    let name = path.display().to_string();
    let made = input::fitted(&scan, &name, &options.cloud, options.model.into())?;
    let seconds = start.elapsed().as_secs_f64();
    let points = scan.cloud.points().len();
    let object = made.object.named(&input::stem(path));
    if let Some(target) = target(path, options) {
        let bytes = object
            .to_shape_file()
            .map_err(|e| Failure::other(e.to_string()))?;
        output::write_file(&target, &bytes)?;
    }
    Ok(match made.fit {
        Fitted::Radial(fit) => Line::Radial(Box::new(radial(name, points, &object, &fit, seconds))),
        Fitted::Spherical(fit) => {
            let line = WrappedLine::new(name, points, &object, &fit, seconds);
            Line::Spherical(Box::new(line))
        }
    })
}

fn radial(cloud: String, points: usize, object: &Object, fit: &Fit, seconds: f64) -> FitLine {
    let report = object.report();
    let isolated = report.scene.as_ref().map_or(0, |s| s.dropped.isolated);
    let (r_min, r_max) = fit.shape.radius_bounds();
    FitLine {
        cloud,
        points,
        model: "radial",
        degree: fit.shape.degree(),
        lambda: fit.lambda,
        rms_m: fit.rms,
        max_abs_m: fit.max_abs,
        noise_m: report.acceptance.map(|a| a.noise_m),
        unexplained_share: report.acceptance.map(|a| a.unexplained_share),
        surface_rms_m: report.acceptance.map(|a| a.surface_rms_m),
        r_min_certified_m: r_min,
        r_max_certified_m: r_max,
        // Always true: `fit` refuses other shapes.
        in_m_rad: r_min > 0.0,
        condition: fit.condition,
        outliers: fit.outliers.len() + isolated,
        unseen_share: fit.visibility.unobserved,
        multivalued_share: fit.visibility.multiple,
        centre_m: fit.centre_in_cloud.into(),
        scene: report.scene.as_ref().map(scene_record),
        warnings: report.warnings.clone(),
        seconds,
        seconds_regression: fit.regression_seconds,
    }
}

/// Two clouds whose shapes would have one name, and a shape that would replace a cloud.
fn refuse_shared_names(options: &FitOptions) -> Result<(), Failure> {
    let mut clouds: BTreeMap<PathBuf, &Path> = BTreeMap::new();
    for cloud in &options.clouds {
        let Some(shape) = target(cloud, options) else {
            return Ok(());
        };
        if let Some(other) = clouds.get(&shape) {
            return Err(Failure::usage(format!(
                "the shapes of `{}` and `{}` would both be written to `{}`; fit them into two folders",
                other.display(),
                cloud.display(),
                shape.display()
            )));
        }
        clouds.insert(shape, cloud);
    }
    let shapes: Vec<&PathBuf> = clouds.keys().collect();
    Ok(run::check_results(&shapes, &options.clouds)?)
}

/// The file that a cloud's shape goes to.
fn target(cloud: &Path, options: &FitOptions) -> Option<PathBuf> {
    let output = options.output.as_ref()?;
    Some(if options.clouds.len() == 1 {
        output.clone()
    } else {
        output.join(format!("{}.shape", input::stem(cloud)))
    })
}
