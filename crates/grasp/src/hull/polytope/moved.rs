//! A polytope whose vertices have moved: bounds from old planes, and new planes where needed.

use super::Polytope;
use crate::hull::plane::{dot, norm, sub};
use crate::hull::support::PointSet;

impl Polytope {
    /// Moves every vertex to where its point is now.
    pub(crate) fn move_vertices(&mut self, points: &PointSet) {
        let mut farthest = 0.0_f64;
        for (vertex, &tag) in self.vertices.iter_mut().zip(&self.tags) {
            let point = points.get(tag as usize);
            farthest = farthest.max(norm(&sub(&point, vertex)));
            *vertex = point;
        }
        if farthest == 0.0 {
            return;
        }
        self.drift += farthest;
        self.moves += 1;
        for at in 0..self.vertices.len() {
            let point = self.vertices[at];
            self.widen(&point);
        }
    }

    /// Whether a facet's plane is that of its vertices where they are now.
    #[inline]
    pub(crate) fn is_fresh(&self, facet: usize) -> bool {
        self.facets[facet].moved == self.moves
    }

    /// The nearest facet, with its plane; None when a simplex may have met the origin.
    ///
    /// One pass: a facet whose bound exceeds the nearest so far keeps its old plane.
    pub(crate) fn nearest_fresh(&mut self, tolerance: f64) -> Option<usize> {
        let (mut best, mut least) = (0, f64::INFINITY);
        let hint = self.hint.min(self.keys.len() - 1);
        for at in std::iter::once(hint).chain(0..self.keys.len()) {
            if self.keys[at] >= least {
                continue;
            }
            if !self.is_fresh(at) {
                if self.sharpen(at) <= tolerance {
                    return None;
                }
                if self.keys[at] >= least {
                    continue;
                }
                self.freshen(at);
            }
            if self.keys[at] < least {
                (best, least) = (at, self.keys[at]);
            }
        }
        Some(best)
    }

    /// A bound of a facet that is out of date, from the heights of its vertices over the old plane.
    fn sharpen(&mut self, at: usize) -> f64 {
        let facet = &self.facets[at];
        let normal = facet.plane.normal;
        let heights = facet
            .vertices
            .map(|v| dot(&normal, &self.vertices[v as usize]));
        let lowest = heights.into_iter().fold(f64::INFINITY, f64::min);
        self.keys[at] = self.keys[at].max(lowest + self.drift);
        lowest
    }

    /// Gives a facet the plane of its vertices, on the side where it was.
    #[inline]
    pub(crate) fn freshen(&mut self, at: usize) {
        if !self.is_fresh(at) {
            self.turn(at);
        }
    }

    fn turn(&mut self, at: usize) {
        let old = self.facets[at].plane.normal;
        let plane = self.plane_through(&self.facets[at].vertices);
        let plane = if dot(&plane.normal, &old) < 0.0 {
            plane.flipped()
        } else {
            plane
        };
        self.worst_residual = self.worst_residual.max(plane.residual);
        self.keys[at] = plane.offset + self.drift;
        let facet = &mut self.facets[at];
        facet.plane = plane;
        facet.settled = false;
        facet.moved = self.moves;
    }
}
