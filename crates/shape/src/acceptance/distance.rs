//! Distances of points from a surface.

use nalgebra::{Matrix2, Point3, Vector2};
use rayon::prelude::*;
use sph::Direction;
use sph::direction::{even_directions, retract, tangent_frame};

use crate::surface::Surface;

/// Places on the surface from which a search begins.
const PLACES: usize = 4000;
/// Steps of a search, halvings of a step, and the largest step in radians.
const STEPS: usize = 8;
const HALVINGS: usize = 4;
const LONGEST: f64 = 0.3;
/// A search ends when a step shortens the distance by less than this share.
const SETTLED: f64 = 1e-3;

/// Distance of each point from the nearest place on the surface that is found, metres.
///
/// An upper bound of the distance: the place may be a local minimum. Points whose first search ends
/// beyond `tolerance` have a second one.
pub(super) fn distances(
    surface: &(impl Surface + Sync),
    origin: &Point3<f64>,
    points: &[Point3<f64>],
    start: impl Fn(usize) -> Option<Direction> + Sync,
    tolerance: f64,
) -> Vec<f64> {
    let places = Places::new(surface);
    points
        .par_iter()
        .enumerate()
        .map(|(i, x)| {
            let x = &(x - origin.coords);
            let start = start(i);
            if let Some(p) = &start {
                // Near the surface the distance along its normal is good to second order.
                let (f, normal) = surface.contact(p);
                if (x - f).norm() <= tolerance {
                    return (x - f).dot(&normal).abs();
                }
            }
            match start.map(|p| search(surface, x, p).1) {
                Some(distance) if distance <= tolerance => distance,
                other => {
                    let found = search(surface, x, places.nearest(x)).1;
                    found.min(other.unwrap_or(f64::INFINITY))
                }
            }
        })
        .collect()
}

/// The place on a surface nearest to each point, and its distance in metres.
///
/// The search begins at the nearest of 4,000 places on the surface; it may end at a local minimum of the
/// distance.
pub fn nearest_places(
    surface: &(impl Surface + Sync),
    points: &[Point3<f64>],
) -> Vec<(Direction, f64)> {
    let places = Places::new(surface);
    let one = |x: &Point3<f64>| search(surface, x, places.nearest(x));
    points.par_iter().map(one).collect()
}

/// Places on a surface from which searches begin.
struct Places {
    directions: Vec<Direction>,
    points: Vec<Point3<f64>>,
}

impl Places {
    fn new(surface: &impl Surface) -> Self {
        let directions = even_directions(PLACES);
        Self {
            points: directions.iter().map(|p| surface.point(p)).collect(),
            directions,
        }
    }

    fn nearest(&self, x: &Point3<f64>) -> Direction {
        let squares = self.points.iter().map(|f| (f - x).norm_squared());
        let best = squares.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        best.map_or(self.directions[0], |(k, _)| self.directions[k])
    }
}

/// The place of least distance that Gauss–Newton steps on the sphere find from a direction.
fn search(surface: &impl Surface, x: &Point3<f64>, start: Direction) -> (Direction, f64) {
    let mut p = start;
    let mut here = surface.differential(&p);
    let mut distance = (x - here.position).norm();
    for _ in 0..STEPS {
        let arm = x - here.position;
        let (u, v) = tangent_frame(&p);
        let (fu, fv) = (here.position_slope * u, here.position_slope * v);
        let normal = Matrix2::new(fu.dot(&fu), fu.dot(&fv), fu.dot(&fv), fv.dot(&fv));
        let Some(inverse) = normal.try_inverse() else {
            break;
        };
        let step = inverse * Vector2::new(fu.dot(&arm), fv.dot(&arm));
        let mut step = step * (LONGEST / step.norm()).min(1.0);
        let mut found = None;
        for _ in 0..HALVINGS {
            let q = retract(&p, &(u * step.x + v * step.y));
            let there = surface.differential(&q);
            let new = (x - there.position).norm();
            if new < distance {
                found = Some((q, there, new));
                break;
            }
            step *= 0.5;
        }
        let Some((q, there, new)) = found else {
            break;
        };
        let settled = distance - new <= SETTLED * distance;
        (p, here, distance) = (q, there, new);
        if settled {
            break;
        }
    }
    (p, distance)
}
