//! An object: its surface, where its cloud stood, and how well the surface fits.

mod reconstruction;
mod spherical;

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use hand::{PointTree, Surroundings};
use nalgebra::{Point3, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use record::grasps::{ObjectRecord, SurfaceModel};
use record::{Kind, ShapeNotes, ShapeRecord, SphericalRecord};
use shape::io::{Format, Loaded, read_cloud};
use shape::{
    Acceptance, AnyField, AnyShape, Embedding, Fit, FitSettings, PointCloud, Scene, Support,
    Surface, Verdict,
};
use sph::Direction;
use sph::direction::direction_and_radius;

use crate::error::Error;
use crate::frame::CloudFrame;
use crate::records::{scene_record, stored_shape, stored_support, support_record};

use reconstruction::accepted;
pub use reconstruction::{
    Fitted, Model, Reconstruction, ReconstructionSettings, object_points, reconstruct, scene_notes,
};
pub use spherical::SurfacePoint;

/// Share of the directions without a point above which the surface there is said to be a guess.
const GUESSED: f64 = 0.02;
/// A largest residual above this share of the mean radius is said: a surface so steep is seldom one body.
const STEEP: f64 = 0.5;
/// Degree of the harmonics of a fit, as in the paper.
const DEGREE: usize = 50;

/// An object with a surface whose validity is proved.
///
/// The surface is a radius r(p) > 0 over the directions p seen from the mean of the cloud (M^rad of the
/// paper), or a map of the sphere into space, proved an immersion (M^sph), which need not be star-shaped.
/// Both are in the *centred* frame. What a caller gives and gets is in the frame of the *cloud*.
#[derive(Clone, Debug)]
pub struct Object {
    name: String,
    shape: AnyShape,
    field: OnceLock<AnyField>,
    frame: CloudFrame,
    support: Option<Support>,
    surroundings: Arc<Surroundings>,
    report: FitReport,
}

/// How a surface came about and how well it fits.
#[derive(Clone, Debug, Default)]
pub struct FitReport {
    /// Points that were fitted; 0 for a surface that was not fitted.
    pub points: usize,
    /// Root mean square of the radial residuals, metres.
    pub rms: f64,
    /// Weight λ of the penalty; of the coordinate x for a map of the sphere.
    pub lambda: f64,
    /// Weights λ of x, y and z for a map of the sphere.
    pub lambda_xyz: Option<[f64; 3]>,
    /// Whether a map of the sphere is proved not to touch itself; `None` for a radial surface, which never
    /// does, and for a surface that was read back or made.
    pub embedding: Option<Embedding>,
    /// Largest residual, metres; `None` for a surface that was read back or made.
    pub max_abs: Option<f64>,
    /// How well the surface explains its points; `None` for a surface that was read back or made.
    pub acceptance: Option<Acceptance>,
    /// How the cloud was taken apart; `None` where it was not. Its list of the object's points is empty.
    pub scene: Option<Scene>,
    /// Residuals by name, as they are stored: `noise_m`, `surface_rms_m`, `unexplained_share`, `rms_m`.
    pub residuals: BTreeMap<String, f64>,
    /// What the user should know about the surface, a sentence each: rows that were dropped, a unit
    /// that looks wrong, directions that hold no point, points that the surface does not explain.
    pub warnings: Vec<String>,
}

impl Object {
    /// Fits the cloud or mesh in `bytes` at degree 50, the penalty chosen from the data.
    ///
    /// Lengths are metres. A mesh is sampled by area at 25,000 points with a fixed seed. For other
    /// settings see [`Object::from_cloud`]. Costs 0.1 to 0.3 s for 25,000 points.
    ///
    /// # Errors
    /// The bytes are not of that format, or the cloud has no proved surface.
    pub fn from_bytes(bytes: &[u8], format: Format) -> Result<Self, Error> {
        let loaded = read_cloud(bytes, &format.to_string())?;
        let of_file: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
        let mut generator = ChaCha8Rng::seed_from_u64(0);
        let cloud = loaded.cloud(Loaded::MESH_SAMPLES, &mut generator)?;
        let settings = ReconstructionSettings::new(FitSettings {
            degree: DEGREE,
            lambda: None,
        });
        let mut object = reconstruct("object", &cloud, &settings)?.object;
        object.report.warnings.splice(0..0, of_file);
        Ok(object)
    }

    /// Fits all points of a cloud, metres, as they are: repeated points count as often as they are given,
    /// nothing is taken for a table, and a surface that does not explain its points is not refused but
    /// has a warning. [`reconstruct`] is the careful way.
    ///
    /// # Errors
    /// The cloud has no proved surface.
    pub fn from_cloud(
        name: &str,
        cloud: &PointCloud,
        settings: &FitSettings,
    ) -> Result<Self, Error> {
        let fit = shape::fit::fit(cloud, settings)?;
        let object = Self::from_fit(name, fit.clone(), cloud.points().len());
        let acceptance = accepted(&object, &fit, cloud);
        Ok(object.with_acceptance(acceptance))
    }

    /// The object of a fit of `points` points.
    pub fn from_fit(name: &str, fit: Fit, points: usize) -> Self {
        Self {
            name: name.to_owned(),
            field: OnceLock::new(),
            frame: CloudFrame::new(fit.centre_in_cloud),
            support: None,
            surroundings: Arc::default(),
            report: FitReport {
                points,
                rms: fit.rms,
                lambda: fit.lambda,
                max_abs: Some(fit.max_abs),
                residuals: BTreeMap::from([("rms_m".to_owned(), fit.rms)]),
                warnings: warnings(&fit),
                ..FitReport::default()
            },
            shape: fit.shape.into(),
        }
    }

    /// The object with the verdict on its surface, which is a warning where points are not explained.
    pub(crate) fn with_acceptance(mut self, acceptance: Acceptance) -> Self {
        let report = &mut self.report;
        if acceptance.verdict() != Verdict::Explained {
            report.warnings.push(acceptance.to_string());
        }
        let named = [
            ("noise_m", acceptance.noise_m),
            ("surface_rms_m", acceptance.surface_rms_m),
            ("unexplained_share", acceptance.unexplained_share),
        ];
        let named = named.map(|(name, value)| (name.to_owned(), value));
        report.residuals.extend(named);
        report.acceptance = Some(acceptance);
        self
    }

    /// The object with the scene in which it was found; `notes` are sentences about what was left out.
    pub(crate) fn with_scene(mut self, mut scene: Scene, notes: Vec<String>) -> Self {
        scene.object = Vec::new();
        scene.others = Vec::new();
        self.support = scene.support.map(|(plane, _)| plane);
        self.report.warnings.splice(0..0, notes);
        self.report.scene = Some(scene);
        self
    }

    /// The object among other pieces of its scene, with the points of its scan, both in the frame of the
    /// cloud: hands stay away from the pieces, and links that hold points of the scan are refused.
    #[must_use]
    pub fn with_surroundings(self, obstacles: &[Point3<f64>], scan: &[Point3<f64>]) -> Self {
        let centre = self.frame.to_cloud(&Point3::origin()).coords;
        let centred =
            |points: &[Point3<f64>]| PointTree::new(points.iter().map(|p| p - centre).collect());
        let noise = self.report.acceptance.map_or(0.0, |a| a.noise_m);
        Self {
            surroundings: Arc::new(Surroundings {
                obstacles: centred(obstacles),
                cloud: centred(scan),
                noise,
            }),
            ..self
        }
    }

    /// What hands stay away from besides the surface, in the centred frame.
    pub fn surroundings(&self) -> &Arc<Surroundings> {
        &self.surroundings
    }

    /// The object standing on a plane, or on none.
    pub fn with_support(self, support: Option<Support>) -> Self {
        Self { support, ..self }
    }

    /// A surface that was made and not fitted; its centred frame is that of the cloud.
    pub fn from_shape(name: &str, shape: impl Into<AnyShape>) -> Self {
        Self {
            name: name.to_owned(),
            shape: shape.into(),
            field: OnceLock::new(),
            frame: CloudFrame::new(Point3::origin()),
            support: None,
            surroundings: Arc::default(),
            report: FitReport::default(),
        }
    }

    /// A stored radial shape. Its surface is proved again, because a stored claim is not a proof.
    ///
    /// # Errors
    /// A number is not finite, or the radius is not proved positive.
    pub fn from_record(record: &ShapeRecord) -> Result<Self, Error> {
        let shape = stored_shape(record)?;
        Ok(Self {
            name: record.name.clone(),
            shape: shape.into(),
            field: OnceLock::new(),
            frame: CloudFrame::new(record.centre_in_cloud()),
            support: stored_support(record.notes.support.as_ref())?,
            surroundings: Arc::default(),
            report: FitReport {
                points: usize::try_from(record.points).unwrap_or(usize::MAX),
                rms: record.rms_m,
                lambda: record.lambda,
                residuals: record.notes.residuals.clone(),
                warnings: record.notes.warnings.clone(),
                ..FitReport::default()
            },
        })
    }

    /// The record in which the object is stored; `None` if its surface is a map of the sphere, see
    /// [`Object::to_spherical_record`].
    pub fn to_record(&self) -> Option<ShapeRecord> {
        Some(ShapeRecord {
            name: self.name.clone(),
            coefficients: self.shape.radial()?.coefficients().as_slice().to_vec(),
            centre_in_cloud_m: self.frame.centre_in_cloud().into(),
            lambda: self.report.lambda,
            rms_m: self.report.rms,
            points: self.report.points as u64,
            notes: self.notes(),
        })
    }

    fn notes(&self) -> ShapeNotes {
        ShapeNotes {
            support: self.support.as_ref().map(support_record),
            residuals: self.report.residuals.clone(),
            warnings: self.report.warnings.clone(),
        }
    }

    /// The object of a shape file of either kind. Its surface is proved again.
    ///
    /// # Errors
    /// The bytes are not a shape file, or its surface is not proved valid.
    pub fn from_shape_file(bytes: &[u8]) -> Result<Self, Error> {
        if record::envelope::kind_of(bytes) == Some(Kind::Spherical) {
            return Self::from_spherical_record(&SphericalRecord::from_bytes(bytes)?);
        }
        Self::from_record(&ShapeRecord::from_bytes(bytes)?)
    }

    /// The bytes of the shape file of this object.
    ///
    /// # Errors
    /// The record is larger than 256 MiB.
    pub fn to_shape_file(&self) -> Result<Vec<u8>, Error> {
        match (self.to_record(), self.to_spherical_record()) {
            (Some(record), _) => Ok(record.to_bytes()?),
            (None, Some(record)) => Ok(record.to_bytes()?),
            (None, None) => Ok(Vec::new()),
        }
    }

    /// Gives the object another name.
    pub fn named(self, name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..self
        }
    }

    /// Adds sentences that the user should know, to be kept with every result on this object.
    #[must_use]
    pub fn with_warnings(mut self, warnings: impl IntoIterator<Item = String>) -> Self {
        self.report.warnings.extend(warnings);
        self
    }

    /// Name of the object.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The surface, in the centred frame.
    pub fn shape(&self) -> &AnyShape {
        &self.shape
    }

    /// How the surface is represented.
    pub fn model(&self) -> SurfaceModel {
        match self.shape {
            AnyShape::Radial(_) => SurfaceModel::Radial,
            AnyShape::Spherical(_) => SurfaceModel::Spherical,
        }
    }

    /// The surface prepared for reading its points and derivatives anywhere in at most a microsecond.
    /// Prepared on the first call and kept.
    pub fn field(&self) -> &AnyField {
        self.field.get_or_init(|| self.shape.field())
    }

    /// How the surface came about.
    pub fn report(&self) -> &FitReport {
        &self.report
    }

    /// The plane on which the object stands, in the frame of the cloud; `None` where it is not known.
    pub fn support(&self) -> Option<&Support> {
        self.support.as_ref()
    }

    /// The way between the centred frame and that of the cloud.
    pub fn frame(&self) -> &CloudFrame {
        &self.frame
    }

    /// The point of the surface in direction `p`, in the frame of the cloud, metres.
    pub fn point_in_cloud(&self, p: &Direction) -> Point3<f64> {
        self.frame.to_cloud(&self.shape.point(p))
    }

    /// The directions of points given in the frame of the cloud, and the largest distance of such a
    /// point from the surface along its direction, metres. On a map of the sphere they are the places
    /// nearest to the points.
    ///
    /// # Errors
    /// A point is not finite, or lies at the centre of a radial surface.
    pub fn directions_of(&self, points: &[[f64; 3]]) -> Result<(Vec<Direction>, f64), Error> {
        if let AnyField::Spherical(field) = self.field() {
            return self.places_of(field, points);
        }
        let mut farthest = 0.0_f64;
        let mut directions = Vec::with_capacity(points.len());
        for (contact, &position) in points.iter().enumerate() {
            let arm = Vector3::from(position) - self.frame.centre_in_cloud().coords;
            let on = direction_and_radius(&arm).filter(|(_, r)| r.is_finite());
            let Some((p, _)) = on else {
                return Err(Error::Contact {
                    object: self.name.clone(),
                    contact,
                    position,
                });
            };
            farthest = farthest.max((self.field().point(&p).coords - arm).norm());
            directions.push(p);
        }
        Ok((directions, farthest))
    }

    /// What `grasps.json` says of the object.
    pub fn object_record(&self) -> ObjectRecord {
        let (low, high) = self.radius_bounds();
        ObjectRecord {
            name: self.name.clone(),
            centre_m: self.frame.centre_in_cloud().into(),
            r_min_certified_m: low,
            r_max_certified_m: high,
            centre_of_mass_m: self.frame.to_cloud(&self.shape.centre_of_mass()).into(),
            volume_m3: self.shape.mass_properties().volume,
            closed_holes: self.hole_records(),
            model: Some(self.model()),
            residuals: self.report.residuals.clone(),
            support: self.support.as_ref().map(support_record),
            scene: self.report.scene.as_ref().map(scene_record),
            warnings: self.report.warnings.clone(),
        }
    }
}

/// What the user should know about a fit.
fn warnings(fit: &Fit) -> Vec<String> {
    let unobserved = (fit.visibility.unobserved > GUESSED).then(|| {
        format!(
            "no point is seen in {:.0} % of the directions from the mean; the surface there is extrapolated",
            100.0 * fit.visibility.unobserved
        )
    });
    let largest = fit.max_abs;
    let steep = (largest > STEEP * fit.shape.mean_radius()).then(|| {
        format!(
            "the largest residual along a direction from the mean is {:.0} mm, more than half the mean radius: a rod, a finger of the robot or another object may be part of the cloud",
            1e3 * largest
        )
    });
    unobserved.into_iter().chain(steep).collect()
}
