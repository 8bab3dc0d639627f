//! Grasps that are moved: the start, the end, and the records.

use std::path::Path;

use moduli::grasps_file::grasp_record;
use moduli::{Measure, Object, Source};
use record::GraspsFile;
use record::grasps::SourceRecord;
use serde::Serialize;
use space::Step;
use sph::Direction;

use crate::failure::Failure;
use crate::{input, output};

/// Distance of a contact from the surface above which a warning is given, metres.
const FAR: f64 = 5e-3;
/// Distance of a contact from the surface above which positions are probably in millimetres, metres.
const IN_METRES: f64 = 2.0;

/// The grasps of a grasps.json in the frame of an object's cloud, as directions, and warnings about
/// contacts that are not on the object's surface.
pub(crate) fn given(object: &Object, path: &Path) -> Result<(Vec<Given>, Vec<String>), Failure> {
    let file = input::grasps(path)?;
    if file.grasps.is_empty() {
        return Err(Failure::input(path, "there are no grasps in the file"));
    }
    let mut farthest = 0.0_f64;
    let mut given = Vec::with_capacity(file.grasps.len());
    for (i, grasp) in file.grasps.into_iter().enumerate() {
        if grasp.contacts_m.is_empty() {
            return Err(Failure::input(path, format!("grasp {i} has no contacts")));
        }
        let (directions, off) = object
            .directions_of(&grasp.contacts_m)
            .map_err(|e| Failure::input(path, format!("grasp {i}, {e}")))?;
        farthest = farthest.max(off);
        given.push(Given {
            directions,
            source: grasp.source,
        });
    }
    let mut warnings = Vec::new();
    if farthest > FAR {
        let hint = if farthest > IN_METRES {
            "positions are expected in metres: are these millimetres?"
        } else {
            "are these grasps of another object, or in another frame than that of its cloud?"
        };
        warnings.push(format!(
            "{}: a contact is {:.1} mm from the surface of {}; {hint}",
            path.display(),
            1e3 * farthest,
            object.name()
        ));
    }
    warnings.iter().for_each(output::warn);
    Ok((given, warnings))
}

/// A file of moved grasps on one object, the best first.
pub(crate) fn file(measure: &Measure, moved: &[Moved]) -> Result<GraspsFile, Failure> {
    let mut order: Vec<&Moved> = moved.iter().collect();
    order.sort_by(|a, b| b.quality.total_cmp(&a.quality));
    let mut records = Vec::with_capacity(order.len());
    for (i, end) in order.into_iter().enumerate() {
        let grasp = measure
            .grasp(&end.directions, Source::Given)
            .map_err(|e| Failure::refused(format!("{}: {e}", measure.object().name())))?;
        let mut record = grasp_record(i + 1, &grasp, end.source.clone(), None);
        record.quality = end.quality;
        records.push(record);
    }
    Ok(measure.file_of(records))
}

/// A grasp as it was given.
pub(crate) struct Given {
    pub(crate) directions: Vec<Direction>,
    pub(crate) source: SourceRecord,
}

/// A grasp at its end.
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

/// One state of the motion.
#[derive(Serialize)]
pub(crate) struct TraceStep {
    /// Parameter of the curve of shapes; 1 on the target, and throughout an ascent.
    t: f64,
    /// Contacts on the surface of that parameter, in the frame of the target's cloud.
    contacts_m: Vec<[f64; 3]>,
    quality: f64,
    /// Stationarity: the remaining slope of the quality, per radian.
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
