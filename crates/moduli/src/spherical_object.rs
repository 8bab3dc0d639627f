//! Objects whose surface is a map of the sphere into space (M^sph of the paper).

use nalgebra::{Point3, UnitVector3};
use record::SphericalRecord;
use shape::{
    FitSettings, PointCloud, SphericalCloudFit, SphericalFit, SphericalSettings, SphericalShape,
    Surface, fit_spherical, fit_spherical_cloud,
};
use sph::{Coefficients, Direction};

use crate::error::Error;
use crate::frame::CloudFrame;
use crate::records::StoredShapeError;

/// An object whose surface is f = (x, y, z): S² → R³, proved an immersion.
///
/// Such a surface need not be star-shaped. Grasps are found on [`Object`](crate::Object)s, whose
/// surface is radial; this one can be evaluated, meshed and stored. Whether it touches itself is
/// answered by [`SphericalShape::embedding`].
#[derive(Clone, Debug)]
pub struct SphericalObject {
    name: String,
    shape: SphericalShape,
    frame: CloudFrame,
    lambda: [f64; 3],
    rms: f64,
    points: usize,
}

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

impl SphericalObject {
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
    /// use moduli::{FitSettings, PointCloud, SphericalObject};
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
    /// let egg = SphericalObject::fit("egg", &cloud, &directions, &settings)?;
    /// let top = egg.at(&UnitVector3::new_normalize(Vector3::z()));
    /// assert!((top.position.z - 0.05).abs() < 1e-4);
    /// # Ok::<(), moduli::Error>(())
    /// ```
    pub fn fit(
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
        Ok(Self::from_fit(name, fit, points))
    }

    /// Fits a surface to a cloud of any closed object without given directions.
    ///
    /// The cloud is wrapped in a mesh of genus zero, which is mapped onto the sphere; see
    /// [`fit_spherical_cloud`]. Handles are closed: take [`fit_spherical_cloud`] and
    /// [`SphericalObject::from_cloud_fit`] to know which. A few seconds at degree 50.
    ///
    /// # Errors
    /// The cloud cannot be wrapped or mapped, every fit cuts itself, or none is proved an immersion.
    pub fn from_cloud(
        name: &str,
        cloud: &PointCloud,
        settings: &SphericalSettings,
    ) -> Result<Self, Error> {
        Ok(Self::from_cloud_fit(
            name,
            fit_spherical_cloud(cloud, settings)?,
        ))
    }

    /// The object of a fit without given directions.
    pub fn from_cloud_fit(name: &str, fit: SphericalCloudFit) -> Self {
        Self {
            name: name.to_owned(),
            shape: fit.shape,
            frame: CloudFrame::new(fit.centre_in_cloud),
            lambda: [fit.lambda; 3],
            rms: fit.surface_rms,
            points: fit.points,
        }
    }

    /// The object of a fit of `points` points.
    pub fn from_fit(name: &str, fit: SphericalFit, points: usize) -> Self {
        Self {
            name: name.to_owned(),
            shape: fit.shape,
            frame: CloudFrame::new(fit.centre_in_cloud),
            lambda: fit.lambda,
            rms: fit.rms,
            points,
        }
    }

    /// A stored surface. It is proved an immersion again, because a stored claim is not a proof.
    ///
    /// # Errors
    /// A number is not finite, or the map is not proved an immersion.
    pub fn from_record(record: &SphericalRecord) -> Result<Self, Error> {
        if !record.centre_in_cloud_m.iter().all(|x| x.is_finite()) {
            return Err(StoredShapeError::Centre.into());
        }
        let axis = |k: usize| {
            Coefficients::new(record.coordinates[k].clone()).map_err(StoredShapeError::from)
        };
        let shape = SphericalShape::new(axis(0)?, axis(1)?, axis(2)?)
            .map_err(StoredShapeError::Spherical)?;
        Ok(Self {
            name: record.name.clone(),
            shape,
            frame: CloudFrame::new(record.centre_in_cloud_m.into()),
            lambda: record.lambda,
            rms: record.rms_m,
            points: usize::try_from(record.points).unwrap_or(usize::MAX),
        })
    }

    /// The record in which the object is stored.
    pub fn to_record(&self) -> SphericalRecord {
        let coordinates = self.shape.coordinates().each_ref();
        SphericalRecord {
            name: self.name.clone(),
            coordinates: coordinates.map(|c| c.as_slice().to_vec()),
            centre_in_cloud_m: self.frame.centre_in_cloud().into(),
            lambda: self.lambda,
            rms_m: self.rms,
            points: self.points as u64,
        }
    }

    /// Name of the object.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The surface, in the centred frame.
    pub fn shape(&self) -> &SphericalShape {
        &self.shape
    }

    /// The way between the centred frame and that of the cloud.
    pub fn frame(&self) -> &CloudFrame {
        &self.frame
    }

    /// Weights λ of the penalties of x, y and z.
    pub fn lambda(&self) -> [f64; 3] {
        self.lambda
    }

    /// Root mean square of the distances |f(pᵢ) − xᵢ|, metres.
    pub fn rms(&self) -> f64 {
        self.rms
    }

    /// Number of points that were fitted.
    pub fn points(&self) -> usize {
        self.points
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
}
