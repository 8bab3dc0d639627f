//! An object: its surface, where its cloud stood, and how well the surface fits.

use std::sync::OnceLock;

use nalgebra::{Point3, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use record::ShapeRecord;
use record::grasps::ObjectRecord;
use shape::io::{Format, Loaded, read_cloud};
use shape::{Fit, FitSettings, Misfit, PointCloud, RadialField, RadialShape, Surface};
use sph::Direction;
use sph::direction::direction_and_radius;

use crate::error::Error;
use crate::frame::CloudFrame;
use crate::records::stored_shape;

/// Share of the directions without a point above which the surface there is said to be a guess.
const GUESSED: f64 = 0.1;
/// Degree of the harmonics of a fit, as in the paper.
const DEGREE: usize = 50;

/// An object with a surface whose validity is proved.
///
/// The surface is the radial function r(p) > 0 over the directions p seen from the mean of the cloud
/// (M^rad of the paper), in the *centred* frame. What a caller gives and gets is in the frame of the
/// *cloud*.
#[derive(Clone, Debug)]
pub struct Object {
    name: String,
    shape: RadialShape,
    field: OnceLock<RadialField>,
    frame: CloudFrame,
    report: FitReport,
}

/// How a surface came about and how well it fits.
#[derive(Clone, Debug, Default)]
pub struct FitReport {
    /// Points that were fitted; 0 for a surface that was not fitted.
    pub points: usize,
    /// Root mean square of the radial residuals, metres.
    pub rms: f64,
    /// Weight λ of the penalty.
    pub lambda: f64,
    /// Largest residual, metres; `None` for a surface that was read back or made.
    pub max_abs: Option<f64>,
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
        let settings = FitSettings {
            degree: DEGREE,
            lambda: None,
        };
        let mut object = Self::from_cloud("object", &cloud, &settings)?;
        object.report.warnings.splice(0..0, of_file);
        Ok(object)
    }

    /// Fits a cloud, metres.
    ///
    /// # Errors
    /// The cloud has no proved surface.
    pub fn from_cloud(
        name: &str,
        cloud: &PointCloud,
        settings: &FitSettings,
    ) -> Result<Self, Error> {
        let fit = shape::fit::fit(cloud, settings)?;
        Ok(Self::from_fit(name, fit, cloud.points().len()))
    }

    /// The object of a fit of `points` points.
    pub fn from_fit(name: &str, fit: Fit, points: usize) -> Self {
        Self {
            name: name.to_owned(),
            field: OnceLock::new(),
            frame: CloudFrame::new(fit.centre_in_cloud),
            report: FitReport {
                points,
                rms: fit.rms,
                lambda: fit.lambda,
                max_abs: Some(fit.max_abs),
                warnings: warnings(&fit),
            },
            shape: fit.shape,
        }
    }

    /// A surface that was made and not fitted; its centred frame is that of the cloud.
    pub fn from_shape(name: &str, shape: RadialShape) -> Self {
        Self {
            name: name.to_owned(),
            shape,
            field: OnceLock::new(),
            frame: CloudFrame::new(Point3::origin()),
            report: FitReport::default(),
        }
    }

    /// A stored shape. Its surface is proved again, because a stored claim is not a proof.
    ///
    /// # Errors
    /// A number is not finite, or the radius is not proved positive.
    pub fn from_record(record: &ShapeRecord) -> Result<Self, Error> {
        let shape = stored_shape(record)?;
        // The largest residual is not stored: the root mean square stands for both.
        let misfit = Misfit::found(record.rms_m, record.rms_m, shape.mean_radius());
        Ok(Self {
            name: record.name.clone(),
            shape,
            field: OnceLock::new(),
            frame: CloudFrame::new(record.centre_in_cloud()),
            report: FitReport {
                points: usize::try_from(record.points).unwrap_or(usize::MAX),
                rms: record.rms_m,
                lambda: record.lambda,
                max_abs: None,
                warnings: misfit.iter().map(Misfit::to_string).collect(),
            },
        })
    }

    /// The record in which the object is stored.
    pub fn to_record(&self) -> ShapeRecord {
        ShapeRecord {
            name: self.name.clone(),
            coefficients: self.shape.coefficients().as_slice().to_vec(),
            centre_in_cloud_m: self.frame.centre_in_cloud().into(),
            lambda: self.report.lambda,
            rms_m: self.report.rms,
            points: self.report.points as u64,
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
    pub fn shape(&self) -> &RadialShape {
        &self.shape
    }

    /// The surface prepared for reading r, ∇r and ∇²r anywhere in a fraction of a microsecond.
    /// Prepared on the first call and kept.
    pub fn field(&self) -> &RadialField {
        self.field
            .get_or_init(|| RadialField::new(self.shape.clone()))
    }

    /// How the surface came about.
    pub fn report(&self) -> &FitReport {
        &self.report
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
    /// point from the surface along its direction, metres.
    ///
    /// # Errors
    /// A point is not finite, or lies at the centre.
    pub fn directions_of(&self, points: &[[f64; 3]]) -> Result<(Vec<Direction>, f64), Error> {
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
        let (low, high) = self.shape.radius_bounds();
        ObjectRecord {
            name: self.name.clone(),
            centre_m: self.frame.centre_in_cloud().into(),
            r_min_certified_m: low,
            r_max_certified_m: high,
            centre_of_mass_m: self.frame.to_cloud(&self.shape.centre_of_mass()).into(),
            volume_m3: self.shape.mass_properties().volume,
            warnings: self.report.warnings.clone(),
            ..ObjectRecord::default()
        }
    }
}

/// What the user should know about a fit.
fn warnings(fit: &Fit) -> Vec<String> {
    let unseen = (fit.visibility.unobserved > GUESSED).then(|| {
        format!(
            "no point is seen in {:.0} % of the directions from the mean; the surface there is extrapolated",
            100.0 * fit.visibility.unobserved
        )
    });
    let misfit = fit.misfit().map(|misfit| misfit.to_string());
    unseen.into_iter().chain(misfit).collect()
}
