//! A search that goes on from the polytope of the last one, for points that have moved a little.
//!
//! The facets keep their vertices while these move. No simplex may cross the origin on the way: then
//! the surface still winds around it once, and the least distance of any simplex from the origin is
//! still the radius of a ball inside the hull, whether the surface stayed convex or not. That
//! distance is bounded from below without a new plane, first by the old bound less the way that
//! points went, then by the heights of the vertices over the old plane; only facets that may be the
//! nearest get planes again. The end is as in a new search: the nearest facet has no point above it.
//! Whatever looks odd is left to a new search.

use super::{Ball, RELATIVE_TOLERANCE, Search};
use crate::hull::plane::{V6, dot};
use crate::hull::polytope::MAX_VERTICES;
use crate::hull::support::{PointSet, Support};

/// More facets than this are not worth carrying on.
const MOST_FACETS: usize = 1_500;
/// Bounds of more vertices' moves than this say nothing any more, in units of the longest point.
const MOST_DRIFT: f64 = 4.0;

impl Search {
    /// [`Search::ball`] of exact points, where the polytope of the last search came from the same
    /// points before they moved; None when only a new search can tell.
    pub(crate) fn ball_again(&mut self, points: &PointSet, rounding: f64) -> Option<Ball> {
        let reach = points.reach();
        let tolerance = RELATIVE_TOLERANCE * reach;
        let polytope = &mut self.polytope;
        polytope.move_vertices(points);
        if polytope.drift > MOST_DRIFT * reach || polytope.keys.len() > MOST_FACETS {
            return None;
        }
        let mut upper = f64::INFINITY;
        let mut direction = [0.0; 6];
        loop {
            let facet = self.polytope.nearest_fresh(tolerance)?;
            let plane = self.polytope.facets[facet].plane;
            if plane.offset <= tolerance {
                return None;
            }
            let (point, tag) = (&mut &*points).support(&plane.normal);
            let height = dot(&plane.normal, &point);
            if height < upper {
                (upper, direction) = (height, plane.normal);
            }
            self.polytope.hint = facet;
            if height - plane.offset <= tolerance {
                let lower = plane.offset - self.polytope.worst_residual;
                // An interval that rounding has widened may be narrower after a new search.
                if upper - lower > tolerance || !self.polytope.surrounds {
                    return None;
                }
                let proved = (lower.min(upper) - rounding).max(0.0);
                let ball = Ball {
                    lower: proved,
                    upper: upper + rounding,
                    quality: lower.min(upper),
                    direction,
                    facet,
                    closed: proved > 0.0,
                    converged: true,
                };
                return ball.closed.then_some(ball);
            }
            if !self.expand_moved(facet, &point, tag, tolerance) {
                return None;
            }
        }
    }

    /// Adds a point above a facet; false where that could turn the surface over.
    ///
    /// The facets that a vertex takes away and those that it adds bound the simplices between the
    /// vertex and each facet that it sees. The origin is below these facets, so in no such simplex.
    pub(super) fn expand_moved(
        &mut self,
        facet: usize,
        point: &V6,
        tag: u32,
        tolerance: f64,
    ) -> bool {
        let polytope = &mut self.polytope;
        if polytope.vertices.len() >= MAX_VERTICES || polytope.has_vertex(point) {
            return false;
        }
        if !polytope.insert(point, tag, facet, tolerance) {
            return false;
        }
        let offsets = polytope.visible.iter();
        let mut offsets = offsets.map(|&f| polytope.facets[f as usize].plane.offset);
        offsets.all(|offset| offset > 0.0)
    }
}
