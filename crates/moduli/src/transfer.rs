//! Carrying grasps from one shape to another (Sec. IV-E).

use grasp::{Convention, QualityError};
use nalgebra::Point3;
use shape::RadialShape;
use shape::space::{SpaceError, deformation};
use sph::Direction;

use crate::ascent::{PaperAscent, Step};
use crate::objective::Objective;

/// Why a transfer has no end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransferError {
    /// A quality could not be computed.
    #[error(transparent)]
    Quality(#[from] QualityError),
    /// The shapes could not be combined.
    #[error(transparent)]
    Space(#[from] SpaceError),
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
    pub from: &'a RadialShape,
    /// The target.
    pub to: &'a RadialShape,
    /// The convention of Q.
    pub convention: &'a Convention,
    /// Origin of the user's frame in the centred frame; matters only to conventions that use it.
    pub object_origin: Point3<f64>,
}

impl Transfer<'_> {
    /// Q on a shape along the way.
    fn objective(&self, on: &RadialShape) -> Objective {
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
    pub fn stations(&self, transfer: &Transfer) -> Result<Vec<RadialShape>, TransferError> {
        let n = self.intervals.max(1);
        (0..=n)
            .map(|k| deformation(transfer.from, transfer.to, k as f64 / n as f64))
            .collect::<Result<_, _>>()
            .map_err(TransferError::from)
    }

    /// Carries one grasp over `stations`; `trace` sees (t, state).
    pub fn carry(
        &self,
        transfer: &Transfer,
        stations: &[RadialShape],
        contacts: &[Direction],
        mut trace: impl FnMut(f64, &Step),
    ) -> Result<Transferred, TransferError> {
        let mut here = contacts.to_vec();
        let mut start_quality = None;
        let mut quality = 0.0;
        let mut evaluations = 0;
        let last = stations.len().saturating_sub(1).max(1) as f64;
        for (k, station) in stations.iter().enumerate() {
            let mut objective = transfer.objective(station);
            let t = k as f64 / last;
            let ascent = self
                .ascent
                .climb(station, &here, &mut objective, |step| trace(t, step))?;
            start_quality.get_or_insert(ascent.start_quality);
            quality = ascent.quality;
            evaluations += ascent.evaluations;
            here = ascent.contacts;
        }
        Ok(Transferred {
            contacts: here,
            start_quality: start_quality.unwrap_or(0.0),
            quality,
            evaluations,
        })
    }
}
