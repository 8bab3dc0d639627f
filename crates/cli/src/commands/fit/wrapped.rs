//! The result of a fit of a map of the sphere.

use std::path::Path;

use moduli::Object;
use moduli::records::scene_record;
use record::grasps::SceneRecord;
use serde::Serialize;
use shape::{Embedding, SphericalCloudFit};

use crate::{input, output};

#[derive(Serialize)]
pub(super) struct WrappedLine {
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
    scene: Option<SceneRecord>,
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

impl WrappedLine {
    /// What is reported of a fit; `points` are all points of the file.
    pub(super) fn new(
        cloud: String,
        points: usize,
        object: &Object,
        fit: &SphericalCloudFit,
        seconds: f64,
    ) -> Self {
        let (shape, report) = (object.shape(), object.report());
        let closed_holes = fit.closed_holes.iter().map(|hole| Hole {
            centre_m: hole.centre.into(),
            area_m2: hole.area,
            radius_m: hole.radius,
        });
        Self {
            cloud,
            points,
            points_fitted: fit.points,
            model: "spherical",
            degree: shape.degree(),
            lambda: [fit.lambda; 3],
            rms_m: fit.surface_rms,
            max_abs_m: fit.surface_max,
            noise_m: fit.acceptance.noise_m,
            unexplained_share: fit.acceptance.unexplained_share,
            surface_rms_m: fit.acceptance.surface_rms_m,
            // A map that is not proved an immersion is refused by the fit.
            in_m_sph: true,
            embedding: match fit.embedding {
                Embedding::Proved { .. } => "proved",
                Embedding::Undecided { .. } => "immersion",
            },
            area_element_certified_m2: fit.shape.immersion().lower,
            volume_m3: shape.mass_properties().volume,
            closed_holes: closed_holes.collect(),
            hidden: fit.hidden,
            single_sheet_share: fit.walls.single_sheet_share,
            centre_m: fit.centre_in_cloud.into(),
            scene: report.scene.as_ref().map(scene_record),
            warnings: report.warnings.clone(),
            seconds,
        }
    }

    /// One line for people.
    pub(super) fn say(&self, path: &Path) {
        output::say(format!(
            "{}: spherical, {} points, degree {}, rms {:.3} mm, max {:.3} mm; {} ({:.2} s)",
            input::stem(path),
            self.points,
            self.degree,
            1e3 * self.rms_m,
            1e3 * self.max_abs_m,
            proved(self.embedding),
            self.seconds
        ));
    }
}

fn proved(embedding: &str) -> &'static str {
    match embedding {
        "proved" => "proved not to touch itself",
        _ => "proved an immersion",
    }
}
