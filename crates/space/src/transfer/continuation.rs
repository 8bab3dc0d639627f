//! Our transfer: a continuation along γ with adaptive steps and restarts.

use grasp::QualityError;
use shape::AnyField;
use sph::Direction;
use sph::direction::angle;

use super::{StillOpen, Transfer, TransferError, Transferred, parameter};
use crate::ascent::{Ascent, AscentError, MonotoneAscent, Step};
use crate::constraints::{ConstraintError, Constraints};
use crate::multistart::nearby;
use crate::objective::Objective;
use crate::quality::Quality;

/// A monotone ascent on each station of γ, a longer one on the target, and recovery from poor ends.
///
/// A continuation can follow an optimum into a poor local maximum, while the naive transfer may
/// start near a good one. So the target is climbed from both, poor ends are recovered from, and the
/// best is returned. The result is never below the naive transfer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Continuation {
    /// Number n of intervals; there are n + 1 stations.
    pub intervals: usize,
    /// The ascent on every station but the last.
    pub along: MonotoneAscent,
    /// The ascent on the target.
    pub at_end: MonotoneAscent,
    /// When an interval is divided into two halves.
    pub splitting: Splitting,
    /// What is tried when the end is poor; `None` for nothing.
    pub recovery: Option<Recovery>,
}

/// When an interval between stations is halved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splitting {
    /// Largest number of times that an interval is halved.
    pub depth: usize,
    /// Split if the quality after the ascent is below this share of the quality before the
    /// interval.
    pub least_kept: f64,
    /// Split if the ascent moves a contact farther than this, radians.
    pub longest_move: f64,
}

/// Multistart around the naive transfer and around the best end, and a second continuation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recovery {
    /// Recover if the quality is below this share of the source's quality; ∞ for always.
    pub below: f64,
    /// Number of starts evaluated, at one quality each.
    pub probes: usize,
    /// Number of ascents, from the best of those starts.
    pub climbs: usize,
    /// Largest move of a contact to a start, radians.
    pub spread: f64,
    /// Intervals of a second continuation, made if the end is still poor; 0 for none.
    pub intervals: usize,
    /// Number of last ascents from close around the best end. Under friction pyramids Q is
    /// discontinuous where their frames are, and an ascent can end at such a discontinuity.
    pub polish: usize,
}

impl Default for Continuation {
    /// Four intervals with short ascents, then a full one; recovery if more than a quarter of the
    /// quality is lost.
    fn default() -> Self {
        let at_end = MonotoneAscent::default();
        Self {
            intervals: 4,
            along: MonotoneAscent {
                steps: 20,
                restarts: 0,
                ..at_end
            },
            at_end: MonotoneAscent {
                restarts: 0,
                ..at_end
            },
            splitting: Splitting {
                depth: 2,
                least_kept: 0.5,
                longest_move: 0.8,
            },
            recovery: Some(Recovery {
                below: 0.75,
                probes: 24,
                climbs: 3,
                spread: 0.7,
                intervals: 7,
                polish: 0,
            }),
        }
    }
}

impl Continuation {
    /// Always recovers, and from more starts. Costs about six times the qualities; for ends that
    /// nearby starts rarely improve.
    pub fn thorough() -> Self {
        Self {
            recovery: Some(Recovery {
                below: f64::INFINITY,
                probes: 128,
                climbs: 12,
                spread: 0.9,
                intervals: 7,
                polish: 6,
            }),
            ..Self::default()
        }
    }

    /// Transfers one grasp from the source to the target.
    ///
    /// # Errors
    /// As [`Continuation::carry_traced`].
    pub fn carry(
        &self,
        transfer: &Transfer,
        directions: &[Direction],
    ) -> Result<Transferred, TransferError> {
        self.carry_traced(transfer, directions, &Constraints::default(), |_, _| {})
    }

    /// The same within hard constraints, which hold on every station and for everything that
    /// recovery tries. `trace` receives (t, state) of the first continuation.
    ///
    /// The start is first moved inside the constraints on the source; the start quality is that of
    /// the moved grasp. A station near which no grasp satisfies the constraints is passed without
    /// an ascent. [`Constraints::closed_under`] is resolved on every station, but keeps its torque
    /// length.
    ///
    /// # Errors
    /// The shapes cannot be combined, a quality cannot be computed, or no grasp on the target
    /// satisfies the constraints.
    pub fn carry_traced(
        &self,
        transfer: &Transfer,
        directions: &[Direction],
        constraints: &Constraints,
        trace: impl FnMut(f64, &Step),
    ) -> Result<Transferred, TransferError> {
        let quality_on = |t: f64, station: &AnyField| transfer.objective(t, station);
        self.carry_inside(transfer, directions, constraints, quality_on, trace)
    }

    /// [`Continuation::carry`] for any quality; `quality_on` constructs it on the shape γ(t).
    ///
    /// The convention of `transfer` is not used.
    ///
    /// # Errors
    /// The shapes cannot be combined, or a quality cannot be computed.
    pub fn carry_by<Q: Quality<AnyField>>(
        &self,
        transfer: &Transfer,
        directions: &[Direction],
        quality_on: impl FnMut(f64, &AnyField) -> Q,
        trace: impl FnMut(f64, &Step),
    ) -> Result<Transferred, TransferError> {
        let free = Constraints::default();
        self.carry_inside(transfer, directions, &free, quality_on, trace)
    }

    fn carry_inside<Q: Quality<AnyField>>(
        &self,
        transfer: &Transfer,
        directions: &[Direction],
        constraints: &Constraints,
        quality_on: impl FnMut(f64, &AnyField) -> Q,
        mut trace: impl FnMut(f64, &Step),
    ) -> Result<Transferred, TransferError> {
        constraints.validate()?;
        let stations = transfer.stations(self.intervals)?;
        let mut carrier = Carrier {
            constraints,
            kept_out: None,
            scheme: self,
            transfer,
            target: stations.last().unwrap_or(transfer.target()),
            quality_on,
            evaluations: 0,
            climbs: 0,
            lost_at: None,
        };
        let (start_quality, mut best) = carrier.follow(&stations, directions, &mut trace)?;
        carrier.keep_better(&mut best, directions)?;
        if let Some(recovery) = &self.recovery {
            let wanted = recovery.below * start_quality.max(f64::MIN_POSITIVE);
            if best.quality < wanted {
                carrier.multistart(recovery, directions, &mut best)?;
            }
            if best.quality < wanted && best.quality < 0.5 * start_quality && recovery.intervals > 0
            {
                carrier.continue_again(recovery, directions, &mut best)?;
            }
            if best.quality <= 0.0 {
                carrier.restart(directions, &mut best)?;
            }
            if best.quality < wanted {
                for k in 0..recovery.polish {
                    let close = nearby(&best.directions, k, POLISH_SPREAD);
                    carrier.keep_better(&mut best, &close)?;
                }
            }
        }
        if let Some(error) = carrier
            .kept_out
            .filter(|_| best.margin == f64::NEG_INFINITY)
        {
            return Err(error.into());
        }
        Ok(Transferred {
            directions: transfer.on_target(&best.directions),
            start_quality,
            quality: best.quality,
            evaluations: carrier.evaluations,
            stationarity: Some(best.stationarity),
            open: (best.quality <= 0.0).then_some(StillOpen {
                distance: Some(-best.margin),
                lost_at: carrier.lost_at,
                climbs: carrier.climbs,
            }),
        })
    }
}

/// Largest move of a contact before a last ascent, radians.
const POLISH_SPREAD: f64 = 0.1;
/// Number of restarts of the last attempt.
const LAST_RESTARTS: usize = 16;

/// One transfer in progress.
struct Carrier<'a, F> {
    scheme: &'a Continuation,
    transfer: &'a Transfer<'a>,
    constraints: &'a Constraints,
    /// Why an ascent had no start within the constraints.
    kept_out: Option<ConstraintError>,
    target: &'a AnyField,
    quality_on: F,
    evaluations: usize,
    /// Number of ascents on the target.
    climbs: usize,
    lost_at: Option<f64>,
}

/// The state of a continuation.
struct Standing {
    t: f64,
    ascent: Ascent,
}

impl<Q: Quality<AnyField>, F: FnMut(f64, &AnyField) -> Q> Carrier<'_, F> {
    /// Follows the stations in order; returns the quality at the start and at the end.
    fn follow(
        &mut self,
        stations: &[AnyField],
        directions: &[Direction],
        trace: &mut impl FnMut(f64, &Step),
    ) -> Result<(f64, Ascent), TransferError> {
        let first = stations.first().unwrap_or(self.target);
        let t = parameter(0, stations.len());
        let ascent = self.climb(t, first, directions, trace)?;
        let start_quality = ascent.start_quality;
        let mut here = Standing { t, ascent };
        for (k, station) in stations.iter().enumerate().skip(1) {
            let t = parameter(k, stations.len());
            here = self.advance(here, t, station, 0, trace)?;
        }
        Ok((start_quality, here.ascent))
    }

    /// Advances over one interval, in two halves if it is too long.
    fn advance(
        &mut self,
        here: Standing,
        t: f64,
        station: &AnyField,
        depth: usize,
        trace: &mut impl FnMut(f64, &Step),
    ) -> Result<Standing, TransferError> {
        let splitting = &self.scheme.splitting;
        // The states of a rejected ascent are not part of the trace.
        let mut seen: Vec<(Vec<Direction>, f64, f64)> = Vec::new();
        let keep = &mut |_: f64, step: &Step| {
            seen.push((step.directions.to_vec(), step.quality, step.stationarity));
        };
        let there = self.climb(t, station, &here.ascent.directions, keep)?;
        let lost = there.margin < splitting.least_kept * here.ascent.quality;
        let farthest = farthest(&here.ascent.directions, &there.directions);
        // If no grasp near satisfies the constraints on a station, halving the interval does not
        // help.
        let kept_out = there.margin == f64::NEG_INFINITY;
        if depth < splitting.depth && !kept_out && (lost || farthest > splitting.longest_move) {
            let middle = 0.5 * (here.t + t);
            let halfway = self.transfer.station(middle)?;
            let here = self.advance(here, middle, &halfway, depth + 1, trace)?;
            return self.advance(here, t, station, splitting.depth, trace);
        }
        for (directions, quality, stationarity) in &seen {
            trace(
                t,
                &Step {
                    directions,
                    quality: *quality,
                    stationarity: *stationarity,
                },
            );
        }
        if !kept_out && here.ascent.quality > 0.0 && there.quality <= 0.0 {
            self.lost_at.get_or_insert(t);
        }
        Ok(Standing { t, ascent: there })
    }

    /// Climbs on the target from further contacts and keeps the better end.
    fn keep_better(&mut self, best: &mut Ascent, from: &[Direction]) -> Result<(), TransferError> {
        let end = self.climb(1.0, self.target, from, &mut |_, _| {})?;
        if end.margin > best.margin {
            *best = end;
        }
        Ok(())
    }

    /// Climbs from the best of many starts around the naive transfer and around the best end.
    fn multistart(
        &mut self,
        recovery: &Recovery,
        directions: &[Direction],
        best: &mut Ascent,
    ) -> Result<(), TransferError> {
        let mut quality = (self.quality_on)(1.0, self.target);
        let mut starts = Vec::with_capacity(recovery.probes);
        for k in 0..recovery.probes {
            let middle = if k % 3 == 2 {
                &best.directions
            } else {
                directions
            };
            let drawn = nearby(middle, k, recovery.spread);
            let Ok(start) = self.constraints.repair(self.target, &drawn) else {
                continue;
            };
            starts.push((quality.value(self.target, &start)?, start));
        }
        self.evaluations += quality.evaluations();
        starts.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, start) in starts.into_iter().take(recovery.climbs) {
            self.keep_better(best, &start)?;
        }
        Ok(())
    }

    /// A second continuation, with another number of stations.
    fn continue_again(
        &mut self,
        recovery: &Recovery,
        directions: &[Direction],
        best: &mut Ascent,
    ) -> Result<(), TransferError> {
        let others = self.transfer.stations(recovery.intervals)?;
        let (_, end) = self.follow(&others, directions, &mut |_, _| {})?;
        if end.margin > best.margin {
            *best = end;
        }
        Ok(())
    }

    /// Restarts as an ascent from an open start does, but more often.
    fn restart(
        &mut self,
        directions: &[Direction],
        best: &mut Ascent,
    ) -> Result<(), TransferError> {
        let patient = MonotoneAscent {
            restarts: LAST_RESTARTS,
            ..self.scheme.at_end
        };
        let end = self.climb_by(&patient, 1.0, self.target, directions, &mut |_| {})?;
        self.climbs += 1 + LAST_RESTARTS;
        if end.margin > best.margin {
            *best = end;
        }
        Ok(())
    }

    fn climb(
        &mut self,
        t: f64,
        station: &AnyField,
        from: &[Direction],
        trace: &mut impl FnMut(f64, &Step),
    ) -> Result<Ascent, QualityError> {
        let settings = if t < 1.0 {
            self.scheme.along
        } else {
            self.climbs += 1;
            self.scheme.at_end
        };
        self.climb_by(&settings, t, station, from, &mut |step| trace(t, step))
    }

    /// An ascent within the constraints. If no start satisfies them, the result is a grasp worse
    /// than any other.
    fn climb_by(
        &mut self,
        settings: &MonotoneAscent,
        t: f64,
        station: &AnyField,
        from: &[Direction],
        trace: &mut impl FnMut(&Step),
    ) -> Result<Ascent, QualityError> {
        let mut quality = (self.quality_on)(t, station);
        let limits = self.constraints_on(t, station);
        let ascent = match settings.climb_within(station, from, &mut quality, &limits, trace) {
            Ok(ascent) => ascent,
            Err(AscentError::Quality(error)) => return Err(error),
            Err(AscentError::Constraints(error)) => {
                self.kept_out = Some(error);
                Ascent {
                    directions: from.to_vec(),
                    start_quality: 0.0,
                    quality: 0.0,
                    margin: f64::NEG_INFINITY,
                    stationarity: 0.0,
                    evaluations: quality.evaluations(),
                }
            }
        };
        self.evaluations += ascent.evaluations;
        Ok(ascent)
    }

    /// The constraints, with the second objective resolved on a station.
    fn constraints_on(&self, t: f64, station: &AnyField) -> Constraints {
        let origin = self.transfer.origin(t);
        let second = self.constraints.closed_under.as_ref();
        Constraints {
            closed_under: second.map(|o| Objective::new(o.convention(), station, &origin)),
            closed_holes: station.closed_patches().to_vec(),
            ..self.constraints.clone()
        }
    }
}

/// Largest angle between corresponding contacts of two lists, radians.
fn farthest(a: &[Direction], b: &[Direction]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(p, q)| angle(p, q))
        .fold(0.0, f64::max)
}
