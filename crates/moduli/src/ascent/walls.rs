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
            self.standing.fill(false);
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
