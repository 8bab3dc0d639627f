//! Discontinuities of the quality, which lie where the frame of a friction pyramid is
//! discontinuous.
//!
//! An ascent may cross a discontinuity if that raises the quality. If it does not, the quality has
//! a supremum at the discontinuity, which then becomes an active constraint of the step. Any slope
//! that remains points across active discontinuities only, so the stationarity is that of the side
//! on which the ascent is.

use sph::Direction;

use crate::quality::{LinearPieces, Quality, dot, moved};

/// Distance from an active discontinuity at which steps towards it end, radians.
const INSIDE: f64 = 1e-6;
/// Largest number of corrections of a step that curvature has taken across a discontinuity.
const CORRECTIONS: usize = 3;
/// Distance up to which discontinuities are tried at the end of an ascent, radians.
const FAR: f64 = 0.05;
/// Distance beyond a discontinuity at which a trial state lies, radians.
const BEYOND: f64 = 1e-3;

/// All discontinuities around a state, and which of them are active constraints.
#[derive(Clone, Debug, Default)]
pub(super) struct Discontinuities {
    all: LinearPieces,
    active: Vec<bool>,
    /// The same discontinuities, linearised at a trial state.
    there: LinearPieces,
}

/// Which discontinuities lie between two states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Crossed {
    Nothing,
    /// Only discontinuities that were active already.
    Active,
    /// At least one that was not active, and is now.
    New,
}

impl Discontinuities {
    /// Reserves memory for the discontinuities of this many contacts.
    pub(super) fn reserve(&mut self, contacts: usize) {
        for pieces in [&mut self.all, &mut self.there] {
            pieces.reset(contacts);
            pieces.reserve(2 * contacts);
        }
        self.active.reserve(2 * contacts);
    }

    /// Computes the discontinuities around a state; those that were active stay active.
    pub(super) fn around<S>(
        &mut self,
        surface: &S,
        quality: &mut impl Quality<S>,
        here: &[Direction],
    ) {
        quality.discontinuities(surface, here, here, &mut self.all);
        self.active.resize(self.all.len(), false);
    }

    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    /// Deactivates all discontinuities.
    pub(super) fn deactivate(&mut self) {
        self.active.fill(false);
    }

    /// Deactivates all discontinuities if one lies between two states.
    pub(super) fn deactivate_if_crossed<S>(
        &mut self,
        surface: &S,
        quality: &mut impl Quality<S>,
        here: &[Direction],
        there: &[Direction],
    ) {
        quality.discontinuities(surface, here, there, &mut self.there);
        if (0..self.there.len()).any(|at| self.there.get(at).0 < 0.0) {
            self.deactivate();
        }
    }

    /// Activates every discontinuity between two states, and reports what was crossed.
    pub(super) fn activate_crossed<S>(
        &mut self,
        surface: &S,
        quality: &mut impl Quality<S>,
        here: &[Direction],
        there: &[Direction],
    ) -> Crossed {
        quality.discontinuities(surface, here, there, &mut self.there);
        let mut crossed = Crossed::Nothing;
        for (at, active) in self.active.iter_mut().enumerate() {
            if self.there.get(at).0 >= 0.0 {
                continue;
            }
            if !*active {
                *active = true;
                crossed = Crossed::New;
            } else if crossed == Crossed::Nothing {
                crossed = Crossed::Active;
            }
        }
        crossed
    }

    /// Moves a trial state back to this side of the active discontinuities.
    pub(super) fn correct<S>(
        &mut self,
        surface: &S,
        quality: &mut impl Quality<S>,
        here: &[Direction],
        there: &mut [Direction],
    ) {
        if !self.active.contains(&true) {
            return;
        }
        for _ in 0..CORRECTIONS {
            quality.discontinuities(surface, here, there, &mut self.there);
            let mut kept = true;
            for at in (0..self.there.len()).filter(|at| self.active[*at]) {
                let (slack, slope) = self.there.get(at);
                let square = dot(slope, slope);
                if slack < 0.0 && square > 0.0 {
                    kept = false;
                    let factor = INSIDE / square.sqrt() - slack / square;
                    for (p, a) in there.iter_mut().zip(slope.chunks_exact(2)) {
                        if a != [0.0, 0.0] {
                            *p = moved(p, &[factor * a[0], factor * a[1]]);
                        }
                    }
                }
            }
            if kept {
                break;
            }
        }
    }

    /// Adds the active discontinuities to `limits`.
    pub(super) fn write_active(&self, limits: &mut LinearPieces) {
        for (at, _) in self.active.iter().enumerate().filter(|(_, s)| **s) {
            let (slack, slope) = self.all.get(at);
            let left = slack - INSIDE * dot(slope, slope).sqrt();
            limits.push(left.max(0.0)).copy_from_slice(slope);
        }
    }

    /// The shortest moves that go just across discontinuity `at`; false if it is farther than
    /// [`FAR`].
    pub(super) fn moves_across(&self, at: usize, moves: &mut Vec<f64>) -> bool {
        let (slack, slope) = self.all.get(at);
        let square = dot(slope, slope);
        if slack * slack > FAR * FAR * square || square == 0.0 {
            return false;
        }
        let factor = -(slack / square + BEYOND / square.sqrt());
        moves.clear();
        moves.extend(slope.iter().map(|a| factor * a));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{UnitVector3, Vector3};
    use sph::direction::angle;

    /// Q is discontinuous where a contact crosses the plane x = 0.
    struct Plane;

    impl Quality<()> for Plane {
        fn value(&mut self, _: &(), _: &[Direction]) -> Result<f64, grasp::QualityError> {
            Ok(0.0)
        }

        fn linearise(
            &mut self,
            _: &(),
            _: &[Direction],
            _: &mut LinearPieces,
        ) -> Result<(), grasp::QualityError> {
            Ok(())
        }

        fn slope(
            &mut self,
            _: &(),
            _: &[Direction],
            _: &mut [f64],
        ) -> Result<(), grasp::QualityError> {
            Ok(())
        }

        fn discontinuities(
            &mut self,
            _: &(),
            side: &[Direction],
            directions: &[Direction],
            out: &mut LinearPieces,
        ) {
            out.reset(directions.len());
            for (i, (s, p)) in side.iter().zip(directions).enumerate() {
                let sign = s.x.signum();
                let slope = crate::quality::in_frame(p, &(Vector3::x() * sign));
                out.push(sign * p.x)[2 * i..2 * i + 2].copy_from_slice(&slope);
            }
        }

        fn evaluations(&self) -> usize {
            0
        }
    }

    fn at(x: f64) -> Direction {
        UnitVector3::new_normalize(Vector3::new(x, 0.5, 0.8))
    }

    #[test]
    fn what_is_crossed_is_active_until_one_is_left_behind() {
        let mut found = Discontinuities::default();
        let (here, there) = ([at(0.1), at(0.3)], [at(-0.1), at(0.2)]);
        found.around(&(), &mut Plane, &here);
        let mut limits = LinearPieces::default();
        let mut count = |found: &Discontinuities| {
            limits.reset(2);
            found.write_active(&mut limits);
            limits.len()
        };
        assert_eq!(count(&found), 0);
        assert_eq!(
            found.activate_crossed(&(), &mut Plane, &here, &there),
            Crossed::New
        );
        assert_eq!(
            found.activate_crossed(&(), &mut Plane, &here, &there),
            Crossed::Active
        );
        assert_eq!(
            found.activate_crossed(&(), &mut Plane, &here, &here),
            Crossed::Nothing
        );
        assert_eq!(count(&found), 1);
        found.deactivate_if_crossed(&(), &mut Plane, &here, &here);
        assert_eq!(count(&found), 1);
        found.deactivate_if_crossed(&(), &mut Plane, &here, &there);
        assert_eq!(count(&found), 0);
    }

    #[test]
    fn active_ones_are_kept_whatever_the_curvature() {
        let mut found = Discontinuities::default();
        let here = [at(0.1)];
        found.around(&(), &mut Plane, &here);
        let mut there = [at(-0.4)];
        found.correct(&(), &mut Plane, &here, &mut there);
        assert!(there[0].x < 0.0, "nothing is active yet");
        found.activate_crossed(&(), &mut Plane, &here, &there);
        found.correct(&(), &mut Plane, &here, &mut there);
        assert!(there[0].x >= 0.0 && there[0].x <= 0.05, "{}", there[0].x);
    }

    #[test]
    fn only_near_ones_are_crossed() {
        let mut found = Discontinuities::default();
        let mut moves = Vec::new();
        for x in [0.02, 0.2] {
            let here = [at(x)];
            found.around(&(), &mut Plane, &here);
            let near = found.moves_across(0, &mut moves);
            assert_eq!(near, x < 0.1);
            if near {
                let there = moved(&here[0], &moves);
                assert!(there.x < 0.0 && angle(&here[0], &there) <= FAR + BEYOND);
            }
        }
    }
}
