//! The interface between a quality and an ascent, and qualities given as plain functions.

use grasp::QualityError;
use nalgebra::Vector3;
use sph::Direction;
use sph::direction::{retract, tangent_frame};

/// Linear models excess_j + g_j·u of functions of the contacts' tangent moves u.
///
/// u has two numbers per contact, radians, in the frame of [`sph::direction::tangent_frame`] at
/// each contact. The storage is flat and reused from step to step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinearPieces {
    dimension: usize,
    excess: Vec<f64>,
    slopes: Vec<f64>,
}

impl LinearPieces {
    /// Removes all pieces; later ones have two numbers per contact.
    pub fn reset(&mut self, contacts: usize) {
        self.dimension = 2 * contacts;
        self.excess.clear();
        self.slopes.clear();
    }

    /// Keeps only the first `pieces` pieces.
    pub(crate) fn truncate(&mut self, pieces: usize) {
        self.excess.truncate(pieces);
        self.slopes.truncate(pieces * self.dimension);
    }

    /// Reserves memory for pieces of the present dimension.
    pub(crate) fn reserve(&mut self, pieces: usize) {
        self.excess.reserve(pieces);
        self.slopes.reserve(pieces * self.dimension);
    }

    /// Adds a piece with this excess (its value above that of the least piece). Returns its slope,
    /// all zeros, for the caller to fill in.
    pub fn push(&mut self, excess: f64) -> &mut [f64] {
        let start = self.slopes.len();
        self.excess.push(excess);
        self.slopes.resize(start + self.dimension, 0.0);
        &mut self.slopes[start..]
    }

    /// Adds `value` to every excess.
    pub fn raise(&mut self, value: f64) {
        for excess in &mut self.excess {
            *excess += value;
        }
    }

    /// Number of pieces.
    pub fn len(&self) -> usize {
        self.excess.len()
    }

    /// Whether there are no pieces.
    pub fn is_empty(&self) -> bool {
        self.excess.is_empty()
    }

    /// Length of a move: two numbers per contact.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Piece j: its excess and its slope g_j.
    pub fn get(&self, j: usize) -> (f64, &[f64]) {
        let start = j * self.dimension;
        (self.excess[j], &self.slopes[start..start + self.dimension])
    }

    /// excess_j + g_j·u.
    pub fn at(&self, j: usize, moves: &[f64]) -> f64 {
        let (excess, slope) = self.get(j);
        excess + dot(slope, moves)
    }
}

/// A quality of contacts on surfaces of type `S` that an ascent can raise.
///
/// [`crate::Objective`] implements it with exact slopes, and [`ByDifferences`] for any function.
/// The surface is an argument of every call, so that one quality can serve a deforming surface.
pub trait Quality<S> {
    /// The quality at the directions of contacts. For an open grasp a negative value is minus its
    /// distance from closure.
    ///
    /// # Errors
    /// The quality cannot be computed.
    fn value(&mut self, surface: &S, directions: &[Direction]) -> Result<f64, QualityError>;

    /// Linearises the active and near-active functions at the directions; the active one comes
    /// first, with excess 0. `pieces` is cleared first.
    ///
    /// # Errors
    /// The quality cannot be computed.
    fn linearise(
        &mut self,
        surface: &S,
        directions: &[Direction],
        pieces: &mut LinearPieces,
    ) -> Result<(), QualityError>;

    /// Writes the slope of the active function, two numbers per contact. Called where
    /// [`Quality::value`] was called last.
    ///
    /// # Errors
    /// The quality cannot be computed.
    fn slope(
        &mut self,
        surface: &S,
        directions: &[Direction],
        slope: &mut [f64],
    ) -> Result<(), QualityError>;

    /// The value above which a grasp is stable. The default is 0, which every closed grasp exceeds.
    fn stable_above(&self) -> f64 {
        0.0
    }

    /// Linearises the discontinuities of the quality: the boundaries of the region that contains
    /// `side`, as functions of the moves from `directions` that are positive inside. `out` is
    /// cleared first. Their number and order depend only on the region. The default has none.
    fn discontinuities(
        &mut self,
        surface: &S,
        side: &[Direction],
        directions: &[Direction],
        out: &mut LinearPieces,
    ) {
        let _ = (surface, side);
        out.reset(directions.len());
    }

    /// Discards cached state, so that later results depend only on their arguments.
    fn forget(&mut self) {}

    /// Number of values computed so far.
    fn evaluations(&self) -> usize;
}

/// Any function Q(surface, contacts), with slopes by central differences.
///
/// Costs 4m values per slope for m contacts. The function should be continuous, and positive for
/// grasps of interest. A NaN is never accepted.
#[derive(Clone, Debug)]
pub struct ByDifferences<F> {
    function: F,
    delta: f64,
    evaluations: usize,
}

impl<F> ByDifferences<F> {
    /// A function and the step of its differences, radians; 1e-5 suits functions accurate to ten
    /// digits.
    pub fn new(function: F, delta: f64) -> Self {
        Self {
            function,
            delta,
            evaluations: 0,
        }
    }
}

impl<S, F: FnMut(&S, &[Direction]) -> f64> Quality<S> for ByDifferences<F> {
    fn value(&mut self, surface: &S, directions: &[Direction]) -> Result<f64, QualityError> {
        self.evaluations += 1;
        Ok((self.function)(surface, directions))
    }

    fn linearise(
        &mut self,
        surface: &S,
        directions: &[Direction],
        pieces: &mut LinearPieces,
    ) -> Result<(), QualityError> {
        pieces.reset(directions.len());
        self.slope(surface, directions, pieces.push(0.0))
    }

    fn slope(
        &mut self,
        surface: &S,
        directions: &[Direction],
        slope: &mut [f64],
    ) -> Result<(), QualityError> {
        let mut moved = directions.to_vec();
        for (i, p) in directions.iter().enumerate() {
            let (e1, e2) = tangent_frame(p);
            for (k, e) in [e1, e2].iter().enumerate() {
                let mut shifted = |h: f64| {
                    moved[i] = retract(p, &(e * h));
                    self.evaluations += 1;
                    (self.function)(surface, &moved)
                };
                let rise = shifted(self.delta) - shifted(-self.delta);
                slope[2 * i + k] = rise / (2.0 * self.delta);
            }
            moved[i] = *p;
        }
        Ok(())
    }

    fn evaluations(&self) -> usize {
        self.evaluations
    }
}

/// The components of a derivative in R³ in the tangent frame of a contact.
pub(crate) fn in_frame(p: &Direction, by_move: &Vector3<f64>) -> [f64; 2] {
    let (e1, e2) = tangent_frame(p);
    [e1.dot(by_move), e2.dot(by_move)]
}

/// The direction after a move u in its tangent frame.
pub(crate) fn moved(p: &Direction, u: &[f64]) -> Direction {
    let (e1, e2) = tangent_frame(p);
    retract(p, &(e1 * u[0] + e2 * u[1]))
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

pub(crate) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_slopes_in_the_frames() {
        let target = Vector3::new(0.3, -0.2, 0.9);
        let mut quality = ByDifferences::new(
            |_: &(), p: &[Direction]| p.iter().map(|p| p.dot(&target)).sum(),
            1e-5,
        );
        let directions = [Vector3::x_axis(), Vector3::z_axis()];
        let mut pieces = LinearPieces::default();
        quality.linearise(&(), &directions, &mut pieces).unwrap();
        assert_eq!((pieces.len(), pieces.dimension()), (1, 4));
        assert_eq!(Quality::<()>::evaluations(&quality), 8);
        for (i, p) in directions.iter().enumerate() {
            let exact = in_frame(p, &target);
            let found = &pieces.get(0).1[2 * i..2 * i + 2];
            for (a, b) in found.iter().zip(&exact) {
                assert!((a - b).abs() <= 1e-9);
            }
        }
    }
}
