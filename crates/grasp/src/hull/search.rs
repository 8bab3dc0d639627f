//! Best-first expansion: the largest origin-centred ball in a hull, without the whole hull.
//!
//! A polytope of support points grows where its boundary is nearest to the origin. The offset of
//! its nearest facet is a lower bound of the ball's radius, the support function along that
//! facet's normal an upper one; the search ends when they meet.

mod warm_start;

use super::min_norm::{Corral, Effort, Nearest};
use super::plane::{Plane, V6, add_scaled, dot, norm, scale};
use super::polytope::{MAX_VERTICES, Polytope};
use super::simplex::{Flat, Simplex, complete};
use super::support::{PointList, Support};

/// The result of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Ball {
    /// The origin is not inside: the support function is not positive along `direction`.
    Open { direction: V6 },
    /// The radius lies in [lower, upper]; the hull is supported along `direction` at `upper`.
    Closed {
        lower: f64,
        upper: f64,
        direction: V6,
        /// The nearest facet of the inner polytope, whose plane `lower` comes from.
        facet: usize,
    },
}

/// Scratch of a search.
#[derive(Clone, Debug, Default)]
pub(crate) struct Search {
    pub(crate) polytope: Polytope,
    pub(crate) corral: Corral,
    /// Facets to be looked at.
    open: Vec<u32>,
}

/// Heights below this part of the longest point are rounding.
pub(crate) const RELATIVE_TOLERANCE: f64 = 1e-12;

/// What is tried in turn. Wrenches that miss a common hyperplane by about one tolerance leave facets
/// too thin for a plane; to a wider or narrower tolerance the same wrenches are clear.
const TOLERANCES: [f64; 4] = [RELATIVE_TOLERANCE, 1e-10, 3e-14, 1e-9];

impl Search {
    /// The largest origin-centred ball in the hull that `source` supports.
    ///
    /// `toward` is any direction in which points of the hull lie, `reach` the length of the longest
    /// of them, `gap` the width of the interval at which to stop.
    pub(crate) fn ball(
        &mut self,
        source: &mut impl Support,
        toward: &V6,
        reach: f64,
        gap: f64,
    ) -> Ball {
        let found =
            self.corral
                .nearest(source, toward, Effort::Separate, RELATIVE_TOLERANCE * reach);
        if let Nearest::Outside { point, floor } = found
            && floor > RELATIVE_TOLERANCE * reach
        {
            return Ball::Open {
                direction: scale(&point, -1.0 / norm(&point)),
            };
        }
        let mut best = None;
        for relative in TOLERANCES {
            let tolerance = relative * reach;
            let ball = match complete(&self.corral, source, tolerance) {
                Err(Flat { normal }) => return Ball::Open { direction: normal },
                Ok(Simplex { points, tags }) => {
                    self.polytope.start(&points, &tags);
                    self.grow(source, tolerance, gap)
                }
            };
            // Every attempt is a proof of its own: their intersection holds too.
            let (low, high) = match (&ball, &best) {
                (Ball::Open { .. }, _) => return ball,
                (Ball::Closed { lower, upper, .. }, None) => (*lower, *upper),
                (Ball::Closed { lower, upper, .. }, Some((low, high, _))) => {
                    (lower.max(*low), upper.min(*high))
                }
            };
            best = Some((low, high, ball));
            if high - low <= gap.max(1e-9 * reach.min(high)) {
                break;
            }
        }
        conclude(best, RELATIVE_TOLERANCE * reach, toward)
    }

    /// Expands the nearest facet until the bounds meet, or until rounding leaves nothing to do.
    fn grow(&mut self, source: &mut impl Support, tolerance: f64, gap: f64) -> Ball {
        let mut upper = f64::INFINITY;
        let mut direction = [0.0; 6];
        loop {
            let facet = self.polytope.nearest();
            let plane = self.polytope.facets[facet].plane;
            let (point, tag) = source.support(&plane.normal);
            let height = dot(&plane.normal, &point);
            if height < upper {
                (upper, direction) = (height, plane.normal);
            }
            if upper <= tolerance {
                return Ball::Open { direction };
            }
            let lower = plane.offset - self.polytope.worst_residual;
            let narrow = lower > tolerance && upper - lower <= gap;
            let done = narrow || height - plane.offset <= tolerance;
            if done || !self.expand(facet, &point, tag, tolerance) {
                return Ball::Closed {
                    lower: lower.min(upper),
                    upper,
                    direction,
                    facet,
                };
            }
        }
    }

    /// Goes on, after a ball was found, until no point lies above a facet of offset up to `level`
    /// by more than `gap` (or rounding).
    ///
    /// False where a polytope that was moved needs to be made anew ([`Search::ball_again`]).
    pub(crate) fn finish(
        &mut self,
        source: &mut impl Support,
        level: f64,
        gap: f64,
        tolerance: f64,
    ) -> bool {
        let mut open = std::mem::take(&mut self.open);
        let mut done = true;
        loop {
            self.polytope.open(level, &mut open);
            if open.is_empty() || !done {
                break;
            }
            for &facet in &open {
                // What was added since may have taken it away.
                if done && self.polytope.is_open(facet as usize, level) {
                    done = self.finish_facet(
                        source,
                        facet as usize,
                        level,
                        gap.max(tolerance),
                        tolerance,
                    );
                }
            }
        }
        self.open = open;
        done
    }

    /// Marks a facet finished or adds the point above it; false as in [`Search::finish`].
    fn finish_facet(
        &mut self,
        source: &mut impl Support,
        facet: usize,
        level: f64,
        gap: f64,
        tolerance: f64,
    ) -> bool {
        self.polytope.freshen(facet);
        if self.polytope.bound(facet) > level {
            return true;
        }
        let plane = self.polytope.facets[facet].plane;
        let (point, tag) = source.support(&plane.normal);
        let above = dot(&plane.normal, &point) - plane.offset > gap;
        if above && self.polytope.moves > 1 {
            return self.expand_moved(facet, &point, tag, tolerance);
        }
        if !(above && self.expand(facet, &point, tag, tolerance)) {
            self.polytope.facets[facet].finished = self.polytope.moves;
        }
        true
    }

    /// Adds the point above the facet; false when nothing more can be done there.
    fn expand(&mut self, facet: usize, point: &V6, tag: u32, tolerance: f64) -> bool {
        let polytope = &mut self.polytope;
        if polytope.vertices.len() < MAX_VERTICES && !polytope.has_vertex(point) {
            return polytope.insert(point, tag, facet, tolerance);
        }
        // A thin facet whose plane rounding has tilted below a vertex of its own neighbourhood:
        // the plane orthogonal to the facet's point nearest to the origin bounds it best.
        if polytope.facets[facet].settled {
            return false;
        }
        let plane = nearest_plane(&polytope.corners(facet));
        match plane {
            Some(plane) if plane.offset > polytope.bound(facet) => polytope.settle(facet, plane),
            _ => {
                let plane = polytope.facets[facet].plane;
                polytope.settle(facet, plane);
            }
        }
        true
    }
}

/// The ball of the last attempt with the bounds of all.
fn conclude(best: Option<(f64, f64, Ball)>, tolerance: f64, toward: &V6) -> Ball {
    match best {
        Some((
            lower,
            upper,
            Ball::Closed {
                direction, facet, ..
            },
        )) if lower > tolerance => Ball::Closed {
            lower,
            upper,
            direction,
            facet,
        },
        Some((_, _, Ball::Closed { direction, .. } | Ball::Open { direction })) => {
            Ball::Open { direction }
        }
        None => Ball::Open { direction: *toward },
    }
}

/// The plane that keeps six points farthest from the origin: orthogonal to the nearest point.
fn nearest_plane(corners: &[V6; 6]) -> Option<Plane> {
    let centre = corners.iter().fold([0.0; 6], |s, p| add_scaled(&s, 1.0, p));
    let reach = corners.iter().map(norm).fold(0.0, f64::max);
    let mut corral = Corral::default();
    let found = corral.nearest(
        &mut PointList(corners),
        &centre,
        Effort::Converge,
        1e-14 * reach,
    );
    let Nearest::Outside { point, .. } = found else {
        return None;
    };
    let normal = scale(&point, 1.0 / norm(&point));
    let heights = corners.map(|p| dot(&normal, &p));
    Some(Plane {
        normal,
        offset: heights.iter().copied().fold(f64::INFINITY, f64::min),
        residual: 4.0 * f64::EPSILON * reach,
    })
}
