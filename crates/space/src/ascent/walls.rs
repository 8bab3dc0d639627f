//! Walls: places where the quality jumps, since the frame of a friction pyramid does.
//!
//! A climb may go over a wall where that raises the quality. Where it does not, the quality has a
//! supremum against the wall, and the wall is one more limit of the step. Then a slope that is left
//! points into walls only, and the stationarity is that of the side on which the climb stands.

use sph::Direction;

use crate::quality::{LinearPieces, Quality, dot, moved};

/// Steps against a wall end this far from it, radians.
const INSIDE: f64 = 1e-6;
/// Corrections of a step that curvature has taken over a wall.
const CORRECTIONS: usize = 3;
/// At the end of a climb walls up to this far away are tried, radians.
const FAR: f64 = 0.05;
/// How far beyond a wall a trial goes, radians.
const BEYOND: f64 = 1e-3;

/// All walls around a state, and which of them stand.
#[derive(Clone, Debug, Default)]
pub(super) struct Walls {
    all: LinearPieces,
    standing: Vec<bool>,
    /// The same walls, seen from a trial state.
    there: LinearPieces,
}

/// Which walls lie between two states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Crossed {
    Nothing,
    /// Some that stood already.
    Standing,
    /// Some that did not stand, and do now.
    New,
}

impl Walls {
    /// Room for the walls of some contacts.
    pub(super) fn reserve(&mut self, contacts: usize) {
        for pieces in [&mut self.all, &mut self.there] {
            pieces.reset(contacts);
            pieces.reserve(2 * contacts);
        }
        self.standing.reserve(2 * contacts);
    }

    /// Looks at the walls around a state; those that stood stand on.
    pub(super) fn around<S>(
        &mut self,
        surface: &S,
        quality: &mut impl Quality<S>,
        here: &[Direction],
    ) {
        quality.walls(surface, here, here, &mut self.all);
        self.standing.resize(self.all.len(), false);
    }

    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    /// None stands any more.
    pub(super) fn fall(&mut self) {
        self.standing.fill(false);
    }

    /// None stands any more if one lies between two states.
    pub(super) fn leave<S>(
        &mut self,
        surface: &S,
        quality: &mut impl Quality<S>,
        here: &[Direction],
        there: &[Direction],
    ) {
        quality.walls(surface, here, there, &mut self.there);
        if (0..self.there.len()).any(|wall| self.there.get(wall).0 < 0.0) {
            self.fall();
        }
    }

    /// Makes the walls stand that lie between two states.
    pub(super) fn raise<S>(
        &mut self,
        surface: &S,
        quality: &mut impl Quality<S>,
        here: &[Direction],
        there: &[Direction],
    ) -> Crossed {
        quality.walls(surface, here, there, &mut self.there);
        let mut crossed = Crossed::Nothing;
        for (wall, standing) in self.standing.iter_mut().enumerate() {
            if self.there.get(wall).0 >= 0.0 {
                continue;
            }
            if !*standing {
                *standing = true;
                crossed = Crossed::New;
            } else if crossed == Crossed::Nothing {
                crossed = Crossed::Standing;
            }
        }
        crossed
    }

    /// Brings a trial state back to this side of the walls that stand.
    pub(super) fn keep<S>(
        &mut self,
        surface: &S,
        quality: &mut impl Quality<S>,
        here: &[Direction],
        there: &mut [Direction],
    ) {
        if !self.standing.contains(&true) {
            return;
        }
        for _ in 0..CORRECTIONS {
            quality.walls(surface, here, there, &mut self.there);
            let mut kept = true;
            for wall in (0..self.there.len()).filter(|w| self.standing[*w]) {
                let (slack, slope) = self.there.get(wall);
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

    /// Adds the standing walls to limits.
    pub(super) fn write(&self, limits: &mut LinearPieces) {
        for (wall, _) in self.standing.iter().enumerate().filter(|(_, s)| **s) {
            let (slack, slope) = self.all.get(wall);
            let left = slack - INSIDE * dot(slope, slope).sqrt();
            limits.push(left.max(0.0)).copy_from_slice(slope);
        }
    }

    /// The shortest moves that go just over a wall; false where it is far away.
    pub(super) fn step_over(&self, wall: usize, moves: &mut Vec<f64>) -> bool {
        let (slack, slope) = self.all.get(wall);
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

    /// Q jumps where contacts cross the plane x = 0: its walls are on the sphere itself.
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

        fn walls(
            &mut self,
            _: &(),
            side: &[Direction],
            contacts: &[Direction],
            walls: &mut LinearPieces,
        ) {
            walls.reset(contacts.len());
            for (i, (s, p)) in side.iter().zip(contacts).enumerate() {
                let sign = s.x.signum();
                let slope = crate::quality::in_frame(p, &(Vector3::x() * sign));
                walls.push(sign * p.x)[2 * i..2 * i + 2].copy_from_slice(&slope);
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
    fn walls_that_are_crossed_stand_until_one_is_left_behind() {
        let mut walls = Walls::default();
        let (here, there) = ([at(0.1), at(0.3)], [at(-0.1), at(0.2)]);
        walls.around(&(), &mut Plane, &here);
        let mut limits = LinearPieces::default();
        let mut count = |walls: &Walls| {
            limits.reset(2);
            walls.write(&mut limits);
            limits.len()
        };
        assert_eq!(count(&walls), 0);
        assert_eq!(walls.raise(&(), &mut Plane, &here, &there), Crossed::New);
        assert_eq!(
            walls.raise(&(), &mut Plane, &here, &there),
            Crossed::Standing
        );
        assert_eq!(walls.raise(&(), &mut Plane, &here, &here), Crossed::Nothing);
        assert_eq!(count(&walls), 1);
        walls.leave(&(), &mut Plane, &here, &here);
        assert_eq!(count(&walls), 1);
        walls.leave(&(), &mut Plane, &here, &there);
        assert_eq!(count(&walls), 0);
    }

    #[test]
    fn standing_walls_are_kept_whatever_the_curvature() {
        let mut walls = Walls::default();
        let here = [at(0.1)];
        walls.around(&(), &mut Plane, &here);
        let mut there = [at(-0.4)];
        walls.keep(&(), &mut Plane, &here, &mut there);
        assert!(there[0].x < 0.0, "no wall stands yet");
        walls.raise(&(), &mut Plane, &here, &there);
        walls.keep(&(), &mut Plane, &here, &mut there);
        assert!(there[0].x >= 0.0 && there[0].x <= 0.05, "{}", there[0].x);
    }

    #[test]
    fn only_near_walls_are_stepped_over() {
        let mut walls = Walls::default();
        let mut moves = Vec::new();
        for x in [0.02, 0.2] {
            let here = [at(x)];
            walls.around(&(), &mut Plane, &here);
            let near = walls.step_over(0, &mut moves);
            assert_eq!(near, x < 0.1);
            if near {
                let there = moved(&here[0], &moves);
                assert!(there.x < 0.0 && angle(&here[0], &there) <= FAR + BEYOND);
            }
        }
    }
}
