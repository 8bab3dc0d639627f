//! Which places of two maps of the sphere correspond: a rotation of the parameters.
//!
//! A map may be composed with any rotation of the sphere and is the same surface. Before two maps are
//! combined, the second is turned so that the mean of |f₁(p) − f₂(R p)|² is least, both about the means
//! of their points (the alignment of SPHARM shapes, without a choice of axes).

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};
use rayon::prelude::*;
use shape::{AnyField, SphericalField, Surface};
use sph::Direction;
use sph::direction::even_directions;

/// Directions at which the maps are compared in the search and while the best are refined.
const COARSE: usize = 60;
const FINE: usize = 400;
/// Where the pole may go, and turns about it.
const POLES: usize = 150;
const TURNS: usize = 18;
/// Rotations that are refined, and the most steps of each.
const REFINED: usize = 4;
const STEPS: usize = 30;

/// The rotation under which one map of the sphere is most like another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correspondence {
    /// R: the place p of the first map corresponds to the place R p of the second.
    pub rotation: Rotation3<f64>,
    /// Root mean square of |f₁(p) − f₂(R p)| over the sphere, after the means have been moved onto each
    /// other; metres.
    pub misfit: f64,
    /// The same without a rotation.
    pub misfit_unturned: f64,
}

/// d between two surfaces, metres: ‖β₁−β₂‖ for two radial ones, else the L² distance of the maps after the
/// second has been turned to correspond to the first.
pub fn distance_of(first: &AnyField, second: &AnyField) -> f64 {
    if let (AnyField::Radial(first), AnyField::Radial(second)) = (first, second) {
        return shape::algebra::distance(first.shape(), second.shape());
    }
    let (first, second) = (first.spherical(), second.spherical());
    let turn = Correspondence::find(&first, &second).rotation;
    first.distance(&second.turned(&turn))
}

/// One map at fixed directions.
struct Sampled<'a> {
    directions: Vec<Direction>,
    /// Where the first map has them, from their mean.
    wanted: Vec<Vector3<f64>>,
    second: &'a SphericalField,
}

impl Correspondence {
    /// Compares 2,700 rotations and refines the best ones by the method of Levenberg and Marquardt. The
    /// result does not depend on the number of threads.
    pub fn find(first: &SphericalField, second: &SphericalField) -> Self {
        let coarse = Sampled::new(first, second, COARSE);
        let candidates = candidates();
        let mut ranked: Vec<(f64, usize)> = candidates
            .par_iter()
            .enumerate()
            .map(|(k, turn)| (coarse.misfit(turn), k))
            .collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let fine = Sampled::new(first, second, FINE);
        let best: Vec<(f64, Rotation3<f64>)> = ranked
            .par_iter()
            .take(REFINED)
            .map(|(_, k)| fine.refined(candidates[*k]))
            .collect();
        let unturned = (fine.misfit(&Rotation3::identity()), Rotation3::identity());
        let least =
            |a: (f64, Rotation3<f64>), b: &(f64, Rotation3<f64>)| if b.0 < a.0 { *b } else { a };
        let (misfit, rotation) = best.iter().fold(unturned, least);
        Self {
            rotation,
            misfit,
            misfit_unturned: unturned.0,
        }
    }
}

/// Rotations spread over SO(3).
fn candidates() -> Vec<Rotation3<f64>> {
    let mut all = Vec::with_capacity(POLES * TURNS);
    for pole in even_directions(POLES) {
        let tilt = Rotation3::rotation_between(&Vector3::z(), &pole).unwrap_or_else(|| {
            Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
        });
        for k in 0..TURNS {
            let angle = std::f64::consts::TAU * k as f64 / TURNS as f64;
            all.push(tilt * Rotation3::from_axis_angle(&Vector3::z_axis(), angle));
        }
    }
    all
}

impl<'a> Sampled<'a> {
    fn new(first: &SphericalField, second: &'a SphericalField, count: usize) -> Self {
        let directions = even_directions(count);
        let points: Vec<Point3<f64>> = directions.iter().map(|p| first.point(p)).collect();
        Self {
            wanted: centred(&points),
            directions,
            second,
        }
    }

    fn misfit(&self, turn: &Rotation3<f64>) -> f64 {
        let points: Vec<Point3<f64>> = self
            .directions
            .iter()
            .map(|p| self.second.point(&(turn * p)))
            .collect();
        root_mean_square(&differences(&self.wanted, &centred(&points)))
    }

    /// Misfit and rotation at a minimum near a rotation.
    fn refined(&self, start: Rotation3<f64>) -> (f64, Rotation3<f64>) {
        let mut turn = start;
        let mut misfit = self.misfit(&turn);
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let (square, right) = self.normal_equations(&turn);
            let scale = square.trace() / 3.0;
            let damped = square + Matrix3::identity() * (damping * scale);
            let Some(inverse) = damped.try_inverse() else {
                break;
            };
            let step = inverse * right;
            let next = Rotation3::new(step) * turn;
            let found = self.misfit(&next);
            if found < misfit {
                let gain = misfit - found;
                (turn, misfit) = (next, found);
                damping *= 0.3;
                if gain < 1e-9 * misfit {
                    break;
                }
            } else {
                damping *= 10.0;
                if damping > 1e6 {
                    break;
                }
            }
        }
        (misfit, turn)
    }

    /// JᵀJ and Jᵀe for a small rotation ω of the parameters, f₂(R p + ω × R p).
    fn normal_equations(&self, turn: &Rotation3<f64>) -> (Matrix3<f64>, Vector3<f64>) {
        let at: Vec<_> = self
            .directions
            .iter()
            .map(|p| {
                let q = turn * p;
                let d = self.second.differential(&q);
                // ω ↦ df (ω × q) = −df [q]× ω.
                (d.position, -(d.position_slope * q.cross_matrix()))
            })
            .collect();
        let count = at.len() as f64;
        let mean = at.iter().map(|(_, j)| j).sum::<Matrix3<f64>>() / count;
        let points: Vec<Point3<f64>> = at.iter().map(|(x, _)| *x).collect();
        let errors = differences(&self.wanted, &centred(&points));
        let (mut square, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for ((_, slope), error) in at.iter().zip(&errors) {
            let slope = slope - mean;
            square += slope.transpose() * slope;
            right += slope.transpose() * error;
        }
        (square, right)
    }
}

/// Points from their mean.
fn centred(points: &[Point3<f64>]) -> Vec<Vector3<f64>> {
    let mean = points.iter().map(|x| x.coords).sum::<Vector3<f64>>() / points.len().max(1) as f64;
    points.iter().map(|x| x.coords - mean).collect()
}

fn differences(a: &[Vector3<f64>], b: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn root_mean_square(errors: &[Vector3<f64>]) -> f64 {
    let sum: f64 = errors.iter().map(Vector3::norm_squared).sum();
    (sum / errors.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use shape::{RadialShape, SphericalShape};
    use sph::Coefficients;

    #[test]
    fn a_turned_map_is_turned_back() {
        let mut beta = Coefficients::constant(6, 0.05);
        for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
            *b = 0.006 * (1.3 * i as f64).sin();
        }
        let shape = SphericalShape::from_radial(&RadialShape::new(beta).unwrap()).unwrap();
        let field = SphericalField::new(&shape);
        let turn = Rotation3::from_euler_angles(2.0, -0.7, 1.1);
        let turned = field.turned(&turn);
        for p in even_directions(20) {
            assert!((turned.point(&p) - field.point(&(turn * p))).norm() <= 1e-12);
        }
        let found = Correspondence::find(&turned, &field);
        assert!(found.rotation.angle_to(&turn) <= 1e-6, "{found:?}");
        assert!(found.misfit <= 1e-8 && found.misfit_unturned > 1e-2);
        let same = Correspondence::find(&field, &field);
        assert!(same.rotation.angle() <= 1e-6);
    }
}
