//! What the surface proves: the ball that it surrounds.
//!
//! The surface is closed whatever rounding does to its planes, since the border of any set of facets
//! is a cycle. If a generic ray from the origin crosses it an odd number of times and no facet comes
//! nearer than some distance, then every ray meets a facet and the ball of that radius lies inside the
//! hull of the vertices. A facet whose vertices all have a height of `floor` or more along a unit
//! vector comes no nearer than `floor`, however that vector was found.

use super::{Facet, Polytope};
use crate::hull::plane::{V6, add_scaled, dot, scale};
use nalgebra::{Matrix6, Vector6};

/// Directions that are tried for a ray that stays clear of all ridges.
const RAYS: usize = 6;
/// A ray that passes a ridge by less than this, in shares of the facet's vertices, is not generic.
const CLEAR: f64 = 1e-9;

impl Polytope {
    /// The least height of a facet's vertices along its normal.
    pub(crate) fn floor(&self, facet: usize) -> f64 {
        let Facet {
            plane, vertices, ..
        } = &self.facets[facet];
        let height = |v: &u16| dot(&plane.normal, &self.vertices[*v as usize]);
        vertices.iter().map(height).fold(f64::INFINITY, f64::min)
    }

    /// The least floor of all facets.
    pub(crate) fn least_floor(&self) -> f64 {
        let floors = self.alive().map(|f| self.floor(f));
        floors.fold(f64::INFINITY, f64::min)
    }

    /// A radius such that every ray from the origin meets a facet that keeps that distance from it,
    /// or that a cap of directions settles at that level; 0 where that is not known.
    pub(crate) fn proved(&mut self) -> f64 {
        let mut least = f64::INFINITY;
        let mut clear = true;
        for facet in self.alive() {
            let floor = self.floor(facet);
            clear &= floor > 0.0;
            let bound = if self.facets[facet].covered {
                self.keys[facet]
            } else {
                floor
            };
            least = least.min(bound);
        }
        if !clear {
            return 0.0;
        }
        if !self.surrounds {
            self.surrounds = self.crossed_oddly();
        }
        if self.surrounds { least } else { 0.0 }
    }

    /// Whether the facets that the last flood collected are all clear of the origin.
    pub(super) fn stays_clear(&self) -> bool {
        let clear = |&f: &u32| {
            let plane = &self.facets[f as usize].plane;
            plane.offset > 4.0 * plane.residual + self.rounding
                || self.floor(f as usize) > self.rounding
        };
        self.visible.iter().all(clear)
    }

    /// Whether a generic ray from the origin crosses an odd number of facets.
    fn crossed_oddly(&mut self) -> bool {
        let mut facets = std::mem::take(&mut self.visible);
        facets.clear();
        facets.extend(self.alive().map(|f| f as u32));
        let odd = self.some_ray_crosses_oddly(&facets);
        self.visible = facets;
        odd
    }

    fn some_ray_crosses_oddly(&self, facets: &[u32]) -> bool {
        let step = (facets.len() / RAYS).max(1);
        for &seed in facets.iter().step_by(step).take(RAYS) {
            // A ray through the inside of one facet, off its centre.
            let corners = self.corners(seed as usize);
            let ray = (0..6).fold([0.0; 6], |s, k| {
                add_scaled(&s, 0.1 + 0.023 * (k * k) as f64, &corners[k])
            });
            if let Some(odd) = self.crossings(facets, &ray) {
                return odd;
            }
        }
        false
    }

    /// The parity of a ray's crossings, None if it comes near a ridge.
    fn crossings(&self, facets: &[u32], ray: &V6) -> Option<bool> {
        let mut odd = false;
        for &facet in facets {
            let facet = facet as usize;
            if dot(&self.facets[facet].plane.normal, ray) <= 0.0 {
                // All its vertices are on the other side of a plane through the origin.
                continue;
            }
            let corners = self.corners(facet);
            let columns = Matrix6::from_fn(|i, j| corners[j][i]);
            let shares = columns.lu().solve(&Vector6::from(*ray))?;
            let size = shares.amax();
            let least = shares.min();
            if least > CLEAR * size {
                odd = !odd;
            } else if least >= -CLEAR * size {
                return None;
            }
        }
        Some(odd)
    }

    /// Takes the level of a cap as the bound of a facet.
    pub(crate) fn cover(&mut self, facet: usize, level: f64) {
        self.facets[facet].covered = true;
        self.keys[facet] = self.keys[facet].max(level + self.drift);
    }

    /// Gives every covered facet its own offset as its bound again.
    pub(crate) fn uncover(&mut self) {
        for at in 0..self.facets.len() {
            if self.facets[at].covered && self.keys[at] < f64::INFINITY {
                self.facets[at].covered = false;
                self.keys[at] = self.facets[at].plane.offset + self.drift;
            }
        }
    }

    /// The tags and places of a facet's vertices and the barycentric coordinates of its plane's foot
    /// point; None for a facet too thin to have any.
    ///
    /// Single coordinates may be negative although the foot lies in the hull: three vertices on one
    /// disc span the plane of that disc.
    pub(crate) fn shares(&self, facet: usize) -> Option<[(u32, V6, f64); 6]> {
        let corners = self.corners(facet);
        let plane = &self.facets[facet].plane;
        let columns = Matrix6::from_fn(|i, j| corners[j][i]);
        let foot = Vector6::from(scale(&plane.normal, plane.offset));
        let weights = columns.lu().solve(&foot)?;
        let total = weights.sum();
        if !(0.5..2.0).contains(&total) {
            return None;
        }
        let tags = self.facets[facet].vertices.map(|v| self.tags[v as usize]);
        Some(std::array::from_fn(|k| {
            (tags[k], corners[k], weights[k] / total)
        }))
    }
}
