//! One climb: a state, the models around it, and the steps between states.

use grasp::QualityError;
use shape::Surface;
use sph::Direction;
use sph::direction::tangent_frame;

use super::bundle::{Bundle, Promise};
use super::discontinuities::{Crossed, Discontinuities};
use super::settings::MonotoneAscent;
use crate::constraints::Constraints;
use crate::quality::{LinearPieces, Quality, dot, moved};

/// Least share of the predicted gain that a step must bring to be accepted.
const ACCEPT: f64 = 0.1;
/// Length of the first move, radians.
const FIRST_MOVE: f64 = 0.1;
/// Largest number of pieces; models of rejected steps are added up to this number.
const MOST_PIECES: usize = 96;
/// Least excess of the model of a rejected step of length d radians, as a multiple of d².
const LOCALITY: f64 = 0.5;
/// Factor of ρ after the models of rejected steps are discarded.
const AFTER_FORGETTING: f64 = 0.1;
/// ρ of the reported stationarity.
const REPORT_RHO: f64 = 0.01;

/// Result of a trial step. `Taken` and `Refused` hold the ratio of actual to predicted gain;
/// `Discontinuity` means that the step crossed a discontinuity that was not active.
enum Outcome {
    Taken(f64),
    Refused(f64),
    Discontinuity,
}

/// The state of an ascent, with the memory that its steps reuse.
pub(super) struct Climber<'a, S, Q> {
    surface: &'a S,
    quality: &'a mut Q,
    constraints: &'a mut Constraints,
    pub(super) here: Vec<Direction>,
    pub(super) value: f64,
    there: Vec<Direction>,
    pieces: LinearPieces,
    limits: LinearPieces,
    discontinuities: Discontinuities,
    bundle: Bundle,
    slope: Vec<f64>,
    /// Number of leading pieces that were linearised at the current state; the others come from
    /// rejected steps.
    own: usize,
}

impl<'a, S: Surface, Q: Quality<S>> Climber<'a, S, Q> {
    pub(super) fn new(
        surface: &'a S,
        quality: &'a mut Q,
        constraints: &'a mut Constraints,
        start: Vec<Direction>,
    ) -> Result<Self, QualityError> {
        let value = quality.value(surface, &start)?;
        // NaN counts as the worst value, so that any later state replaces it.
        let value = if value.is_nan() {
            f64::NEG_INFINITY
        } else {
            value
        };
        let mut climber = Self {
            surface,
            quality,
            constraints,
            there: start.clone(),
            here: start,
            value,
            pieces: LinearPieces::default(),
            limits: LinearPieces::default(),
            discontinuities: Discontinuities::default(),
            bundle: Bundle::default(),
            slope: Vec::new(),
            own: 0,
        };
        climber.reserve();
        climber.linearise()?;
        Ok(climber)
    }

    /// Reserves all memory that steps can need, so that no step allocates.
    fn reserve(&mut self) {
        let contacts = self.here.len();
        for pieces in [&mut self.pieces, &mut self.limits] {
            pieces.reset(contacts);
            pieces.reserve(MOST_PIECES);
        }
        self.discontinuities.reserve(contacts);
        self.bundle.reserve(2 * contacts);
        self.slope.reserve(2 * contacts);
    }

    /// Climbs until the slope or the predicted gain is below its threshold, the steps are used up,
    /// or Q reaches `enough`. `seen` receives every state left behind and its slope.
    pub(super) fn climb(
        &mut self,
        settings: &MonotoneAscent,
        enough: f64,
        mut seen: impl FnMut(&[Direction], f64, f64),
    ) -> Result<(), QualityError> {
        let mut rho = FIRST_MOVE / self.steepest().max(f64::MIN_POSITIVE);
        let mut fresh = true;
        let mut refused = false;
        let mut retried = false;
        for _ in 0..settings.steps {
            if !(self.steepest() > settings.stationarity && self.value < enough) {
                break;
            }
            let step = self
                .bundle
                .solve(&self.pieces, &self.limits, rho, settings.largest_move);
            if fresh {
                seen(&self.here, self.value, step.slope);
            }
            if !(step.gain > settings.least_gain && step.slope > settings.stationarity) {
                // No predicted gain at this ρ; a larger ρ may have one.
                if rho < 1.0 && step.slope > settings.stationarity && !refused {
                    rho *= 8.0;
                    fresh = false;
                    continue;
                }
                // Models of rejected steps may hold only where those steps ended: discard them and
                // lower ρ.
                if self.pieces.len() > self.own {
                    self.pieces.truncate(self.own);
                    rho *= AFTER_FORGETTING;
                    continue;
                }
                if retried && !self.cross_a_discontinuity(settings.least_gain)? {
                    break;
                }
                // Retry once with the first move's length and no active discontinuity, as an ascent
                // from here would.
                if !retried {
                    self.discontinuities.deactivate();
                    self.limit()?;
                }
                retried = !retried;
                rho = FIRST_MOVE / self.steepest().max(f64::MIN_POSITIVE);
                (fresh, refused) = (true, false);
                continue;
            }
            let outcome = self.try_step(&step)?;
            fresh = matches!(outcome, Outcome::Taken(_));
            retried &= !fresh;
            refused = !fresh;
            rho *= match outcome {
                Outcome::Taken(k) | Outcome::Refused(k) if k > 0.75 => 2.0,
                Outcome::Taken(k) | Outcome::Refused(k) if k > 0.3 => 1.0,
                Outcome::Taken(k) | Outcome::Refused(k) if k > 0.0 => 0.5,
                Outcome::Discontinuity => 1.0,
                _ => 0.25,
            };
        }
        Ok(())
    }

    /// The slope that remains here by the facets linearised here, with [`REPORT_RHO`] for all
    /// grasps.
    pub(super) fn stationarity(&mut self) -> f64 {
        self.pieces.truncate(self.own);
        if self.pieces.is_empty() {
            return 0.0;
        }
        self.bundle
            .solve(&self.pieces, &self.limits, REPORT_RHO, f64::INFINITY)
            .slope
    }

    /// Moves to the trial state if the gain is at least [`ACCEPT`] of the predicted one.
    fn try_step(&mut self, step: &Promise) -> Result<Outcome, QualityError> {
        self.look_at_moves();
        self.discontinuities
            .correct(self.surface, self.quality, &self.here, &mut self.there);
        if !self.admitted()? {
            return Ok(Outcome::Refused(-1.0));
        }
        let value = self.quality.value(self.surface, &self.there)?;
        let gain = value - self.value;
        let kept_promise = gain / step.gain;
        if kept_promise >= ACCEPT && gain > 0.0 {
            self.arrive(value)?;
            return Ok(Outcome::Taken(kept_promise));
        }
        let crossed = self.discontinuities.activate_crossed(
            self.surface,
            self.quality,
            &self.here,
            &self.there,
        );
        match crossed {
            Crossed::Nothing => {}
            // A model from beyond the discontinuity does not describe this side.
            Crossed::New => {
                self.limit()?;
                return Ok(Outcome::Discontinuity);
            }
            Crossed::Active => return Ok(Outcome::Refused(-1.0)),
        }
        if value.is_finite() && self.pieces.len() < MOST_PIECES {
            self.remember(value)?;
        }
        Ok(Outcome::Refused(if kept_promise.is_nan() {
            -1.0
        } else {
            kept_promise.min(0.99 * ACCEPT)
        }))
    }

    /// Computes the trial state: the current one after the bundle's moves.
    fn look_at_moves(&mut self) {
        let moves = self.bundle.moves();
        self.there.clear();
        let moved_here = self.here.iter().zip(moves.chunks_exact(2));
        self.there.extend(moved_here.map(|(p, u)| moved(p, u)));
    }

    /// Makes the trial state the current one.
    fn arrive(&mut self, value: f64) -> Result<(), QualityError> {
        self.discontinuities.deactivate_if_crossed(
            self.surface,
            self.quality,
            &self.here,
            &self.there,
        );
        std::mem::swap(&mut self.here, &mut self.there);
        self.value = value;
        self.linearise()
    }

    /// Moves just across the first near discontinuity beyond which the quality is higher. Returns
    /// whether there is one.
    fn cross_a_discontinuity(&mut self, least_gain: f64) -> Result<bool, QualityError> {
        for at in 0..self.discontinuities.len() {
            if !self
                .discontinuities
                .moves_across(at, self.bundle.moves_mut())
            {
                continue;
            }
            self.look_at_moves();
            if !self.admitted()? {
                continue;
            }
            let value = self.quality.value(self.surface, &self.there)?;
            if value > self.value + least_gain {
                self.arrive(value)?;
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether the trial state keeps every limit, after a repair of violations due to curvature.
    fn admitted(&mut self) -> Result<bool, QualityError> {
        if self.constraints.is_empty() {
            return Ok(true);
        }
        let repaired = self
            .constraints
            .repair_in_place(self.surface, &mut self.there);
        if repaired.is_err() {
            return Ok(false);
        }
        self.constraints.closed(self.surface, &self.there)
    }

    fn linearise(&mut self) -> Result<(), QualityError> {
        self.quality
            .linearise(self.surface, &self.here, &mut self.pieces)?;
        self.own = self.pieces.len();
        self.discontinuities
            .around(self.surface, self.quality, &self.here);
        self.limit()
    }

    /// Linearises the limits of a step: the constraints and the active discontinuities.
    fn limit(&mut self) -> Result<(), QualityError> {
        self.constraints
            .linearise(self.surface, &self.here, &mut self.limits)?;
        self.discontinuities.write_active(&mut self.limits);
        Ok(())
    }

    /// Adds the linear model at a rejected state, expressed here: the facet that is least there may
    /// be missing from the pieces.
    fn remember(&mut self, value: f64) -> Result<(), QualityError> {
        self.slope.clear();
        self.slope.resize(2 * self.here.len(), 0.0);
        self.quality
            .slope(self.surface, &self.there, &mut self.slope)?;
        for i in 0..self.here.len() {
            let carried = carry_back(&self.here[i], &self.there[i], &self.slope[2 * i..]);
            self.slope[2 * i..2 * i + 2].copy_from_slice(&carried);
        }
        // Q is not concave, so this cut may exclude the current state. Its excess is its error
        // here, and at least LOCALITY · distance², so that a distant model does not bind.
        let moves = self.bundle.moves();
        let missed = (value - self.value - dot(&self.slope, moves)).abs();
        let excess = missed.max(LOCALITY * dot(moves, moves));
        self.pieces.push(excess).copy_from_slice(&self.slope);
        Ok(())
    }

    fn steepest(&self) -> f64 {
        if self.pieces.is_empty() {
            return 0.0;
        }
        crate::quality::norm(self.pieces.get(0).1)
    }
}

/// Components at p of a slope given in the frame at q, by parallel transport along the great circle
/// between them.
fn carry_back(p: &Direction, q: &Direction, slope: &[f64]) -> [f64; 2] {
    let (a, b) = tangent_frame(q);
    let v = a * slope[0] + b * slope[1];
    let (e1, e2) = tangent_frame(p);
    let sum = p.into_inner() + q.into_inner();
    let share = p.dot(&v) / (1.0 + p.dot(q)).max(1e-9);
    let back = v - sum * share;
    [e1.dot(&back), e2.dot(&back)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::{even_directions, log};

    #[test]
    fn carrying_keeps_length_and_the_angle_with_the_way() {
        let all = even_directions(20);
        for (p, q) in all.iter().zip(&all[3..]) {
            let back = carry_back(p, q, &[0.6, -0.8]);
            assert!((dot(&back, &back) - 1.0).abs() <= 1e-12);
            let (a, b) = tangent_frame(q);
            let (e1, e2) = tangent_frame(p);
            let with_way_at_q = -log(q, p).dot(&(a * 0.6 - b * 0.8));
            let with_way_at_p = log(p, q).dot(&(e1 * back[0] + e2 * back[1]));
            assert!((with_way_at_q - with_way_at_p).abs() <= 1e-12);
        }
    }
}
