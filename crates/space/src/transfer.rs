//! Carrying grasps from one shape to another (Sec. IV-E).

mod continuation;
mod matrix;

pub use continuation::{Continuation, Recovery, Splitting};
pub use matrix::{Job, Matrix, Progress, all_pairs, run_jobs};

use grasp::{Convention, QualityError};
use nalgebra::Point3;
use shape::RadialField;
use shape::algebra::SpaceError;
use sph::Direction;

use crate::ascent::{Ascent, PaperAscent, Step};
use crate::constraints::ConstraintError;
use crate::objective::Objective;

/// Why a transfer has no end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransferError {
    /// A quality could not be computed.
    #[error(transparent)]
    Quality(#[from] QualityError),
    /// The shapes could not be combined.
    #[error(transparent)]
    Deformation(#[from] SpaceError),
    /// Nothing on the target keeps the limits, or they are no numbers.
    #[error(transparent)]
    Constraints(#[from] ConstraintError),
    /// A job names an object or a grasp that is not there.
    #[error("no transfer of grasp {} from object {} to object {}", job.grasp, job.from, job.to)]
    Job {
        /// The job.
        job: Job,
    },
}

/// A grasp that has arrived.
#[derive(Clone, Debug, PartialEq)]
pub struct Transferred {
    /// Contacts on the target.
    pub contacts: Vec<Direction>,
    /// Q on the source, before anything moved.
    pub start_quality: f64,
    /// Q on the target.
    pub quality: f64,
    /// Qualities computed on the way.
    pub evaluations: usize,
    /// Slope of Q that is left on the target, per radian ([`Ascent::stationarity`]); not measured
    /// by the naive transfer.
    pub stationarity: Option<f64>,
    /// Why the grasp ended open; none for a closed one.
    pub open: Option<StillOpen>,
}

/// Why no closed grasp was found on the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StillOpen {
    /// Distance of the best grasp from force closure, where the scheme measures it.
    pub distance: Option<f64>,
    /// The parameter of the curve at which closure was lost; none when the grasp was open from the
    /// start or was never followed.
    pub lost_at: Option<f64>,
    /// Climbs made on the target.
    pub climbs: usize,
}

impl std::fmt::Display for StillOpen {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "no closed grasp after {} climbs on the target",
            self.climbs
        )?;
        if let Some(distance) = self.distance {
            write!(f, ", the best is {distance:.4} from closure")?;
        }
        match self.lost_at {
            Some(t) => write!(f, "; closure was lost at t = {t:.3}"),
            None => write!(f, "; no path kept closure"),
        }
    }
}

/// What both schemes need: where from, where to, and how quality is measured.
#[derive(Clone, Copy, Debug)]
pub struct Transfer<'a> {
    /// The known object.
    pub from: &'a RadialField,
    /// The target.
    pub to: &'a RadialField,
    /// The convention of Q.
    pub convention: &'a Convention,
    /// Origin of the user's frame in the centred frame; matters only to conventions that use it.
    pub object_origin: Point3<f64>,
}

impl Transfer<'_> {
    /// Q on a shape along the way.
    fn objective(&self, on: &RadialField) -> Objective {
        Objective::new(self.convention, on, &self.object_origin)
    }

    /// The naive transfer: the contacts keep their θ and φ.
    pub fn naive(&self, contacts: &[Direction]) -> Result<Transferred, TransferError> {
        let start_quality = self.objective(self.from).quality_at(self.from, contacts)?;
        let quality = self.objective(self.to).quality_at(self.to, contacts)?;
        Ok(Transferred {
            contacts: contacts.to_vec(),
            start_quality,
            quality,
            evaluations: 2,
            stationarity: None,
            open: (quality <= 0.0).then_some(StillOpen {
                distance: None,
                lost_at: None,
                climbs: 0,
            }),
        })
    }
}

/// The paper's transfer: γ(0), γ(1/n), …, γ(1), an ascent at each (Sec. IV-E).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperTransfer {
    /// n; 10 in the paper, so eleven stations.
    pub intervals: usize,
    /// The ascent at each station; 100 steps in the paper.
    pub ascent: PaperAscent,
}

impl PaperTransfer {
    /// The shapes γ(k/n), k = 0 … n; shared by all grasps of a pair.
    pub fn stations(&self, transfer: &Transfer) -> Result<Vec<RadialField>, TransferError> {
        stations(transfer, self.intervals)
    }

    /// Carries one grasp over `stations`; `trace` sees (t, state).
    pub fn carry(
        &self,
        transfer: &Transfer,
        stations: &[RadialField],
        contacts: &[Direction],
        mut trace: impl FnMut(f64, &Step),
    ) -> Result<Transferred, TransferError> {
        carry_over(
            transfer,
            stations,
            contacts,
            |t, station, here, objective| {
                self.ascent
                    .climb(station, here, objective, |step| trace(t, step))
            },
        )
    }
}

fn stations(transfer: &Transfer, intervals: usize) -> Result<Vec<RadialField>, TransferError> {
    let n = intervals.max(1);
    (0..=n)
        .map(|k| RadialField::deformation(transfer.from, transfer.to, k as f64 / n as f64))
        .collect::<Result<_, _>>()
        .map_err(TransferError::from)
}

/// Climbs at every station in turn, each from where the one before ended.
fn carry_over(
    transfer: &Transfer,
    stations: &[RadialField],
    contacts: &[Direction],
    mut climb: impl FnMut(
        f64,
        &RadialField,
        &[Direction],
        &mut Objective,
    ) -> Result<Ascent, QualityError>,
) -> Result<Transferred, TransferError> {
    let mut arrived = Transferred {
        contacts: contacts.to_vec(),
        start_quality: 0.0,
        quality: 0.0,
        evaluations: 0,
        stationarity: None,
        open: None,
    };
    let mut lost_at = None;
    for (k, station) in stations.iter().enumerate() {
        let mut objective = transfer.objective(station);
        let t = parameter(k, stations.len());
        let ascent = climb(t, station, &arrived.contacts, &mut objective)?;
        if k == 0 {
            arrived.start_quality = ascent.start_quality;
        } else if arrived.quality > 0.0 && ascent.quality <= 0.0 {
            lost_at = Some(t);
        }
        arrived.quality = ascent.quality;
        arrived.evaluations += ascent.evaluations;
        arrived.stationarity = Some(ascent.stationarity);
        arrived.contacts = ascent.contacts;
    }
    arrived.open = (arrived.quality <= 0.0).then_some(StillOpen {
        distance: None,
        lost_at,
        climbs: 1,
    });
    Ok(arrived)
}

/// t of station k of `count`.
fn parameter(k: usize, count: usize) -> f64 {
    if k + 1 >= count {
        1.0
    } else {
        k as f64 / (count - 1) as f64
    }
}
