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

/// Share of the promised gain that a step must bring.
const ACCEPT: f64 = 0.1;
/// First move, radians.
const FIRST_MOVE: f64 = 0.1;
/// Pieces of rejected steps are added up to this many.
const MOST_PIECES: usize = 96;
/// Models of rejected steps have at least this excess for a step of a radian, growing with its square.
const LOCALITY: f64 = 0.5;
/// Factor of ρ when they are forgotten.
const AFTER_FORGETTING: f64 = 0.1;
/// ρ of the stationarity that is reported.
const REPORT_RHO: f64 = 0.01;

/// What became of a step: with the share of the promise that was kept, or stopped by a new discontinuity.
enum Outcome {
    Taken(f64),
    Refused(f64),
    Discontinuity,
}

/// Where a climb stands, with everything that steps reuse.
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
    /// Pieces that were linearised here; the others come from rejected steps.
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
        // What is no number is worse than any: whatever a later climb finds replaces it.
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

    /// Room for all that steps can need, so that none of them allocates.
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

    /// Climbs until no slope, no gain or no steps are left, or until `enough`; `seen` gets every
    /// state left behind and its slope.
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
                // Nothing to gain with this much freedom; with more there may be.
                if rho < 1.0 && step.slope > settings.stationarity && !refused {
                    rho *= 8.0;
                    fresh = false;
                    continue;
                }
                // What rejected steps taught may hold only where they ended: less freedom without it.
                if self.pieces.len() > self.own {
                    self.pieces.truncate(self.own);
                    rho *= AFTER_FORGETTING;
                    continue;
                }
                if retried && !self.cross_a_discontinuity(settings.least_gain)? {
                    break;
                }
                // A climb that began here would look around as far as this.
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

    /// The slope that is left here, at one ρ for all grasps, by the facets of this place alone.
    pub(super) fn stationarity(&mut self) -> f64 {
        self.pieces.truncate(self.own);
        if self.pieces.is_empty() {
            return 0.0;
        }
        self.bundle
            .solve(&self.pieces, &self.limits, REPORT_RHO, f64::INFINITY)
            .slope
    }

    /// Moves if the gain is a fair share of the promise.
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
            // What holds beyond a jump says nothing about this side.
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

    /// The trial state after the bundle's moves.
    fn look_at_moves(&mut self) {
        let moves = self.bundle.moves();
        self.there.clear();
        let moved_here = self.here.iter().zip(moves.chunks_exact(2));
        self.there.extend(moved_here.map(|(p, u)| moved(p, u)));
    }

    /// Takes the trial state.
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

    /// Goes just across the first near discontinuity beyond which the quality is higher.
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

    /// Whether the trial state keeps every limit, after a repair of what curvature took away.
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

    /// The limits of a step: those of the constraints, and the active discontinuities.
    fn limit(&mut self) -> Result<(), QualityError> {
        self.constraints
            .linearise(self.surface, &self.here, &mut self.limits)?;
        self.discontinuities.write_active(&mut self.limits);
        Ok(())
    }

    /// Adds the model at a rejected state, seen from here: what decided there may not have been
    /// among the pieces.
    fn remember(&mut self, value: f64) -> Result<(), QualityError> {
        self.slope.clear();
        self.slope.resize(2 * self.here.len(), 0.0);
        self.quality
            .slope(self.surface, &self.there, &mut self.slope)?;
        for i in 0..self.here.len() {
            let carried = carry_back(&self.here[i], &self.there[i], &self.slope[2 * i..]);
            self.slope[2 * i..2 * i + 2].copy_from_slice(&carried);
        }
        // The quality is not concave: a model that would cut off the present state counts as much as
        // it misses, and one from far away is no constraint here.
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

/// Components at p of a slope given in the frame at q, carried along the great circle between them.
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
