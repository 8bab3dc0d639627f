//! Grasps on fitted shapes: read as directions, moved, and written in the frame of the cloud.

use std::path::Path;

use moduli::records::{convention_record, stored_shape};
use nalgebra::{Point3, Vector3};
use record::grasps::{AssessmentRecord, GRASPS_VERSION, ObjectRecord, SourceRecord};
use record::{GraspRecord, GraspsFile, ShapeRecord};
use serde::Serialize;
use shape::{RadialField, Surface};
use space::point::contacts_on;
use space::{Objective, Step};
use sph::Direction;
use sph::direction::direction_and_radius;

use crate::failure::Failure;
use crate::{input, output};

/// Contacts farther than this from the surface, in metres, are worth a warning.
const FAR: f64 = 5e-3;

/// A shape, prepared, and where its cloud stood.
pub(crate) struct Object {
    pub(crate) record: ShapeRecord,
    pub(crate) surface: RadialField,
}

impl Object {
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let record = input::shape_record(path)?;
        let shape = stored_shape(&record).map_err(|e| Failure::input(path, e))?;
        Ok(Self {
            surface: RadialField::new(shape),
            record,
        })
    }

    /// Origin of the user's frame in the centred frame.
    pub(crate) fn origin(&self) -> Point3<f64> {
        Point3::from(-self.record.centre_in_cloud().coords)
    }

    /// The grasps of a grasps.json in the frame of this object's cloud, as directions.
    pub(crate) fn grasps(&self, path: &Path) -> Result<Vec<Placed>, Failure> {
        let file = input::grasps(path)?;
        if file.grasps.is_empty() {
            return Err(Failure::input(path, "holds no grasps"));
        }
        let mut farthest = 0.0_f64;
        let mut placed = Vec::with_capacity(file.grasps.len());
        for (i, grasp) in file.grasps.into_iter().enumerate() {
            if grasp.contacts_m.is_empty() {
                return Err(Failure::input(path, format!("grasp {i} has no contacts")));
            }
            let mut directions = Vec::with_capacity(grasp.contacts_m.len());
            for (k, contact) in grasp.contacts_m.iter().enumerate() {
                let arm = Vector3::from(*contact) - self.record.centre_in_cloud().coords;
                let on = direction_and_radius(&arm).filter(|(_, r)| r.is_finite());
                let Some((p, _)) = on else {
                    return Err(Failure::input(
                        path,
                        format!(
                            "grasp {i}, contact {k} is {contact:?}; expected finite metres away from the centre of {}",
                            self.record.name
                        ),
                    ));
                };
                farthest = farthest.max((self.surface.point(&p).coords - arm).norm());
                directions.push(p);
            }
            placed.push(Placed {
                directions,
                source: grasp.source,
            });
        }
        if farthest > FAR {
            output::warn(format!(
                "{}: a contact is {:.1} mm from the surface of {}; is it the right shape, and its cloud's frame?",
                path.display(),
                1e3 * farthest,
                self.record.name
            ));
        }
        Ok(placed)
    }

    /// A file of grasps on this object, the best first.
    pub(crate) fn file(&self, objective: &Objective, moved: &[Moved]) -> GraspsFile {
        let shape = self.surface.shape();
        let (low, high) = shape.radius_bounds();
        let centre = self.record.centre_in_cloud().coords;
        let mut order: Vec<&Moved> = moved.iter().collect();
        order.sort_by(|a, b| b.quality.total_cmp(&a.quality));
        let record = |(i, grasp): (usize, &&Moved)| {
            let contacts = contacts_on(&self.surface, &grasp.directions);
            GraspRecord {
                rank: i + 1,
                quality: grasp.quality,
                contacts_m: contacts
                    .iter()
                    .map(|c| (c.position + centre).into())
                    .collect(),
                inward_normals: contacts
                    .iter()
                    .map(|c| c.inward_normal.into_inner().into())
                    .collect(),
                directions: grasp
                    .directions
                    .iter()
                    .map(|p| p.into_inner().into())
                    .collect(),
                source: grasp.source.clone(),
                hand: None,
                assessment: AssessmentRecord::default(),
            }
        };
        GraspsFile {
            version: GRASPS_VERSION,
            object: ObjectRecord {
                name: self.record.name.clone(),
                centre_m: self.record.centre_in_cloud_m,
                r_min_certified_m: low,
                r_max_certified_m: high,
                centre_of_mass_m: (shape.centre_of_mass() + centre).into(),
                volume_m3: shape.mass_properties().volume,
                ..ObjectRecord::default()
            },
            convention: convention_record(objective.convention()),
            grasps: order.iter().enumerate().map(record).collect(),
        }
    }
}

/// A grasp as it was given.
pub(crate) struct Placed {
    pub(crate) directions: Vec<Direction>,
    pub(crate) source: SourceRecord,
}

/// A grasp where it ended.
pub(crate) struct Moved {
    pub(crate) directions: Vec<Direction>,
    pub(crate) start_quality: f64,
    pub(crate) quality: f64,
    pub(crate) evaluations: usize,
    pub(crate) stationarity: Option<f64>,
    /// Why it is open.
    pub(crate) reason: Option<String>,
    pub(crate) source: SourceRecord,
    pub(crate) steps: Vec<TraceStep>,
}

/// One state on the way.
#[derive(Serialize)]
pub(crate) struct TraceStep {
    /// Parameter of the curve of shapes; 1 on the target, and throughout an ascent.
    t: f64,
    /// Contacts on the surface of that parameter, in the frame of the target's cloud.
    contacts_m: Vec<[f64; 3]>,
    quality: f64,
    /// Slope of the quality that is left, per radian.
    stationarity: f64,
}

impl TraceStep {
    pub(crate) fn new(t: f64, step: &Step, contacts_m: Vec<[f64; 3]>) -> Self {
        Self {
            t,
            contacts_m,
            quality: step.quality,
            stationarity: step.stationarity,
        }
    }
}
