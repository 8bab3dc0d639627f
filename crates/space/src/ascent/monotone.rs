//! Our ascent: never down, no poles, aware of every facet that is about to decide.
//!
//! Q is the least of many smooth facet offsets, so at a maximum several tie and a step along the
//! gradient of one lowers another. Each step therefore maximises the least of the near-active
//! facets' linear models, less |u|²/2ρ (a proximal bundle step), over all contacts' tangent
//! moves u within the limits; a move is taken only if Q rises, and ρ follows how well the model did.

use grasp::QualityError;
use shape::Surface;
use sph::Direction;

use super::climber::Climber;
use super::settings::MonotoneAscent;
use super::{Ascent, Step};
use crate::constraints::{ConstraintError, Constraints};
use crate::multistart::nearby;
use crate::quality::Quality;

/// Why a climb within constraints has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AscentError {
    /// A quality could not be computed.
    #[error(transparent)]
    Quality(#[from] QualityError),
    /// The constraints are no numbers, or the start cannot be brought inside them.
    #[error(transparent)]
    Constraints(#[from] ConstraintError),
}

/// How far the first restart may move a contact, radians; the last one moves up to π/2.
const FIRST_SPREAD: f64 = 0.4;
/// Starts that one restart looks at; the best climbs.
const PROBES: usize = 4;

impl MonotoneAscent {
    /// Climbs from `start`; `trace` sees every state taken. The quality of the result is never
    /// below that of the start.
    ///
    /// Works from grasps that are not force-closed too: there the signed margin rises first, and
    /// where that ends open, nearby starts are tried. The qualities reported are 0 for open grasps.
    pub fn climb<S: Surface>(
        &self,
        surface: &S,
        start: &[Direction],
        quality: &mut impl Quality<S>,
        trace: impl FnMut(&Step),
    ) -> Result<Ascent, QualityError> {
        self.climb_inside(surface, start, quality, &mut Constraints::default(), trace)
    }

    /// The same within hard limits: no state of the trace, the first included, violates one.
    ///
    /// A start outside the limits of place is first moved inside ([`Constraints::repair`]); one that
    /// is not closed under [`Constraints::closed_under`] first climbs there. Where neither is
    /// possible there is an error. Q is not below that of the start so repaired.
    pub fn climb_within<S: Surface>(
        &self,
        surface: &S,
        start: &[Direction],
        quality: &mut impl Quality<S>,
        constraints: &Constraints,
        trace: impl FnMut(&Step),
    ) -> Result<Ascent, AscentError> {
        constraints.validate()?;
        let mut constraints = constraints.clone();
        let mut inside = constraints.repair(surface, start)?;
        if !constraints.closed(surface, &inside)? {
            inside = self.close(surface, inside, &mut constraints)?;
        }
        Ok(self.climb_inside(surface, &inside, quality, &mut constraints, trace)?)
    }

    /// Climbs the second objective alone until it is closed.
    fn close<S: Surface>(
        &self,
        surface: &S,
        start: Vec<Direction>,
        constraints: &mut Constraints,
    ) -> Result<Vec<Direction>, AscentError> {
        let Some(mut second) = constraints.closed_under.take() else {
            return Ok(start);
        };
        let least = f64::MIN_POSITIVE;
        let reached =
            self.climb_or_restart(surface, &start, &mut second, constraints, least, |_| {});
        constraints.closed_under = Some(second);
        let reached = reached?;
        if reached.margin > 0.0 {
            return Ok(reached.directions);
        }
        Err(AscentError::Constraints(ConstraintError::FrictionMargin {
            by: -reached.margin,
        }))
    }

    fn climb_inside<S: Surface>(
        &self,
        surface: &S,
        start: &[Direction],
        quality: &mut impl Quality<S>,
        constraints: &mut Constraints,
        trace: impl FnMut(&Step),
    ) -> Result<Ascent, QualityError> {
        self.climb_or_restart(surface, start, quality, constraints, f64::INFINITY, trace)
    }

    fn climb_or_restart<S: Surface>(
        &self,
        surface: &S,
        start: &[Direction],
        quality: &mut impl Quality<S>,
        constraints: &mut Constraints,
        enough: f64,
        mut trace: impl FnMut(&Step),
    ) -> Result<Ascent, QualityError> {
        let before = quality.evaluations();
        quality.forget();
        let from = start.to_vec();
        let mut best = self.climb_once(surface, from, quality, constraints, enough, &mut trace)?;
        for k in 0..self.restarts {
            let wanted = if best.start_quality > 0.0 {
                0.0
            } else {
                quality.stable_above().min(enough)
            };
            if best.margin > wanted {
                break;
            }
            let Some(from) = self.probe(surface, start, k, quality, constraints)? else {
                continue;
            };
            let next = self.climb_once(surface, from, quality, constraints, enough, &mut trace)?;
            if next.margin > best.margin {
                best = Ascent {
                    start_quality: best.start_quality,
                    ..next
                };
            }
        }
        trace(&Step {
            directions: &best.directions,
            quality: best.quality,
            stationarity: best.stationarity,
        });
        best.evaluations = quality.evaluations() - before;
        Ok(best)
    }

    /// The best of a few starts around the first one, within the limits.
    fn probe<S: Surface>(
        &self,
        surface: &S,
        start: &[Direction],
        restart: usize,
        quality: &mut impl Quality<S>,
        constraints: &mut Constraints,
    ) -> Result<Option<Vec<Direction>>, QualityError> {
        let share = restart as f64 / self.restarts.saturating_sub(1).max(1) as f64;
        let spread = FIRST_SPREAD + share * (std::f64::consts::FRAC_PI_2 - FIRST_SPREAD);
        let mut best: Option<(f64, Vec<Direction>)> = None;
        for probe in 0..PROBES {
            let drawn = nearby(start, restart * PROBES + probe, spread);
            let Ok(inside) = constraints.repair(surface, &drawn) else {
                continue;
            };
            if !constraints.closed(surface, &inside)? {
                continue;
            }
            let value = quality.value(surface, &inside)?;
            if best.as_ref().is_none_or(|(most, _)| value > *most) {
                best = Some((value, inside));
            }
        }
        Ok(best.map(|(_, start)| start))
    }

    fn climb_once<S: Surface>(
        &self,
        surface: &S,
        start: Vec<Direction>,
        quality: &mut impl Quality<S>,
        constraints: &mut Constraints,
        enough: f64,
        trace: &mut impl FnMut(&Step),
    ) -> Result<Ascent, QualityError> {
        let mut climber = Climber::new(surface, quality, constraints, start)?;
        let start_quality = climber.value.max(0.0);
        climber.climb(self, enough, |directions, value, slope| {
            trace(&Step {
                directions,
                quality: value.max(0.0),
                stationarity: slope,
            });
        })?;
        Ok(Ascent {
            start_quality,
            quality: climber.value.max(0.0),
            margin: climber.value,
            stationarity: climber.stationarity(),
            directions: climber.here,
            evaluations: 0,
        })
    }
}
