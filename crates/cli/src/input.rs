//! Files of the user: clouds, shapes, grasps.

use std::path::Path;

use grasp::{Convention, Edges};
use moduli::{Object, Reconstruction, ReconstructionSettings, reconstruct};
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use record::{EnvelopeError, GraspsFile};
use run::npy::Table;
use shape::io::{Loaded, Warning};
use shape::{FitError, FitSettings, PointCloud, SceneError, SphericalCloudError};
use sph::Direction;
use sph::regression::RegressionError;

use crate::args::{CloudOptions, ConventionOptions, ReadingOptions};
use crate::failure::Failure;
use crate::files;
use crate::output::warn;

/// How far the length of a given direction may be from 1.
const UNIT_TOLERANCE: f64 = 1e-6;

/// The bytes of a file; of standard input for `-`.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    files::bytes(path).map_err(|e| Failure::input(path, e))
}

/// A table of numbers with this many columns from a `.npy` file.
pub(crate) fn table(path: &Path, columns: usize) -> Result<Table, Failure> {
    Table::from_npy_with_columns(&read(path)?, columns).map_err(|e| Failure::input(path, e))
}

/// The object's name for a file.
pub(crate) fn stem(path: &Path) -> String {
    let stem = path.file_stem().filter(|_| !files::is_standard_input(path));
    stem.map_or_else(|| "object".to_owned(), |s| s.to_string_lossy().into_owned())
}

/// A cloud read from a file.
pub(crate) struct Scan {
    /// Its points, metres.
    pub(crate) cloud: PointCloud,
    /// Warnings: dropped rows and implausible values, one sentence each.
    pub(crate) warnings: Vec<String>,
}

/// A cloud in metres. Its warnings go to standard error too.
///
/// A mesh is sampled by area; the same seed gives the same points. If no unit was given, an
/// implausible extent is refused.
pub(crate) fn scan(path: &Path, options: &ReadingOptions, seed: u64) -> Result<Scan, Failure> {
    let mut loaded = load(path)?;
    match options.unit {
        Some(unit) => loaded = loaded.scaled(unit.metres()),
        None => {
            if let Some(why) = loaded.implausible() {
                let advice = "give --unit mm, cm, in or m";
                return Err(Failure::input(path, format!("{why}; {advice}")));
            }
        }
    }
    let sentence = |warning: &Warning| match warning {
        Warning::Unit { .. } => format!("{warning} (--unit mm, cm, m, in)"),
        _ => warning.to_string(),
    };
    let warnings: Vec<String> = loaded.warnings.iter().map(sentence).collect();
    for warning in &warnings {
        warn(format!("{}: {warning}", path.display()));
    }
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let cloud = loaded
        .cloud(options.samples, &mut rng)
        .map_err(|e| Failure::input(path, e))?;
    Ok(Scan { cloud, warnings })
}

/// A cloud or mesh in the unit of its file.
pub(crate) fn load(path: &Path) -> Result<Loaded, Failure> {
    loaded(path, &read(path)?)
}

/// A cloud or mesh from the bytes of a file, in the unit of the file.
pub(crate) fn loaded(path: &Path, bytes: &[u8]) -> Result<Loaded, Failure> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
    shape::io::read_cloud(bytes, extension).map_err(|e| Failure::input(path, e))
}

/// The object among the points of a scan. New warnings go to standard error; all are in
/// [`moduli::FitReport`]. Refusals say what to try.
pub(crate) fn fitted(
    scan: &Scan,
    name: &str,
    options: &CloudOptions,
    model: moduli::Model,
) -> Result<Reconstruction, Failure> {
    let settings = ReconstructionSettings {
        model,
        fit: FitSettings {
            degree: options.degree,
            lambda: options.lambda,
        },
        heat: options.heat,
        scene: options.scene.settings(),
        accept_misfit: options.scene.accept_misfit,
    };
    let mut made = reconstruct(name, &scan.cloud, &settings).map_err(|e| refused(name, e))?;
    for warning in &made.object.report().warnings {
        warn(format!("{name}: {warning}"));
    }
    made.object = made.object.with_warnings(scan.warnings.iter().cloned());
    Ok(made)
}

/// Why a cloud has no object, and what to try.
fn refused(name: &str, error: moduli::Error) -> Failure {
    let hint = match &error {
        moduli::Error::Fit(FitError::Heat { sigma }) => {
            return Failure::usage(format!("--heat {sigma}: expected a number of at least 0"));
        }
        moduli::Error::Fit(FitError::Regression(RegressionError::Penalty { lambda })) => {
            return Failure::usage(format!(
                "--lambda {lambda}: expected a number of at least 0"
            ));
        }
        moduli::Error::Scene(SceneError::NoSuchPiece { .. }) => {
            return Failure::usage(format!("{name}: {error}"));
        }
        moduli::Error::Scene(SceneError::Ambiguous { .. }) => {
            "; choose one with --piece N, or fit all points with --scene off"
        }
        moduli::Error::Unexplained { .. } => {
            "; cut away what is not the object; if a direction from the mean of the points meets the object more than once, `moduli fit --model spherical` fits it; --accept-misfit keeps this surface"
        }
        moduli::Error::SphericalCloud(
            SphericalCloudError::OneSide { .. } | SphericalCloudError::Unexplained(_),
        ) => "; --accept-misfit keeps this surface",
        moduli::Error::NeitherModel { .. } => {
            "; cut away what is not the object, or scan it from more sides; --model with --accept-misfit keeps a surface that does not explain its points"
        }
        moduli::Error::Fit(FitError::NotStarShaped { .. } | FitError::OpenContainer { .. }) => {
            "; `moduli fit --model spherical` fits such objects"
        }
        _ => "",
    };
    Failure::refused(format!("{name}: {error}{hint}"))
}

/// The unit vectors of a table, N×3 in a `.npy` file.
pub(crate) fn directions(path: &Path) -> Result<Vec<Direction>, Failure> {
    let table = table(path, 3)?;
    let mut directions = Vec::with_capacity(table.row_count());
    for (row, v) in table.rows().enumerate() {
        let v = Vector3::new(v[0], v[1], v[2]);
        let length = v.norm();
        // The negated comparison also refuses NaN.
        if !((length - 1.0).abs() <= UNIT_TOLERANCE) {
            return Err(Failure::input(
                path,
                format!("row {row} has length {length}; expected a unit vector"),
            ));
        }
        directions.push(Direction::new_unchecked(v / length));
    }
    Ok(directions)
}

/// The object of a shape file of either kind; its surface is proved again.
pub(crate) fn object(path: &Path) -> Result<Object, Failure> {
    Object::from_shape_file(&read(path)?).map_err(|e| {
        let hint = match e {
            moduli::Error::Record(EnvelopeError::Magic) => {
                "; `moduli fit` makes shapes from clouds and meshes"
            }
            _ => "",
        };
        Failure::input(path, format!("{e}{hint}"))
    })
}

/// A grasps.json.
pub(crate) fn grasps(path: &Path) -> Result<GraspsFile, Failure> {
    GraspsFile::from_json(&read(path)?).map_err(|e| Failure::input(path, e))
}

/// The convention that the options name and change.
pub(crate) fn convention(options: &ConventionOptions) -> Result<Convention, Failure> {
    let name = options.convention.as_deref().unwrap_or("paper");
    let convention = Convention::named(name).map_err(|e| Failure::usage(e.to_string()))?;
    changed(convention, options)
}

/// A convention with the numbers that the options change.
pub(crate) fn changed(
    mut convention: Convention,
    options: &ConventionOptions,
) -> Result<Convention, Failure> {
    if let Some(friction) = options.friction {
        convention.friction = friction;
    }
    if let Some(length) = options.torque_length {
        convention = convention.with_torque_length(length);
    }
    match options.edges.as_deref() {
        None => {}
        Some("round") => {
            convention.edges = Edges::Round {
                tolerance: options.tolerance,
            };
        }
        Some(count) => {
            let count = count.parse().map_err(|_| {
                Failure::usage(format!(
                    "--edges {count}: expected a whole number or `round`"
                ))
            })?;
            convention.edges = Edges::Polygon(count);
        }
    }
    convention
        .validate()
        .map_err(|e| Failure::usage(e.to_string()))?;
    Ok(convention)
}
