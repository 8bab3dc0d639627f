//! From the points of a scene to an object: what is the object, its surface, and whether the surface may
//! be called that of the points.

use std::borrow::Cow;

use nalgebra::Point3;
use shape::acceptance::noise;
use shape::scene::{analyse, distinct};
use shape::{
    Acceptance, Embedding, Fit, FitError, FitSettings, PointCloud, Scene, SceneSettings,
    SphericalCloudFit, SphericalSettings, SupportSource, Verdict, fit_spherical_cloud,
};
use sph::Direction;

use super::{Object, STEEP};
use crate::error::Error;

/// A radial surface with a larger share of the directions without a point is not tried as a map.
const MOST_UNSEEN: f64 = 0.1;
/// Outliers are left out of the verdict on a surface up to this share of the points.
const MOST_OUTLIERS: f64 = 1.0 / 3.0;

/// The kind of surface that is fitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// Radial where a radius explains the points, else a map of the sphere.
    #[default]
    Auto,
    /// A radius per direction from the mean of the cloud: M^rad.
    Radial,
    /// A map of the sphere: M^sph.
    Spherical,
}

/// How points become an object.
#[derive(Clone, Debug, PartialEq)]
pub struct ReconstructionSettings {
    /// Degree and penalty of the fit.
    pub fit: FitSettings,
    /// The kind of surface.
    pub model: Model,
    /// Time of the heat flow that smooths a radial surface, see [`Fit::smoothed`].
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
            model: Model::Auto,
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
    pub fit: Fitted,
    /// Its points, each distinct one once, in the frame of the cloud.
    pub cloud: PointCloud,
}

/// A fit of either kind.
#[derive(Clone, Debug)]
pub enum Fitted {
    /// A radius.
    Radial(Box<Fit>),
    /// A map of the sphere.
    Spherical(Box<SphericalCloudFit>),
}

/// The object among some points, metres.
///
/// Repeated points count once. The support plane and other pieces are removed ([`shape::scene`]), a
/// surface is fitted to the rest, and its distances from the points decide whether it is accepted
/// ([`shape::acceptance`]). The result depends on the set of points alone, up to rounding.
///
/// With [`Model::Auto`] the surface is radial where a radius explains the points. Where the cloud is not
/// star-shaped, or the radial surface does not explain it, a map of the sphere is fitted
/// ([`fit_spherical_cloud`]).
///
/// # Errors
/// No piece of the cloud dominates; the piece has no proved surface; no surface explains its points, and [`ReconstructionSettings::accept_misfit`] is not set.
pub fn reconstruct(
    name: &str,
    cloud: &PointCloud,
    settings: &ReconstructionSettings,
) -> Result<Reconstruction, Error> {
    let whole = cloud;
    let (cloud, scene) = object_points(cloud, settings.scene.as_ref())?;
    let (object, fit) = match settings.model {
        Model::Radial => radial(name, &cloud, scene.as_ref(), settings)?,
        Model::Spherical => spherical(name, &cloud, scene.as_ref(), settings)?,
        Model::Auto => {
            let first = radial(name, &cloud, scene.as_ref(), settings);
            if settings.heat.is_none() && may_be_a_map(&first) {
                let second = spherical(name, &cloud, scene.as_ref(), settings);
                better(first, second.and_then(embedded))?
            } else {
                first?
            }
        }
    };
    let others = scene.iter().flat_map(|s| &s.others);
    let obstacles: Vec<Point3<f64>> = others.map(|i| whole.points()[*i]).collect();
    let scan = match (&fit, settings.heat) {
        (Fitted::Radial(fit), None) => inliers(fit, &cloud),
        // Heat moves the surface away from the scan, and hands with it.
        (Fitted::Radial(_), Some(_)) => Cow::default(),
        (Fitted::Spherical(_), _) => Cow::Borrowed(cloud.points()),
    };
    Ok(Reconstruction {
        object: object.with_surroundings(&obstacles, &scan),
        fit,
        cloud,
    })
}

/// An object with its fit.
type Made = Result<(Object, Fitted), Error>;

/// Whether another kind of surface may describe the points of such a radial fit: one that failed since the
/// object is not star-shaped, or that follows the points only roughly and is as steep as a star-shaped body
/// seldom is.
fn may_be_a_map(radial: &Made) -> bool {
    match radial {
        Err(error) => matches!(
            error,
            Error::Unexplained { .. }
                | Error::Fit(
                    FitError::NotStarShaped { .. }
                        | FitError::OpenContainer { .. }
                        | FitError::Radial(_)
                        | FitError::Overshoot { .. }
                )
        ),
        Ok((object, Fitted::Radial(fit))) => {
            let verdict = object.report().acceptance.map(|a| a.verdict());
            verdict == Some(Verdict::Coarse)
                && fit.max_abs > STEEP * fit.shape.mean_radius()
                && fit.visibility.unobserved <= MOST_UNSEEN
        }
        Ok(_) => false,
    }
}

/// A map that is proved not to touch itself; others are taken only when they are asked for.
fn embedded((object, fit): (Object, Fitted)) -> Made {
    match object.report().embedding {
        Some(Embedding::Proved { .. }) => Ok((object, fit)),
        _ => Err(Error::Unexplained {
            notes: object.report().warnings.clone(),
        }),
    }
}

/// Why the surface is a map of the sphere and not radial.
fn not_radial(error: &Error) -> String {
    match error {
        Error::Fit(FitError::NotStarShaped { .. } | FitError::OpenContainer { .. }) => {
            "the object is not star-shaped seen from the mean of its points; its surface is a map of the sphere".to_owned()
        }
        _ => format!(
            "no radius from the mean of the points describes them, so the surface is a map of the sphere; if the object is star-shaped, something else is part of the cloud ({error})"
        ),
    }
}

/// The map where it explains the points, or where there is no radial surface.
fn better(radial: Made, spherical: Made) -> Made {
    let explained = |made: &(Object, Fitted)| {
        let acceptance = made.0.report().acceptance;
        acceptance.is_some_and(|a| a.verdict() == Verdict::Explained)
    };
    match (radial, spherical) {
        (Ok(radial), Ok(spherical)) if !explained(&spherical) => Ok(radial),
        (Ok(_), Ok(spherical)) => Ok(spherical),
        (Err(radial), Ok((object, fit))) => Ok((object.with_warnings([not_radial(&radial)]), fit)),
        (Ok(radial), Err(_)) => Ok(radial),
        (Err(radial), Err(spherical)) => Err(Error::NeitherModel {
            radial: Box::new(radial),
            spherical: Box::new(spherical),
        }),
    }
}

fn radial(
    name: &str,
    cloud: &PointCloud,
    scene: Option<&Scene>,
    settings: &ReconstructionSettings,
) -> Made {
    let mut fit = shape::fit::fit(cloud, &settings.fit)?;
    if let Some(sigma) = settings.heat {
        fit = fit.smoothed(cloud, sigma)?;
    }
    let object = Object::from_fit(name, fit.clone(), cloud.points().len());
    let acceptance = accepted(&object, &fit, cloud);
    // Heat moves the surface away from the points because the caller wants that.
    let may_miss = settings.accept_misfit || settings.heat.is_some();
    let object = judged(object, acceptance, scene, may_miss)?;
    Ok((object, Fitted::Radial(Box::new(fit))))
}

fn spherical(
    name: &str,
    cloud: &PointCloud,
    scene: Option<&Scene>,
    settings: &ReconstructionSettings,
) -> Made {
    let fit = fit_spherical_cloud(
        cloud,
        &SphericalSettings {
            degree: settings.fit.degree,
            lambda: settings.fit.lambda,
            accept_misfit: settings.accept_misfit,
        },
    )?;
    let object = Object::from_spherical_cloud_fit(name, fit.clone());
    Ok((in_scene(object, scene), Fitted::Spherical(Box::new(fit))))
}

/// The object with the verdict on its surface and its scene, unless the points are not explained.
fn judged(
    object: Object,
    acceptance: Acceptance,
    scene: Option<&Scene>,
    may_miss: bool,
) -> Result<Object, Error> {
    let object = in_scene(object.with_acceptance(acceptance), scene);
    if acceptance.verdict() == Verdict::Unexplained && !may_miss {
        return Err(Error::Unexplained {
            notes: object.report().warnings.clone(),
        });
    }
    Ok(object)
}

fn in_scene(object: Object, scene: Option<&Scene>) -> Object {
    match scene {
        Some(scene) => object.with_scene(scene.clone(), scene_notes(scene)),
        None => object,
    }
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
        None => (
            distinct(points)
                .iter()
                .map(|row| row.index as usize)
                .collect(),
            None,
        ),
    };
    let object = if indices.len() == points.len() {
        cloud.clone()
    } else {
        PointCloud::new(indices.iter().map(|i| points[*i]).collect())?
    };
    Ok((object, scene))
}

/// The points of a cloud without the outliers of its fit, unless these are many.
fn inliers<'a>(fit: &Fit, cloud: &'a PointCloud) -> Cow<'a, [Point3<f64>]> {
    let all = cloud.points();
    let mut used = vec![true; all.len()];
    if fit.outliers.len() as f64 <= MOST_OUTLIERS * all.len() as f64 {
        fit.outliers.iter().for_each(|i| used[*i] = false);
    }
    let used = || all.iter().zip(&used).filter(|(_, used)| **used);
    // A cloud of which all points are used is not copied: it may have millions.
    if used().count() == all.len() {
        return Cow::Borrowed(all);
    }
    used().map(|(p, _)| *p).collect()
}

/// How well the surface of a fit explains its cloud.
pub(crate) fn accepted(object: &Object, fit: &Fit, cloud: &PointCloud) -> Acceptance {
    let (centre, points) = (&fit.centre_in_cloud, inliers(fit, cloud));
    // A point at the centre has no direction.
    let direction = |i: usize| Direction::try_new(points[i] - centre, 0.0);
    Acceptance::measure(object.field(), centre, &points, direction, noise(&points))
}

/// What was left out of a scene, a sentence each.
pub fn scene_notes(scene: &Scene) -> Vec<String> {
    let mut notes = Vec::new();
    let dropped = &scene.dropped;
    if dropped.support > 0
        && let Some((plane, source)) = &scene.support
    {
        // Rounded here, so that a small negative component is not printed as -0.000.
        let n = plane.normal.map(|x| (1e3 * x).round() / 1e3 + 0.0);
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
