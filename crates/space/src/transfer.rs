//! Transfer of grasps from one shape to another (Sec. IV-E).

mod continuation;
mod jobs;

pub use continuation::{Continuation, Recovery, Splitting};
pub use jobs::{Job, Progress, all_pairs, run_jobs};

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use grasp::{Convention, QualityError};
use nalgebra::Point3;
use shape::RadialField;
use shape::algebra::SpaceError;
use sph::Direction;

use crate::ascent::{Ascent, PaperAscent, Step};
use crate::constraints::ConstraintError;
use crate::objective::Objective;

/// Why a transfer has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransferError {
    /// A quality could not be computed.
    #[error(transparent)]
    Quality(#[from] QualityError),
    /// The shapes could not be combined.
    #[error(transparent)]
    Deformation(#[from] SpaceError),
    /// No grasp on the target satisfies the constraints, or a constraint is not a usable number.
    #[error(transparent)]
    Constraints(#[from] ConstraintError),
}

/// The result of a transfer.
#[derive(Clone, Debug, PartialEq)]
pub struct Transferred {
    /// The directions of the contacts on the target.
    pub directions: Vec<Direction>,
    /// Q on the source, before the transfer.
    pub start_quality: f64,
    /// Q on the target.
    pub quality: f64,
    /// Number of qualities computed.
    pub evaluations: usize,
    /// Slope of Q that remains on the target, per radian ([`Ascent::stationarity`]); `None` for the
    /// naive transfer, which does not measure it.
    pub stationarity: Option<f64>,
    /// Why the grasp ended open; `None` for a closed one.
    pub open: Option<StillOpen>,
}

/// Why no closed grasp was found on the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StillOpen {
    /// Distance of the best grasp from force closure; `None` if the scheme does not measure it.
    pub distance: Option<f64>,
    /// The parameter of the curve at which closure was lost. `None` if the grasp was open from the
    /// start or was not followed.
    pub lost_at: Option<f64>,
    /// Number of ascents on the target.
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

/// One side of a transfer.
#[derive(Clone, Copy, Debug)]
pub struct TransferEnd<'a> {
    /// The surface, in its centred frame.
    pub surface: &'a RadialField,
    /// The origin of this object's own cloud frame in its centred frame, metres. It matters only
    /// for conventions that take torques about it.
    pub object_origin: Point3<f64>,
}

/// A pair of objects between which grasps are transferred, and the rule that measures quality.
///
/// ```
/// use grasp::Convention;
/// use nalgebra::Point3;
/// use shape::{RadialField, RadialShape};
/// use space::{Transfer, TransferEnd};
///
/// let [small, large] = [0.03, 0.05].map(|r| RadialShape::sphere(4, r).map(RadialField::new));
/// let (small, large) = (small?, large?);
/// let end = |surface| TransferEnd { surface, object_origin: Point3::origin() };
/// let rule = Convention::paper();
/// let pair = Transfer::new(end(&small), end(&large), &rule);
/// assert_eq!(pair.stations(10)?.len(), 11);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// The convention is a rule. It is resolved on every shape γ(t), with the origin (1−t) o₁ + t o₂,
/// so that the source's qualities refer to the source and the target's to the target. The shapes
/// γ(k/n) are computed once per pair and n, when a scheme first requests them.
#[derive(Debug)]
pub struct Transfer<'a> {
    from: TransferEnd<'a>,
    to: TransferEnd<'a>,
    convention: &'a Convention,
    stations: Mutex<BTreeMap<usize, Arc<[RadialField]>>>,
}

impl<'a> Transfer<'a> {
    /// A pair; no shape is computed yet.
    pub fn new(from: TransferEnd<'a>, to: TransferEnd<'a>, convention: &'a Convention) -> Self {
        Self {
            from,
            to,
            convention,
            stations: Mutex::default(),
        }
    }

    /// The object that the grasps come from.
    pub fn source(&self) -> &'a RadialField {
        self.from.surface
    }

    /// The object that grasps are transferred to.
    pub fn target(&self) -> &'a RadialField {
        self.to.surface
    }

    /// The shapes γ(k/n) = (1−k/n) r₁ + (k/n) r₂ for k = 0 … n, prepared for ascents; n is at least
    /// 1. They are cached: a second call returns the same shapes.
    ///
    /// # Errors
    /// The shapes cannot be combined.
    pub fn stations(&self, intervals: usize) -> Result<Arc<[RadialField]>, TransferError> {
        let n = intervals.max(1);
        let mut kept = self.stations.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(stations) = kept.get(&n) {
            return Ok(Arc::clone(stations));
        }
        let stations: Arc<[RadialField]> = (0..=n)
            .map(|k| self.station(k as f64 / n as f64))
            .collect::<Result<_, _>>()?;
        kept.insert(n, Arc::clone(&stations));
        Ok(stations)
    }

    /// The shape γ(t), computed at every call.
    fn station(&self, t: f64) -> Result<RadialField, TransferError> {
        RadialField::deformation(self.from.surface, self.to.surface, t).map_err(TransferError::from)
    }

    /// The origin of the user's frame on γ(t).
    fn origin(&self, t: f64) -> Point3<f64> {
        let (from, to) = (self.from.object_origin, self.to.object_origin);
        Point3::from(from.coords * (1.0 - t) + to.coords * t)
    }

    /// The objective that measures Q on the shape γ(t).
    fn objective(&self, t: f64, on: &RadialField) -> Objective {
        Objective::new(self.convention, on, &self.origin(t))
    }

    /// The naive transfer: the contacts keep their θ and φ.
    ///
    /// # Errors
    /// A quality cannot be computed.
    pub fn naive(&self, directions: &[Direction]) -> Result<Transferred, TransferError> {
        let (from, to) = (self.from.surface, self.to.surface);
        let start_quality = self.objective(0.0, from).quality_at(from, directions)?;
        let quality = self.objective(1.0, to).quality_at(to, directions)?;
        Ok(Transferred {
            directions: directions.to_vec(),
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

/// The paper's transfer: an ascent on each of γ(0), γ(1/n), …, γ(1) (Sec. IV-E).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperTransfer {
    /// Number n of intervals; 10 in the paper, that is, eleven stations.
    pub intervals: usize,
    /// The ascent at each station; 100 steps in the paper.
    pub ascent: PaperAscent,
}

impl PaperTransfer {
    /// The transfer of Sec. IV-E: eleven stations, 100 steps at each.
    pub const PAPER: Self = Self {
        intervals: 10,
        ascent: PaperAscent {
            steps: 100,
            ..PaperAscent::PAPER
        },
    };

    /// Transfers one grasp from the source to the target.
    ///
    /// # Errors
    /// As [`PaperTransfer::carry_traced`].
    pub fn carry(
        &self,
        transfer: &Transfer,
        directions: &[Direction],
    ) -> Result<Transferred, TransferError> {
        self.carry_traced(transfer, directions, |_, _| {})
    }

    /// The same; `trace` receives every state with the parameter t of its shape.
    ///
    /// # Errors
    /// The shapes cannot be combined, or a quality cannot be computed.
    pub fn carry_traced(
        &self,
        transfer: &Transfer,
        directions: &[Direction],
        mut trace: impl FnMut(f64, &Step),
    ) -> Result<Transferred, TransferError> {
        let stations = transfer.stations(self.intervals)?;
        carry_over(
            transfer,
            &stations,
            directions,
            |t, station, here, objective| {
                self.ascent
                    .climb(station, here, objective, |step| trace(t, step))
            },
        )
    }
}

/// Climbs on every station in turn, each time from the end of the ascent before.
fn carry_over(
    transfer: &Transfer,
    stations: &[RadialField],
    directions: &[Direction],
    mut climb: impl FnMut(
        f64,
        &RadialField,
        &[Direction],
        &mut Objective,
    ) -> Result<Ascent, QualityError>,
) -> Result<Transferred, TransferError> {
    let mut arrived = Transferred {
        directions: directions.to_vec(),
        start_quality: 0.0,
        quality: 0.0,
        evaluations: 0,
        stationarity: None,
        open: None,
    };
    let mut lost_at = None;
    for (k, station) in stations.iter().enumerate() {
        let t = parameter(k, stations.len());
        let mut objective = transfer.objective(t, station);
        let ascent = climb(t, station, &arrived.directions, &mut objective)?;
        if k == 0 {
            arrived.start_quality = ascent.start_quality;
        } else if arrived.quality > 0.0 && ascent.quality <= 0.0 {
            lost_at = Some(t);
        }
        arrived.quality = ascent.quality;
        arrived.evaluations += ascent.evaluations;
        arrived.stationarity = Some(ascent.stationarity);
        arrived.directions = ascent.directions;
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
