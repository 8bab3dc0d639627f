//! The full convex hull of points in R⁶, by adding the farthest point of every facet.

use super::min_norm::Corral;
use super::plane::{V6, add_scaled, dot, norm, scale};
use super::polytope::{MAX_VERTICES, Polytope, cone_volume};
use super::search::RELATIVE_TOLERANCE;
use super::simplex::{Flat, Simplex, complete};
use super::support::{PointList, Support};
use crate::wrench::Wrench;
use thiserror::Error;

/// Facets made after which a hull is given up.
const MOST_FACETS: usize = 2_000_000;
/// Points added per point of the list after which a hull is given up: where many points are nearly on
/// common planes, rounding may take and add the same ones in turn.
const MOST_ADDED: usize = 2;

/// A simplicial facet: six vertices and the hyperplane normal·x = offset that supports the hull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// The numbers of its vertices in the list of points.
    pub vertices: [usize; 6],
    /// The outward unit normal.
    pub normal: Wrench,
    /// The distance of the plane from the origin along the normal.
    pub offset: f64,
}

/// The convex hull of a list of points of R⁶, its boundary cut into simplices.
///
/// Facets of more than six vertices appear as several simplices of one plane. Points within 1e-12
/// of the longest point's length above a facet count as lying on it.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexHull {
    facets: Vec<Facet>,
    volume: f64,
}

impl ConvexHull {
    /// The hull of points in general or special position; repeated points are harmless.
    ///
    /// Cost: about 0.1 µs per facet made, and one pass over the points per facet.
    ///
    /// # Errors
    /// A point is not finite, the points lie in a hyperplane, or the hull is too large.
    pub fn new(points: &[Wrench]) -> Result<Self, HullError> {
        if let Some(index) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(HullError::NotFinite { index });
        }
        let points: Vec<V6> = points.iter().map(|p| (*p).into()).collect();
        let Some(&first) = points.first() else {
            return Err(HullError::Flat);
        };
        // Heights are measured from the first point, so that a hull far from the origin keeps its
        // digits.
        let shifted: Vec<V6> = points.iter().map(|p| add_scaled(p, -1.0, &first)).collect();
        let reach = shifted.iter().map(norm).fold(0.0, f64::max);
        let tolerance = RELATIVE_TOLERANCE * reach;
        let corral = Corral::single(&shifted[0], 0);
        let polytope = match complete(&corral, &mut PointList(&shifted), tolerance) {
            Err(Flat { .. }) => return Err(HullError::Flat),
            Ok(Simplex { points, tags }) => {
                let mut polytope = Polytope::default();
                polytope.start(&points, &tags);
                polytope
            }
        };
        exhaust(polytope, &shifted, tolerance).map(|p| collect(&p, &first))
    }

    /// The facets, in no particular order.
    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }

    /// The six-dimensional volume.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// The distance of the origin from the nearest facet plane: the radius of the largest
    /// origin-centred ball inside, negative when the origin lies outside.
    pub fn ball_radius(&self) -> f64 {
        self.facets
            .iter()
            .map(|f| f.offset)
            .fold(f64::INFINITY, f64::min)
    }
}

/// Adds points until no facet has one above it.
fn exhaust(mut polytope: Polytope, points: &[V6], tolerance: f64) -> Result<Polytope, HullError> {
    let mut source = PointList(points);
    let mut waiting: Vec<u32> = polytope.fresh.clone();
    let mut added = 0;
    while let Some(facet) = waiting.pop() {
        let facet = facet as usize;
        // A slot may have been freed, or taken by a later facet that waits on its own.
        if polytope.keys[facet] == f64::INFINITY || polytope.facets[facet].settled {
            continue;
        }
        let plane = polytope.facets[facet].plane;
        let (point, tag) = source.support(&plane.normal);
        if plane.height(&point) <= tolerance || polytope.has_vertex(&point) {
            polytope.settle(facet, plane);
            continue;
        }
        if polytope.vertices.len() >= MAX_VERTICES {
            return Err(HullError::TooMany {
                limit: MAX_VERTICES,
            });
        }
        added += 1;
        if polytope.created > MOST_FACETS || added > MOST_ADDED * points.len() {
            return Err(HullError::TooLarge {
                facets: polytope.created,
            });
        }
        if polytope.insert(&point, tag, facet, tolerance) {
            waiting.extend_from_slice(&polytope.fresh);
        }
    }
    Ok(polytope)
}

fn collect(polytope: &Polytope, origin: &V6) -> ConvexHull {
    let count = polytope.vertices.len() as f64;
    let sum = polytope
        .vertices
        .iter()
        .fold([0.0; 6], |s, v| add_scaled(&s, 1.0, v));
    let inside = scale(&sum, 1.0 / count);
    let mut volume = 0.0;
    let mut facets = Vec::new();
    for f in polytope.alive() {
        let facet = &polytope.facets[f];
        volume += cone_volume(&polytope.corners(f), &inside);
        facets.push(Facet {
            vertices: facet.vertices.map(|v| polytope.tags[v as usize] as usize),
            normal: facet.plane.normal.into(),
            offset: facet.plane.offset + dot(&facet.plane.normal, origin),
        });
    }
    ConvexHull { facets, volume }
}

/// Why points have no full-dimensional hull.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum HullError {
    /// A point with NaN or infinity.
    #[error("point {index} is not finite")]
    NotFinite {
        /// The point, from 0.
        index: usize,
    },
    /// The points lie in a hyperplane (or there are none).
    #[error("the points lie in a hyperplane and have no six-dimensional hull")]
    Flat,
    /// More vertices than the hull can number.
    #[error("the hull has more than {limit} vertices")]
    TooMany {
        /// The most vertices that it can hold.
        limit: usize,
    },
    /// More work than the hull may cost.
    #[error("the hull was given up after {facets} facets")]
    TooLarge {
        /// The facets that were made.
        facets: usize,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(values: &[f64]) -> Vec<Wrench> {
        let n = values.len();
        (0..n.pow(6))
            .map(|i| Wrench::from_fn(|k, _| values[i / n.pow(k as u32) % n]))
            .collect()
    }

    #[test]
    fn cube_with_all_its_coplanar_points() {
        for values in [vec![-1.0, 1.0], vec![-1.0, 0.25, 1.0]] {
            let hull = ConvexHull::new(&grid(&values)).unwrap();
            assert!((hull.volume() - 64.0).abs() <= 1e-10);
            assert!((hull.ball_radius() - 1.0).abs() <= 1e-12);
        }
    }

    #[test]
    fn shifted_and_repeated_points() {
        let mut points = grid(&[0.0, 1.0]);
        points.extend_from_within(..);
        points.iter_mut().for_each(|p| p.add_scalar_mut(100.0));
        let hull = ConvexHull::new(&points).unwrap();
        assert!((hull.volume() - 1.0).abs() <= 1e-9);
        assert!(hull.ball_radius() <= -100.0);
    }

    #[test]
    fn refuses_what_has_no_hull() {
        assert_eq!(ConvexHull::new(&[]), Err(HullError::Flat));
        let mut points = grid(&[0.0, 1.0]);
        points.iter_mut().for_each(|p| p[2] = 0.5);
        assert_eq!(ConvexHull::new(&points), Err(HullError::Flat));
        points[3][1] = f64::NAN;
        assert_eq!(
            ConvexHull::new(&points),
            Err(HullError::NotFinite { index: 3 })
        );
    }
}
