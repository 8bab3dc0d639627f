//! From the points of a scene to an object: what is the object, its surface, and whether the surface may
//! be called that of the points.

use nalgebra::Point3;
use shape::acceptance::noise;
use shape::scene::{analyse, distinct};
use shape::{
    Acceptance, Fit, FitSettings, PointCloud, Scene, SceneSettings, SupportSource, Surface, Verdict,
};
use sph::Direction;

use super::Object;
use crate::error::Error;

/// Outliers are left out of the verdict on a surface up to this share of the points.
const MOST_OUTLIERS: f64 = 1.0 / 3.0;

/// How points become an object.
#[derive(Clone, Debug, PartialEq)]
pub struct ReconstructionSettings {
    /// Degree and penalty of the fit.
    pub fit: FitSettings,
    /// Time of the heat flow that smooths the surface, see [`Fit::smoothed`].
    pub heat: Option<f64>,
    /// How the object is found among the points; `None` where all points are the object's.
    pub scene: Option<SceneSettings>,
    /// Whether a surface that does not explain its points is kept, with a warning.
    pub accept_misfit: bool,
}

impl ReconstructionSettings {
    /// The scene is taken apart and a surface that does not explain its points is refused.
    pub fn new(fit: FitSettings) -> Self {
        Self {
            fit,
            heat: None,
            scene: Some(SceneSettings::default()),
            accept_misfit: false,
        }
    }
}

/// An object and what it was made from.
#[derive(Clone, Debug)]
pub struct Reconstruction {
    /// The object.
    pub object: Object,
    /// The fit of its surface.
    pub fit: Fit,
    /// Its points, each distinct one once, in the frame of the cloud.
    pub cloud: PointCloud,
}

/// The object among some points, metres.
///
/// Repeated points count once. The support plane and other pieces are removed ([`shape::scene`]), a
/// surface is fitted to the rest, and its distances from the points decide whether it is accepted
/// ([`shape::acceptance`]). The result depends on the set of points alone, up to rounding.
///
/// # Errors
/// No piece of the cloud dominates; the piece has no proved surface; the surface does not explain its
/// points, and [`ReconstructionSettings::accept_misfit`] is not set.
pub fn reconstruct(
    name: &str,
    cloud: &PointCloud,
    settings: &ReconstructionSettings,
) -> Result<Reconstruction, Error> {
    let whole = cloud;
    let (cloud, scene) = object_points(cloud, settings.scene.as_ref())?;
    let mut fit = shape::fit::fit(&cloud, &settings.fit)?;
    if let Some(sigma) = settings.heat {
        fit = fit.smoothed(&cloud, sigma)?;
    }
    let object = Object::from_fit(name, fit.clone(), cloud.points().len());
    let acceptance = accepted(&object, &fit, &cloud);
    let mut object = object.with_acceptance(acceptance);
    let others = scene.iter().flat_map(|s| &s.others);
    let obstacles: Vec<Point3<f64>> = others.map(|i| whole.points()[*i]).collect();
    // Heat moves the surface away from the scan, and hands with it.
    let scan = match settings.heat {
        None => inliers(&fit, &cloud),
        Some(_) => Vec::new(),
    };
    object = object.with_surroundings(&obstacles, &scan);
    if let Some(scene) = scene {
        let notes = scene_notes(&scene);
        object = object.with_scene(scene, notes);
    }
    // Heat moves the surface away from the points because the caller wants that.
    let may_miss = settings.accept_misfit || settings.heat.is_some();
    if acceptance.verdict() == Verdict::Unexplained && !may_miss {
        return Err(Error::Unexplained {
            notes: object.report().warnings.clone(),
        });
    }
    Ok(Reconstruction { object, fit, cloud })
}

/// The points of the object among those of a scene, each distinct one once, and what else was there.
/// Without settings all points are the object's.
///
/// # Errors
/// No piece of the cloud dominates, or too few points are left.
pub fn object_points(
    cloud: &PointCloud,
    settings: Option<&SceneSettings>,
) -> Result<(PointCloud, Option<Scene>), Error> {
    let points = cloud.points();
    let (indices, scene) = match settings {
        Some(rule) => {
            let mut scene = analyse(points, rule)?;
            (std::mem::take(&mut scene.object), Some(scene))
        }
        None => (distinct(points).iter().map(|row| row.index).collect(), None),
    };
    let object = if indices.len() == points.len() {
        cloud.clone()
    } else {
        PointCloud::new(indices.iter().map(|i| points[*i]).collect())?
    };
    Ok((object, scene))
}

/// The points of a cloud without the outliers of its fit, unless these are many.
fn inliers(fit: &Fit, cloud: &PointCloud) -> Vec<Point3<f64>> {
    let all = cloud.points();
    let mut used = vec![true; all.len()];
    if fit.outliers.len() as f64 <= MOST_OUTLIERS * all.len() as f64 {
        fit.outliers.iter().for_each(|i| used[*i] = false);
    }
    let used = all.iter().zip(&used).filter(|(_, used)| **used);
    used.map(|(p, _)| *p).collect()
}

/// How well the surface of a fit explains its cloud.
pub(crate) fn accepted(object: &Object, fit: &Fit, cloud: &PointCloud) -> Acceptance {
    let centre = fit.centre_in_cloud.coords;
    let points: Vec<Point3<f64>> = inliers(fit, cloud).iter().map(|p| p - centre).collect();
    // A point at the centre has no direction; any start does for it.
    let direction = |p: &Point3<f64>| {
        Direction::try_new(p.coords, 0.0).unwrap_or_else(nalgebra::Vector3::z_axis)
    };
    let starts: Vec<Direction> = points.iter().map(direction).collect();
    let measured = measure(object.field(), &points, &starts);
    measured.moved(&centre)
}

fn measure(
    surface: &(impl Surface + Sync),
    points: &[Point3<f64>],
    starts: &[Direction],
) -> Acceptance {
    Acceptance::measure(surface, points, Some(starts), noise(points))
}

/// What was left out of a scene, a sentence each.
pub fn scene_notes(scene: &Scene) -> Vec<String> {
    let mut notes = Vec::new();
    let dropped = &scene.dropped;
    if dropped.support > 0
        && let Some((plane, source)) = &scene.support
    {
        let n = plane.normal;
        let whose = match source {
            SupportSource::Given => "given",
            SupportSource::Visible | SupportSource::Foot => "found",
        };
        notes.push(format!(
            "{} points on or below the support plane that was {whose}, ({:.3}, {:.3}, {:.3}) · x = {:.4} m, are not part of the object",
            dropped.support, n.x, n.y, n.z, plane.offset_m
        ));
    }
    if dropped.sentinels > 0 {
        notes.push(format!(
            "{} rows repeat one and the same isolated point, the mark of a sensor for \"no return\"; they were dropped",
            dropped.sentinels
        ));
    }
    let others: Vec<String> = scene
        .pieces
        .iter()
        .enumerate()
        .filter(|(_, piece)| !piece.taken)
        .map(|(i, piece)| format!("{}) {piece}", i + 1))
        .collect();
    if let Some(taken) = scene.pieces.iter().find(|piece| piece.taken)
        && !others.is_empty()
    {
        notes.push(format!(
            "the cloud has {} pieces; the object is the one with {taken}; left out: {}",
            scene.pieces.len(),
            others.join("; ")
        ));
    }
    notes
}
