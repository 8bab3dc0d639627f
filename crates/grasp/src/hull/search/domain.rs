//! Symmetric sets: a search of one domain of directions instead of all.
//!
//! Let G be a group of linear isometries under which the support function h does not change, and
//! q a vector. Every orbit of G has a direction u with q·u ≥ q·g u for all g, so c·u ≥ 0 for all
//! c = q − gᵀq: these half-spaces cut one domain out of the sphere, and h ≥ r there is h ≥ r everywhere.
//! In the domain h is the support function h′ of the set and the points −M c, as long as h is positive;
//! outside h′ soon is as large as M. So the search of the larger set has facets near the origin in the
//! domain only, and what it proves of h′ holds of h. Where products of maps are maps only up to δ, a
//! direction of the domain may have c·u ≥ −δ|q|/|c|, and what is proved must exceed M times that.

use super::Search;
use crate::hull::plane::{V6, add_scaled, dot, norm, scale};
use crate::hull::support::Support;

/// Angles by which maps of a group may miss their products.
const SLACK: f64 = 1e-4;
/// A vector, of length one, that no symmetry of a usual grasp keeps.
const PLACE: V6 = [0.417, 0.283, 0.539, 0.391, 0.347, 0.427];
/// M, in lengths of the longest point of the set.
const FAR: f64 = 30.0;
/// A half-space whose vector is shorter than this says too little.
const SHORT: f64 = 0.02;

/// Tags of the points beyond the domain begin here.
pub(crate) const BEYOND: u32 = u32::MAX - 1024;

impl Search {
    /// Half-spaces that cut one domain out of the symmetries' orbits, and the points beyond them.
    ///
    /// Symmetries that are off by more than `most` would cost too much of the interval.
    pub(super) fn lay_out_domain(&mut self, source: &impl Support, reach: f64, most: f64) {
        self.domain.clear();
        self.beyond.clear();
        self.beyond_level = 0.0;
        if self.whole || !source.is_curved() {
            return;
        }
        source.symmetries(&mut self.symmetries);
        if self.symmetries.error > most || self.symmetries.slack > 0.5 * SLACK * SHORT {
            return;
        }
        for map in &self.symmetries.maps {
            // The transpose of the map takes the vector to an image under the inverse.
            let image = (0..6).fold([0.0; 6], |s, k| add_scaled(&s, PLACE[k], &map[k]));
            let apart = add_scaled(&PLACE, -1.0, &image);
            let length = norm(&apart);
            if length > SHORT {
                let c = scale(&apart, 1.0 / length);
                self.domain.push(c);
                self.beyond.push(scale(&c, -FAR * reach));
            }
        }
        self.beyond_level = FAR * reach * (2.0 * self.symmetries.slack / SHORT + 1e-13);
    }

    /// The farthest of the points beyond the domain along a direction, if it is higher than `height`.
    pub(super) fn beyond(&self, direction: &V6, height: f64) -> Option<(V6, u32, f64)> {
        let all = self.beyond.iter().zip(BEYOND..);
        let heights = all.map(|(point, tag)| (*point, tag, dot(direction, point)));
        heights
            .filter(|found| found.2 > height)
            .max_by(|a, b| a.2.total_cmp(&b.2))
    }

    /// Whether all directions that a facet leaves in doubt at `level` have an image elsewhere, in the
    /// domain of the symmetries: then the facet is settled by the facets there.
    pub(super) fn elsewhere(&mut self, facet: usize, level: f64) -> bool {
        if self.domain.is_empty() || level <= 0.0 {
            return false;
        }
        let floor = self.polytope.floor(facet);
        if floor <= 0.0 {
            return false;
        }
        let normal = self.polytope.facets[facet].plane.normal;
        let spread = (floor / level).min(1.0).acos() + SLACK;
        let outside = -spread.min(std::f64::consts::FRAC_PI_2).sin();
        let settled = self.domain.iter().any(|c| dot(c, &normal) < outside);
        if settled {
            self.polytope.cover(facet, level);
        }
        settled
    }
}
