//! Our ascent: monotone, without coordinate singularities, and with all near-active facets in its
//! model.
//!
//! Q is the least of many smooth facet offsets. At a maximum several are equal, and a step along
//! the gradient of one lowers another. So each step maximises (the least of the near-active facets'
//! linear models) − |u|²/2ρ over the tangent moves u of all contacts within the limits: a proximal
//! bundle step. A move is accepted only if Q rises, and ρ is adapted to the ratio of actual to
//! predicted gain.

use grasp::QualityError;
use shape::Surface;
use sph::Direction;

use super::climber::Climber;
use super::settings::MonotoneAscent;
use super::{Ascent, Step};
use crate::constraints::{ConstraintError, Constraints};
use crate::multistart::nearby;
use crate::quality::Quality;

/// Why an ascent within constraints has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AscentError {
    /// A quality could not be computed.
    #[error(transparent)]
    Quality(#[from] QualityError),
    /// A constraint is not a usable number, or the start cannot be moved inside the constraints.
    #[error(transparent)]
    Constraints(#[from] ConstraintError),
}

/// Largest move of a contact in the first restart, radians; the last restart allows π/2.
const FIRST_SPREAD: f64 = 0.4;
/// Number of starts that one restart evaluates; it climbs from the best.
const PROBES: usize = 4;

impl MonotoneAscent {
    /// Climbs from `start`; `trace` receives every accepted state. The quality of the result is
    /// never below that of the start.
    ///
    /// The start need not be force-closed: from an open grasp the signed margin is raised first,
    /// and if that ends open, nearby starts are tried. The reported quality of an open grasp is 0.
    ///
    /// # Errors
    /// A quality cannot be computed.
    pub fn climb<S: Surface>(
        &self,
        surface: &S,
        start: &[Direction],
        quality: &mut impl Quality<S>,
        trace: impl FnMut(&Step),
    ) -> Result<Ascent, QualityError> {
        self.climb_inside(surface, start, quality, &mut Constraints::default(), trace)
    }

    /// The same within hard constraints: every state of the trace, including the first, keeps all
    /// of them.
    ///
    /// A start that violates separations or caps is first moved inside ([`Constraints::repair`]). A
    /// start that is not closed under [`Constraints::closed_under`] first climbs in that objective.
    /// Q of the result is not below that of the start so repaired.
    ///
    /// # Errors
    /// A constraint is not a usable number, the start cannot be moved inside the constraints, or a
    /// quality cannot be computed.
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

    /// Climbs in the second objective alone until the grasp is closed under it.
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

    /// The best of [`PROBES`] starts around `start`, within the constraints.
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
