//! Carrying grasps from one shape to another (Sec. IV-E).

use grasp::{Convention, QualityError};
use nalgebra::Point3;
use shape::{DeformationError, RadialField};
use sph::Direction;

use crate::ascent::{Ascent, MonotoneAscent, PaperAscent, Step};
use crate::objective::Objective;

/// Why a transfer has no end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransferError {
    /// A quality could not be computed.
    #[error(transparent)]
    Quality(#[from] QualityError),
    /// The shapes could not be combined.
    #[error(transparent)]
    Deformation(#[from] DeformationError),
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
        Ok(Transferred {
            contacts: contacts.to_vec(),
            start_quality,
            quality: self.objective(self.to).quality_at(self.to, contacts)?,
            evaluations: 2,
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

/// Our transfer: a monotone ascent at each station, a longer one on the target, and a second path.
///
/// A continuation can follow an optimum into a poor corner, while the naive transfer may land near
/// a good one; both are climbed on the target and the better is returned, so the result is never
/// below the naive transfer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Continuation {
    /// n intervals, n + 1 stations.
    pub intervals: usize,
    /// The ascent at each station but the last.
    pub along: MonotoneAscent,
    /// The ascent on the target.
    pub at_end: MonotoneAscent,
}

impl Default for Continuation {
    /// Four intervals with short ascents, then a full one.
    fn default() -> Self {
        let at_end = MonotoneAscent::default();
        Self {
            intervals: 4,
            along: MonotoneAscent {
                steps: 20,
                ..at_end
            },
            at_end,
        }
    }
}

impl Continuation {
    /// The shapes γ(k/n), k = 0 … n; shared by all grasps of a pair.
    pub fn stations(&self, transfer: &Transfer) -> Result<Vec<RadialField>, TransferError> {
        stations(transfer, self.intervals)
    }

    /// Carries one grasp over `stations`; `trace` sees (t, state) of the continuation.
    pub fn carry(
        &self,
        transfer: &Transfer,
        stations: &[RadialField],
        contacts: &[Direction],
        mut trace: impl FnMut(f64, &Step),
    ) -> Result<Transferred, TransferError> {
        let climb = |t: f64| if t < 1.0 { self.along } else { self.at_end };
        let followed = carry_over(
            transfer,
            stations,
            contacts,
            |t, station, here, objective| {
                climb(t).climb(station, here, objective, |step| trace(t, step))
            },
        )?;
        let target = &stations[stations.len().saturating_sub(1)..];
        let jumped = carry_over(transfer, target, contacts, |_, station, here, objective| {
            self.at_end.climb(station, here, objective, |_| {})
        })?;
        let evaluations = followed.evaluations + jumped.evaluations;
        let start_quality = followed.start_quality;
        let best = if jumped.quality > followed.quality {
            jumped
        } else {
            followed
        };
        Ok(Transferred {
            evaluations,
            start_quality,
            ..best
        })
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
    };
    let last = stations.len().saturating_sub(1).max(1) as f64;
    for (k, station) in stations.iter().enumerate() {
        let mut objective = transfer.objective(station);
        let t = if k + 1 == stations.len() {
            1.0
        } else {
            k as f64 / last
        };
        let ascent = climb(t, station, &arrived.contacts, &mut objective)?;
        if k == 0 {
            arrived.start_quality = ascent.start_quality;
        }
        arrived.quality = ascent.quality;
        arrived.evaluations += ascent.evaluations;
        arrived.contacts = ascent.contacts;
    }
    Ok(arrived)
}
