//! Grasps on fitted shapes: read as directions, moved, and written in the frame of the cloud.

use std::path::Path;

use moduli::point::contacts_on;
use moduli::{Objective, Step};
use nalgebra::{Point3, Vector3};
use record::grasps::{ConventionRecord, GRASPS_VERSION, ObjectRecord, SourceRecord};
use record::{GraspRecord, GraspsFile, ShapeRecord};
use serde::Serialize;
use shape::{RadialField, Surface};
use sph::Direction;
use sph::direction::direction_and_radius;

use crate::failure::Failure;
use crate::{input, output};

/// Version of the layout of traces.
const TRACE_VERSION: u32 = 1;
/// A grasp of less quality counts as unstable.
const UNSTABLE_BELOW: f64 = 0.01;
/// Contacts farther than this from the surface, in metres, are worth a warning.
const FAR: f64 = 5e-3;
/// Rows of the table on standard output.
const SHOWN: usize = 20;

/// A shape, prepared, and where its cloud stood.
pub(crate) struct Object {
    pub(crate) record: ShapeRecord,
    pub(crate) surface: RadialField,
}

impl Object {
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let record = input::shape_record(path)?;
        let shape = record.shape().map_err(|e| Failure::input(path, e))?;
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
        let file: GraspsFile = serde_json::from_slice(&input::read(path)?)
            .map_err(|e| Failure::input(path, format!("not a grasps.json: {e}")))?;
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
                source: grasp.source.clone(),
                hand: None,
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
            },
            convention: ConventionRecord::from(objective.convention()),
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

#[derive(Serialize)]
struct TraceFile<'a> {
    version: u32,
    object: &'a str,
    scheme: &'a str,
    convention: ConventionRecord,
    grasps: Vec<GraspTrace<'a>>,
}

/// One grasp, in the order in which it was given.
#[derive(Serialize)]
struct GraspTrace<'a> {
    start_quality: f64,
    quality: f64,
    stationarity: Option<f64>,
    evaluations: usize,
    open: Option<&'a str>,
    steps: &'a [TraceStep],
}

#[derive(Serialize)]
struct Summary<'a> {
    object: &'a str,
    scheme: &'a str,
    convention: &'a str,
    grasps: usize,
    improved: usize,
    below_start: usize,
    unstable: usize,
    mean_start: f64,
    mean_final: f64,
    best: f64,
    evaluations: usize,
    seconds: f64,
    output: Option<String>,
    trace: Option<String>,
}

/// What is done with results.
pub(crate) struct Delivery<'a> {
    pub(crate) scheme: &'a str,
    pub(crate) output: Option<&'a Path>,
    pub(crate) trace: Option<&'a Path>,
    pub(crate) json: bool,
    pub(crate) seconds: f64,
}

/// Writes the files and says what happened; refuses when no grasp is closed.
pub(crate) fn deliver(
    object: &Object,
    objective: &Objective,
    moved: &[Moved],
    how: &Delivery,
) -> Result<(), Failure> {
    if let Some(path) = how.trace {
        let bytes = encode(&trace_file(object, objective, moved, how.scheme))?;
        output::write_file(path, &bytes)?;
    }
    let reason = moved.iter().find_map(|m| m.reason.as_deref());
    if moved.iter().all(|m| m.quality <= 0.0) {
        return Err(Failure::refused(format!(
            "{}: none of {} grasps is force-closed: {}; more friction (--friction) or other grasps may help",
            object.record.name,
            moved.len(),
            reason.unwrap_or("no closed grasp was found")
        )));
    }
    if let Some(path) = how.output {
        output::write_file(path, &encode(&object.file(objective, moved))?)?;
    }
    say(object, objective, moved, how)
}

fn encode(value: &impl Serialize) -> Result<Vec<u8>, Failure> {
    serde_json::to_vec_pretty(value)
        .map_err(|e| Failure::other(format!("cannot encode the result as JSON: {e}")))
}

fn trace_file<'a>(
    object: &'a Object,
    objective: &Objective,
    moved: &'a [Moved],
    scheme: &'a str,
) -> TraceFile<'a> {
    TraceFile {
        version: TRACE_VERSION,
        object: &object.record.name,
        scheme,
        convention: ConventionRecord::from(objective.convention()),
        grasps: moved
            .iter()
            .map(|m| GraspTrace {
                start_quality: m.start_quality,
                quality: m.quality,
                stationarity: m.stationarity,
                evaluations: m.evaluations,
                open: m.reason.as_deref(),
                steps: &m.steps,
            })
            .collect(),
    }
}

fn say(
    object: &Object,
    objective: &Objective,
    moved: &[Moved],
    how: &Delivery,
) -> Result<(), Failure> {
    let count = moved.len() as f64;
    let path = |p: Option<&Path>| p.map(|p| p.display().to_string());
    let line = Summary {
        object: &object.record.name,
        scheme: how.scheme,
        convention: &objective.convention().name,
        grasps: moved.len(),
        improved: moved.iter().filter(|m| m.quality > m.start_quality).count(),
        below_start: moved.iter().filter(|m| m.quality < m.start_quality).count(),
        unstable: moved.iter().filter(|m| m.quality < UNSTABLE_BELOW).count(),
        mean_start: moved.iter().map(|m| m.start_quality).sum::<f64>() / count,
        mean_final: moved.iter().map(|m| m.quality).sum::<f64>() / count,
        best: moved.iter().map(|m| m.quality).fold(0.0, f64::max),
        evaluations: moved.iter().map(|m| m.evaluations).sum(),
        seconds: how.seconds,
        output: path(how.output),
        trace: path(how.trace),
    };
    if how.json {
        return output::say_json(&line);
    }
    for (i, m) in moved.iter().enumerate().take(SHOWN) {
        let reason = m.reason.as_deref().unwrap_or("");
        output::say(format!(
            "{i:5}  {:9.5} → {:9.5}  {reason}",
            m.start_quality, m.quality
        ));
    }
    output::say(format!(
        "{} grasps on {}: mean {:.4} → {:.4}, best {:.4}, {} improved, {} below 0.01 under `{}`; {} qualities, {:.2} s",
        line.grasps,
        line.object,
        line.mean_start,
        line.mean_final,
        line.best,
        line.improved,
        line.unstable,
        line.convention,
        line.evaluations,
        line.seconds
    ));
    Ok(())
}
