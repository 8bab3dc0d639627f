//! Objects whose surface is a map of the sphere into space (M^sph of the paper).

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use nalgebra::{Point3, UnitVector3};
use record::grasps::HoleRecord;
use record::{ClosedHoleRecord, SphericalRecord};
use shape::acceptance::nearest_places;
use shape::{
    Acceptance, AnyShape, ClosedPatch, Embedding, FitSettings, PointCloud, SphericalCloudFit,
    SphericalField, SphericalFit, SphericalShape, Surface, fit_spherical,
};
use sph::bounds::certified_range;
use sph::{Coefficients, Direction};

use super::{FitReport, Object};
use crate::error::Error;
use crate::frame::CloudFrame;
use crate::records::{StoredShapeError, stored_support};

/// The grid on which the coordinates are bounded is finer than their degree needs by this.
const OVERSAMPLING: usize = 4;

/// The surface at one direction, in the frame of the cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, metres.
    pub position: Point3<f64>,
    /// The outward unit normal.
    pub outward_normal: UnitVector3<f64>,
    /// The two principal curvatures, 1/m, the larger first; positive where the solid is convex.
    pub principal_curvatures: [f64; 2],
}

impl SurfacePoint {
    /// Half the sum of the principal curvatures, 1/m.
    pub fn mean_curvature(&self) -> f64 {
        0.5 * (self.principal_curvatures[0] + self.principal_curvatures[1])
    }
}

impl Object {
    /// Fits f(pᵢ) ≈ xᵢ, where `directions` gives each point of the cloud its place on the sphere, and
    /// proves the result an immersion.
    ///
    /// Costs three radial fits.
    ///
    /// # Errors
    /// The numbers of directions and points differ, a regression fails, or the map is not proved an
    /// immersion.
    ///
    /// ```
    /// use moduli::nalgebra::{Point3, UnitVector3, Vector3};
    /// use moduli::{FitSettings, Object, PointCloud};
    ///
    /// let mut directions = Vec::new();
    /// for i in 0..20 {
    ///     for j in 0..40 {
    ///         let (z, a) = (-0.95 + 0.1 * f64::from(i), 0.157 * f64::from(j));
    ///         let p = Vector3::new(a.cos(), a.sin(), 0.0) * f64::sqrt(1.0 - z * z);
    ///         directions.push(UnitVector3::new_normalize(p + z * Vector3::z()));
    ///     }
    /// }
    /// let points = directions.iter().map(|p| Point3::new(0.03 * p.x, 0.04 * p.y, 0.05 * p.z));
    /// let cloud = PointCloud::new(points.collect())?;
    /// let settings = FitSettings { degree: 4, lambda: None };
    /// let egg = Object::from_directions("egg", &cloud, &directions, &settings)?;
    /// let top = egg.at(&UnitVector3::new_normalize(Vector3::z()));
    /// assert!((top.position.z - 0.05).abs() < 1e-4);
    /// # Ok::<(), moduli::Error>(())
    /// ```
    pub fn from_directions(
        name: &str,
        cloud: &PointCloud,
        directions: &[Direction],
        settings: &FitSettings,
    ) -> Result<Self, Error> {
        let points = cloud.points().len();
        if directions.len() != points {
            return Err(Error::DirectionCount {
                directions: directions.len(),
                points,
            });
        }
        let fit = fit_spherical(directions, cloud, settings)?;
        Ok(Self::from_spherical_fit(name, fit, points))
    }

    /// The object of a fit of `points` points with given directions.
    pub fn from_spherical_fit(name: &str, fit: SphericalFit, points: usize) -> Self {
        let report = FitReport {
            points,
            rms: fit.rms,
            lambda: fit.lambda[0],
            lambda_xyz: Some(fit.lambda),
            max_abs: Some(fit.max_abs),
            residuals: BTreeMap::from([("rms_m".to_owned(), fit.rms)]),
            ..FitReport::default()
        };
        Self::of_map(
            name,
            fit.shape,
            CloudFrame::new(fit.centre_in_cloud),
            report,
        )
    }

    /// The object of a fit without given directions. The holes that the fit closed stay closed: no contact
    /// is placed there.
    pub fn from_spherical_cloud_fit(name: &str, fit: SphericalCloudFit) -> Self {
        let mut warnings = fit.notes();
        let holes = fit.closed_holes.iter().map(|hole| ClosedPatch {
            places: hole
                .places
                .iter()
                .map(|p| p - fit.centre_in_cloud.coords)
                .collect(),
            reach: hole.reach,
            area: hole.area,
        });
        let shape = fit.shape.with_closed_patches(holes.collect());
        if let Embedding::Undecided { first, second, gap } = fit.embedding {
            let [a, b] = [first, second].map(|p| {
                let p = fit.centre_in_cloud + shape.point(&p).coords;
                format!("({:.4}, {:.4}, {:.4})", p.x, p.y, p.z)
            });
            warnings.push(format!(
                "not proved that the surface does not touch itself: {gap:.2e} m between {a} and {b} m"
            ));
        }
        let report = FitReport {
            points: fit.points,
            rms: fit.surface_rms,
            lambda: fit.lambda,
            lambda_xyz: Some([fit.lambda; 3]),
            embedding: Some(fit.embedding),
            max_abs: Some(fit.surface_max),
            residuals: residuals(fit.surface_rms, &fit.acceptance),
            acceptance: Some(fit.acceptance),
            warnings,
            ..FitReport::default()
        };
        Self::of_map(name, shape, CloudFrame::new(fit.centre_in_cloud), report)
    }

    fn of_map(name: &str, shape: SphericalShape, frame: CloudFrame, report: FitReport) -> Self {
        Self {
            name: name.to_owned(),
            shape: shape.into(),
            field: OnceLock::new(),
            frame,
            support: None,
            surroundings: Arc::default(),
            report,
        }
    }

    /// A stored map of the sphere. It is proved an immersion again, because a stored claim is not a proof.
    ///
    /// # Errors
    /// A number is not finite, or the map is not proved an immersion.
    pub fn from_spherical_record(record: &SphericalRecord) -> Result<Self, Error> {
        if !record.centre_in_cloud_m.iter().all(|x| x.is_finite()) {
            return Err(StoredShapeError::Centre.into());
        }
        let axis = |k: usize| {
            Coefficients::new(record.coordinates[k].clone()).map_err(StoredShapeError::from)
        };
        let shape = SphericalShape::new(axis(0)?, axis(1)?, axis(2)?)
            .map_err(StoredShapeError::Spherical)?;
        let centre = Point3::from(record.centre_in_cloud_m);
        let holes = record
            .closed_holes
            .iter()
            .map(|hole| stored_hole(hole, &centre));
        let shape = shape.with_closed_patches(holes.collect::<Result<_, _>>()?);
        let notes = &record.notes;
        let report = FitReport {
            points: usize::try_from(record.points).unwrap_or(usize::MAX),
            rms: record.rms_m,
            lambda: record.lambda[0],
            lambda_xyz: Some(record.lambda),
            residuals: notes.residuals.clone(),
            warnings: notes.warnings.clone(),
            ..FitReport::default()
        };
        let object = Self::of_map(&record.name, shape, CloudFrame::new(centre), report);
        Ok(object.with_support(stored_support(notes.support.as_ref())?))
    }

    /// The record in which an object is stored whose surface is a map of the sphere; `None` if it is radial.
    pub fn to_spherical_record(&self) -> Option<SphericalRecord> {
        let coordinates = self.shape.spherical()?.coordinates().each_ref();
        let centre = self.frame.centre_in_cloud().coords;
        let holes = self.shape.closed_patches().iter().map(|patch| {
            let patch = patch.moved(&centre);
            ClosedHoleRecord {
                places_m: patch.places.iter().map(|p| (*p).into()).collect(),
                reach_m: patch.reach,
                area_m2: patch.area,
            }
        });
        Some(SphericalRecord {
            name: self.name.clone(),
            coordinates: coordinates.map(|c| c.as_slice().to_vec()),
            centre_in_cloud_m: self.frame.centre_in_cloud().into(),
            lambda: self.report.lambda_xyz.unwrap_or_default(),
            rms_m: self.report.rms,
            points: self.report.points as u64,
            notes: self.notes(),
            closed_holes: holes.collect(),
        })
    }

    /// The holes of the object that its surface closes, as they are stored.
    pub(super) fn hole_records(&self) -> Vec<HoleRecord> {
        let patches = self.shape.closed_patches().iter();
        patches
            .filter_map(|patch| {
                Some(HoleRecord {
                    centre_m: self.frame.to_cloud(&patch.centre()?).into(),
                    area_m2: patch.area,
                })
            })
            .collect()
    }

    /// Point, normal and curvatures at a direction, in the frame of the cloud.
    pub fn at(&self, p: &Direction) -> SurfacePoint {
        let differential = self.shape.differential(p);
        SurfacePoint {
            position: self.frame.to_cloud(&differential.position),
            outward_normal: -differential.inward_normal,
            principal_curvatures: differential.principal_curvatures(p),
        }
    }

    /// Certified bounds of the distance of the surface from the mean of the cloud, metres; the lower one
    /// is 0 for a map of the sphere.
    pub fn radius_bounds(&self) -> (f64, f64) {
        match &self.shape {
            AnyShape::Radial(shape) => shape.radius_bounds(),
            AnyShape::Spherical(shape) => {
                let reach = |c: &Coefficients| {
                    let range = certified_range(c, OVERSAMPLING);
                    range.upper.abs().max(range.lower.abs())
                };
                let reaches = shape.coordinates().each_ref().map(reach);
                (0.0, reaches.iter().map(|r| r * r).sum::<f64>().sqrt())
            }
        }
    }

    /// The places of a map of the sphere nearest to points of the frame of the cloud, and the largest
    /// distance.
    pub(super) fn places_of(
        &self,
        field: &SphericalField,
        points: &[[f64; 3]],
    ) -> Result<(Vec<Direction>, f64), Error> {
        let finite = |p: &[f64; 3]| p.iter().all(|x| x.is_finite());
        if let Some(contact) = points.iter().position(|p| !finite(p)) {
            return Err(Error::Contact {
                object: self.name.clone(),
                contact,
                position: points[contact],
            });
        }
        let centred = points
            .iter()
            .map(|p| self.frame.to_centred(&Point3::from(*p)));
        let found = nearest_places(field, &centred.collect::<Vec<_>>());
        let farthest = found.iter().map(|(_, d)| *d).fold(0.0, f64::max);
        Ok((found.into_iter().map(|(p, _)| p).collect(), farthest))
    }
}

/// The residuals of a surface by name.
fn residuals(rms: f64, acceptance: &Acceptance) -> BTreeMap<String, f64> {
    let named = [
        ("rms_m", rms),
        ("noise_m", acceptance.noise_m),
        ("surface_rms_m", acceptance.surface_rms_m),
        ("unexplained_share", acceptance.unexplained_share),
    ];
    named.map(|(name, value)| (name.to_owned(), value)).into()
}

/// The part of a surface that a stored hole is.
fn stored_hole(
    hole: &ClosedHoleRecord,
    centre: &Point3<f64>,
) -> Result<ClosedPatch, StoredShapeError> {
    let all = hole.places_m.iter().flatten();
    if !all
        .chain([&hole.reach_m, &hole.area_m2])
        .all(|x| x.is_finite())
    {
        return Err(StoredShapeError::Hole);
    }
    Ok(ClosedPatch {
        places: hole
            .places_m
            .iter()
            .map(|p| Point3::from(*p) - centre.coords)
            .collect(),
        reach: hole.reach_m,
        area: hole.area_m2,
    })
}
