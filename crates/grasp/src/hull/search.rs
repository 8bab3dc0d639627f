//! Best-first expansion: the largest origin-centred ball in a hull, without the whole hull.
//!
//! A polytope of support points grows where its boundary is nearest to the origin. The distance of
//! its nearest facet is a lower bound of the ball's radius, the support function along any direction
//! an upper one; the search ends when they meet. Of a curved hull every facet is an approximation:
//! there the search looks for the face that the ball touches and for a cap of directions around it in
//! which nothing is nearer ([`super::cap`]), which settles all facets whose rays it covers.
//!
//! Why a cap settles a facet: let every ray from the origin meet a facet of the surface (see
//! [`super::polytope`]), and let u be a unit vector with h(u) < r. The ray along u meets a facet
//! (n, d) at a point x = t u, and t = u·x ≤ h(u) < r while t n·u = n·x ≥ d; so n·u > d/r: the
//! direction u lies within arccos(d/r) of the normal of a facet with d < r. If these caps all lie in
//! caps where h ≥ r is proved, no such u exists and r bounds the ball's radius from below.

mod domain;
mod queue;
mod settle;
mod warm_start;

use self::queue::Queue;
use self::settle::Hunt;
use super::cap::Cap;
use super::min_norm::{Corral, Effort, Nearest};
use super::plane::{Plane, V6, add_scaled, dot, norm, scale};
use super::polytope::{MAX_VERTICES, Polytope};
use super::simplex::{Flat, Simplex, complete};
use super::support::{Extent, PointList, Support, Symmetries};

/// The result of a search: the radius of the largest ball, 0 where the origin is not inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ball {
    /// Proved: not larger than the radius.
    pub(crate) lower: f64,
    /// Proved: not smaller than the radius.
    pub(crate) upper: f64,
    /// The best estimate between them.
    pub(crate) quality: f64,
    /// The unit direction along which the support function proves `upper`.
    pub(crate) direction: V6,
    /// The nearest facet of the inner polytope; it has a meaning only where `closed`.
    pub(crate) facet: usize,
    /// Whether the origin is proved to lie strictly inside.
    pub(crate) closed: bool,
    /// Whether the interval is as narrow as was asked for, up to rounding.
    pub(crate) converged: bool,
}

/// Scratch of a search.
#[derive(Clone, Debug, Default)]
pub(crate) struct Search {
    pub(crate) polytope: Polytope,
    pub(crate) corral: Corral,
    /// Directions around which the support function is proved to stay above a level.
    pub(crate) caps: Vec<Cap>,
    symmetries: Symmetries,
    queue: Queue,
    /// Half-spaces c·u ≥ 0 whose intersection meets every orbit of the symmetries.
    pub(crate) domain: Vec<V6>,
    /// Points beyond these half-spaces, and the level up to which they bound nothing.
    beyond: Vec<V6>,
    beyond_level: f64,
    /// Whether the polytope is to surround the origin with points of the set alone.
    pub(crate) whole: bool,
    /// Facets to be looked at.
    open: Vec<u32>,
}

/// Heights below this part of the longest point are rounding.
pub(crate) const RELATIVE_TOLERANCE: f64 = 1e-12;

/// Tolerances tried in turn, relative to the longest point. Near-coplanar points at one tolerance are
/// well separated at the next.
const TOLERANCES: [f64; 4] = [RELATIVE_TOLERANCE, 1e-10, 3e-14, 1e-9];

/// Facets after which a curved hull is not searched any further if its ball is smaller than the
/// interval that was asked for.
const MOST_FOR_CLOSURE: usize = 2_000;
/// A polytope of more facets than this is not made again with another tolerance.
const LARGE: usize = 20_000;
/// Vertices that are taken twice.
const MOST_COPIES: usize = 500;
/// Times that the facets' planes are repaired before the next tolerance is tried.
const MOST_REPAIRS: usize = 12;
/// Facets after which a curved hull is not searched any further.
const MOST_CREATED: usize = 200_000;

/// An interval that only ever becomes narrower.
struct Bounds {
    lower: f64,
    upper: f64,
    direction: V6,
}

impl Bounds {
    /// The lower end that would do: half of the gap below the upper one, and positive.
    fn level(&self, gap: f64) -> f64 {
        self.upper - 0.5 * gap.min(self.upper)
    }

    fn below(&mut self, upper: f64, direction: &V6) {
        if upper < self.upper {
            (self.upper, self.direction) = (upper, *direction);
        }
    }
}

/// How an expansion ended.
struct Grown {
    facet: usize,
    /// The offset of the nearest facet less what planes may miss their vertices by.
    estimate: f64,
}

impl Search {
    /// The largest origin-centred ball in the hull that `source` supports; `gap` is the width of the
    /// interval at which to stop.
    pub(crate) fn ball(&mut self, source: &mut impl Support, extent: &Extent, gap: f64) -> Ball {
        let Extent {
            toward,
            reach,
            rounding,
        } = *extent;
        let tolerance = RELATIVE_TOLERANCE * reach;
        self.caps.clear();
        let mut bounds = Bounds {
            lower: 0.0,
            upper: f64::INFINITY,
            direction: toward,
        };
        let found = self
            .corral
            .nearest(source, &toward, Effort::Separate, tolerance);
        if let Nearest::Outside { point, floor } = found {
            let direction = scale(&point, -1.0 / norm(&point));
            if floor > tolerance.max(rounding) {
                return open(&direction);
            }
            bounds.below(dot(&direction, &source.support(&direction).0), &direction);
        }
        self.lay_out_domain(source, reach, 0.1 * gap.max(8.0 * rounding));
        let enough = gap.max(tolerance) + 2.0 * rounding;
        let mut grown = None;
        let mut estimate: f64 = 0.0;
        for relative in TOLERANCES {
            let tolerance = relative * reach;
            match complete(&self.corral, source, tolerance) {
                Err(Flat { normal }) => {
                    for normal in [normal, scale(&normal, -1.0)] {
                        let height = dot(&normal, &source.support(&normal).0);
                        bounds.below(height, &normal);
                    }
                }
                Ok(Simplex { points, tags }) => {
                    self.caps.clear();
                    self.polytope.start(&points, &tags);
                    self.polytope.surrounds = self.corral.len == 7
                        && norm(&self.corral.combination()) < self.polytope.least_floor();
                    for copies in [0, MOST_COPIES] {
                        self.polytope.copies = copies;
                        let end = self.exhaust(source, tolerance, gap, rounding, &mut bounds);
                        estimate = estimate.max(end.estimate);
                        let enough = bounds.upper + rounding - bounds.lower <= enough;
                        grown = Some(end);
                        if enough || source.is_curved() {
                            break;
                        }
                    }
                }
            }
            let width = bounds.upper + rounding - bounds.lower;
            if width <= enough || self.polytope.created > LARGE {
                break;
            }
        }
        if source.is_curved() {
            estimate = 0.0;
        }
        let found = conclude(&bounds, grown, estimate, rounding, enough);
        if source.is_curved() {
            let middle = 0.5 * (found.lower + found.upper);
            let quality = if found.converged { middle } else { found.lower };
            return Ball {
                quality: if found.closed { quality } else { 0.0 },
                ..found
            };
        }
        found
    }

    /// How far the symmetries that the search used may be from exact ones.
    pub(crate) fn symmetry_error(&self) -> f64 {
        if self.domain.is_empty() {
            0.0
        } else {
            self.symmetries.error
        }
    }

    /// Expands and repairs the polytope as far as one tolerance leads.
    fn exhaust(
        &mut self,
        source: &mut impl Support,
        tolerance: f64,
        gap: f64,
        rounding: f64,
        bounds: &mut Bounds,
    ) -> Grown {
        let mut rounds = 0;
        loop {
            let end = self.grow(source, tolerance, gap, rounding, bounds);
            let proved = self.polytope.proved() - rounding - self.symmetry_error();
            let proved = if proved > self.beyond_level {
                proved
            } else {
                0.0
            };
            bounds.lower = bounds.lower.max(proved);
            let wide = bounds.upper - gap.max(tolerance) > bounds.lower;
            rounds += 1;
            if !(wide && rounds <= MOST_REPAIRS && self.repair(bounds.upper - gap.max(tolerance))) {
                return end;
            }
        }
    }

    /// Expands the nearest facet until the bounds meet, or until rounding leaves nothing to do.
    fn grow(
        &mut self,
        source: &mut impl Support,
        tolerance: f64,
        gap: f64,
        rounding: f64,
        bounds: &mut Bounds,
    ) -> Grown {
        let mut upper = f64::INFINITY;
        let mut hunt = Hunt::default();
        let curved = source.is_curved();
        if curved {
            self.queue.clear();
            self.queue.put(&self.polytope, &self.polytope.fresh);
        }
        loop {
            let facet = match curved {
                true => self.queue.nearest(&self.polytope).unwrap_or(0),
                false => self.polytope.nearest(),
            };
            let plane = self.polytope.facets[facet].plane;
            let end = |upper: f64, worst: f64| Grown {
                facet,
                estimate: (plane.offset - worst).min(upper),
            };
            // Of a ball this small it only remains to be decided whether there is one.
            let most = match curved && bounds.upper <= gap {
                true => MOST_FOR_CLOSURE,
                false => MOST_CREATED,
            };
            if self.polytope.facets[facet].covered || self.polytope.created > most {
                return end(upper, self.polytope.worst_residual);
            }
            if curved && (self.covered(facet) || self.elsewhere(facet, bounds.level(gap))) {
                self.queue.put(&self.polytope, &[facet as u32]);
                continue;
            }
            let (mut point, mut tag) = source.support(&plane.normal);
            let mut height = dot(&plane.normal, &point);
            upper = upper.min(height);
            bounds.below(height, &plane.normal);
            if let Some(farther) = self.beyond(&plane.normal, height) {
                (point, tag, height) = farther;
            }
            let lower = plane.offset - self.polytope.worst_residual;
            if bounds.upper <= tolerance {
                return end(upper, self.polytope.worst_residual);
            }
            let narrow = lower > tolerance && bounds.upper - lower <= gap;
            if narrow || height - plane.offset <= tolerance {
                return end(upper, self.polytope.worst_residual);
            }
            if curved && self.hunt(source, facet, gap, rounding, bounds, &mut hunt) {
                self.queue.put(&self.polytope, &[facet as u32]);
                continue;
            }
            let vertices = self.polytope.vertices.len();
            if !self.expand(facet, &point, tag, tolerance) {
                return end(upper, self.polytope.worst_residual);
            }
            if curved && self.polytope.vertices.len() > vertices {
                self.queue.put(&self.polytope, &self.polytope.fresh);
            } else if curved {
                self.queue.put(&self.polytope, &[facet as u32]);
            }
        }
    }

    /// Gives the facets whose vertices lie below `level`, although their planes may not, the planes
    /// that bound them best; false if there are none.
    fn repair(&mut self, level: f64) -> bool {
        let mut open = std::mem::take(&mut self.open);
        open.clear();
        let low = |&f: &usize| {
            let facet = &self.polytope.facets[f];
            !facet.settled && !facet.covered && self.polytope.floor(f) < level
        };
        open.extend(self.polytope.alive().filter(low).map(|f| f as u32));
        for &facet in &open {
            let at = facet as usize;
            let old = self.polytope.facets[at].plane;
            let floor = self.polytope.floor(at);
            let plane = match nearest_plane(&self.polytope.corners(at)) {
                Some(plane) if plane.offset > floor => plane,
                _ => Plane {
                    offset: floor,
                    residual: 0.0,
                    ..old
                },
            };
            self.polytope.settle(at, plane);
        }
        let found = !open.is_empty();
        self.open = open;
        found
    }

    /// Goes on, after a ball was found, until no point lies above a facet of offset up to `level`
    /// by more than `gap` (or rounding).
    ///
    /// False where a polytope whose vertices moved must be rebuilt ([`Search::ball_again`]).
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
            // Rounding has left the surface dented below one of its own vertices: the vertex is taken
            // a second time, at this place of the surface.
            let left = polytope.copies > 0;
            polytope.copies = polytope.copies.saturating_sub(1);
            return left
                && polytope.vertices.len() < MAX_VERTICES
                && !polytope.corners(facet).contains(point)
                && polytope.insert(point, tag, facet, tolerance);
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

/// Not closed, proved along a direction in which the hull does not reach the origin.
fn open(direction: &V6) -> Ball {
    Ball {
        lower: 0.0,
        upper: 0.0,
        quality: 0.0,
        direction: *direction,
        facet: 0,
        closed: false,
        converged: true,
    }
}

fn conclude(
    bounds: &Bounds,
    grown: Option<Grown>,
    estimate: f64,
    rounding: f64,
    enough: f64,
) -> Ball {
    let upper = (bounds.upper + rounding).max(0.0);
    let mut lower = bounds.lower.clamp(0.0, upper);
    // The nearest facet's own offset less all that planes may be off by: of two proved bounds within
    // rounding of each other the one that does not depend on what else was looked at.
    if estimate > 0.0 && estimate < lower && upper - estimate <= enough {
        lower = estimate;
    }
    let closed = lower > 0.0;
    Ball {
        lower,
        upper,
        quality: if closed {
            estimate.clamp(lower, upper)
        } else {
            0.0
        },
        direction: bounds.direction,
        facet: grown.map_or(0, |g| g.facet),
        closed,
        converged: upper - lower <= enough,
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
