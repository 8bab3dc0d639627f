//! Transfer of grasps from one shape to another (Sec. IV-E).

mod continuation;
mod correspondence;
mod jobs;

pub use continuation::{Continuation, Recovery, Splitting};
pub use correspondence::{Correspondence, distance_of};
pub use jobs::{Job, Progress, all_pairs, run_jobs};

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use grasp::{Convention, QualityError};
use nalgebra::Point3;
use shape::algebra::SpaceError;
use shape::{AnyField, Surface};
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
    pub surface: &'a AnyField,
    /// The origin of this object's own cloud frame in its centred frame, metres. It matters only
    /// for conventions that take torques about it.
    pub object_origin: Point3<f64>,
}

/// A pair of objects between which grasps are transferred, and the rule that measures quality.
///
/// ```
/// use grasp::Convention;
/// use nalgebra::Point3;
/// use shape::{AnyShape, RadialShape};
/// use space::{Transfer, TransferEnd};
///
/// let ball = |r| RadialShape::sphere(4, r).map(|ball| AnyShape::from(ball).field());
/// let (small, large) = (ball(0.03)?, ball(0.05)?);
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
///
/// Two radial surfaces correspond by their directions. Where one of the two is a map of the sphere
/// both are taken for maps, f₁ and f₂, and f₂ is first turned by the rotation R of its parameters under
/// which it is most like f₁ ([`Correspondence`]); then γ(t)(p) = (1−t) f₁(p) + t f₂(R p).
#[derive(Debug)]
pub struct Transfer<'a> {
    from: TransferEnd<'a>,
    to: TransferEnd<'a>,
    convention: &'a Convention,
    matched: Option<Matched>,
    stations: Mutex<BTreeMap<usize, Arc<[AnyField]>>>,
}

/// Both surfaces as maps of the sphere, the second with its parameters turned.
#[derive(Debug)]
struct Matched {
    correspondence: Correspondence,
    from: AnyField,
    to: AnyField,
}

impl Matched {
    /// None for two radial surfaces.
    fn new(from: &AnyField, to: &AnyField) -> Option<Self> {
        if let (AnyField::Radial(_), AnyField::Radial(_)) = (from, to) {
            return None;
        }
        let (from, to) = (from.spherical(), to.spherical());
        let correspondence = Correspondence::find(&from, &to);
        Some(Self {
            to: to.turned(&correspondence.rotation).into(),
            from: from.into_owned().into(),
            correspondence,
        })
    }
}

impl<'a> Transfer<'a> {
    /// A pair; no shape is computed yet. Where one of the surfaces is a map of the sphere this looks for
    /// the correspondence, some tenths of a second.
    pub fn new(from: TransferEnd<'a>, to: TransferEnd<'a>, convention: &'a Convention) -> Self {
        Self {
            matched: Matched::new(from.surface, to.surface),
            from,
            to,
            convention,
            stations: Mutex::default(),
        }
    }

    /// The object that the grasps come from.
    pub fn source(&self) -> &'a AnyField {
        self.from.surface
    }

    /// The object that grasps are transferred to.
    pub fn target(&self) -> &'a AnyField {
        self.to.surface
    }

    /// The correspondence of the two surfaces; `None` for two radial ones, which correspond by their
    /// directions.
    pub fn correspondence(&self) -> Option<&Correspondence> {
        self.matched.as_ref().map(|m| &m.correspondence)
    }

    /// The stations γ(k/n), 0 < k < n, that cut or fold themselves, as a fine mesh of each shows it: t, and
    /// a place in the centred frame. The shapes between two radial ones never do; M^sph is not convex.
    ///
    /// # Errors
    /// The shapes cannot be combined.
    pub fn crossing_stations(
        &self,
        intervals: usize,
    ) -> Result<Vec<(f64, Point3<f64>)>, TransferError> {
        let stations = self.stations(intervals)?;
        let between = 1..stations.len().saturating_sub(1);
        let crossing = |k: usize| match &stations[k] {
            AnyField::Radial(_) => None,
            AnyField::Spherical(field) => {
                let place = field.crossing()?;
                Some((parameter(k, stations.len()), place))
            }
        };
        Ok(between.filter_map(crossing).collect())
    }

    /// Where contacts in these directions of γ(t) would be on the source and on the target; γ(t) has them
    /// at (1−t) of the first and t of the second.
    pub fn ends_of(&self, p: &Direction) -> [Point3<f64>; 2] {
        let (from, to) = self.ends();
        [from.point(p), to.point(p)]
    }

    /// The directions on the target of contacts that have these on γ(1).
    fn on_target(&self, directions: &[Direction]) -> Vec<Direction> {
        match &self.matched {
            None => directions.to_vec(),
            Some(matched) => {
                let turn = matched.correspondence.rotation;
                directions.iter().map(|p| turn * p).collect()
            }
        }
    }

    /// γ(0) and γ(1).
    fn ends(&self) -> (&AnyField, &AnyField) {
        match &self.matched {
            None => (self.from.surface, self.to.surface),
            Some(matched) => (&matched.from, &matched.to),
        }
    }

    /// The shapes γ(k/n) = (1−k/n) r₁ + (k/n) r₂ for k = 0 … n, prepared for ascents; n is at least
    /// 1. They are cached: a second call returns the same shapes.
    ///
    /// # Errors
    /// The shapes cannot be combined.
    pub fn stations(&self, intervals: usize) -> Result<Arc<[AnyField]>, TransferError> {
        let n = intervals.max(1);
        let mut kept = self.stations.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(stations) = kept.get(&n) {
            return Ok(Arc::clone(stations));
        }
        let stations: Arc<[AnyField]> = (0..=n)
            .map(|k| self.station(k as f64 / n as f64))
            .collect::<Result<_, _>>()?;
        kept.insert(n, Arc::clone(&stations));
        Ok(stations)
    }

    /// The shape γ(t), computed at every call.
    fn station(&self, t: f64) -> Result<AnyField, TransferError> {
        let (from, to) = self.ends();
        if t >= 1.0 {
            // The target itself, with what is known of its holes.
            return Ok(to.clone());
        }
        AnyField::deformation(from, to, t).map_err(TransferError::from)
    }

    /// The origin of the user's frame on γ(t).
    fn origin(&self, t: f64) -> Point3<f64> {
        let (from, to) = (self.from.object_origin, self.to.object_origin);
        Point3::from(from.coords * (1.0 - t) + to.coords * t)
    }

    /// The objective that measures Q on the shape γ(t).
    fn objective(&self, t: f64, on: &AnyField) -> Objective {
        Objective::new(self.convention, on, &self.origin(t))
    }

    /// The naive transfer: the contacts keep their θ and φ, where one of the surfaces is a map of the
    /// sphere after the correspondence.
    ///
    /// # Errors
    /// A quality cannot be computed.
    pub fn naive(&self, directions: &[Direction]) -> Result<Transferred, TransferError> {
        let (from, to) = self.ends();
        let start_quality = self.objective(0.0, from).quality_at(from, directions)?;
        let quality = self.objective(1.0, to).quality_at(to, directions)?;
        Ok(Transferred {
            directions: self.on_target(directions),
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
    stations: &[AnyField],
    directions: &[Direction],
    mut climb: impl FnMut(f64, &AnyField, &[Direction], &mut Objective) -> Result<Ascent, QualityError>,
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
    arrived.directions = transfer.on_target(&arrived.directions);
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
