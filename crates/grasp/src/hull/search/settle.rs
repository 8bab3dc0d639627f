//! What settles facets of a curved hull: caps around touching faces, and symmetries.

use std::f64::consts::FRAC_PI_2;

use super::{Bounds, Search};
use crate::hull::cap::Cap;
use crate::hull::plane::{V6, add_scaled, dot, norm, scale};
use crate::hull::support::Support;

/// Angles are taken to be as uncertain as this: what rounding does to an arc cosine near one.
const ANGLE: f64 = 1e-7;
/// A facet whose rays may lie this far from its normal is too coarse to begin a touching face.
const COARSE: f64 = 0.7;
/// Angles by which maps of a group may miss their products.
const SLACK: f64 = 1e-5;
/// A unit vector that no symmetry of a usual grasp keeps.
const PLACE: V6 = [0.417, 0.283, 0.539, 0.391, 0.347, 0.427];

/// When to look for a touching face again.
#[derive(Default)]
pub(super) struct Hunt {
    expansions: usize,
    next: usize,
    failures: usize,
    /// Whether symmetries were looked for.
    pub(super) asked: bool,
}

impl Search {
    /// Whether a known cap settles a facet, which is then marked.
    pub(super) fn covered(&mut self, facet: usize) -> bool {
        let normal = self.polytope.facets[facet].plane.normal;
        let mut floor = None;
        for at in 0..self.caps.len() {
            let Cap {
                touching,
                angle,
                level,
            } = self.caps[at];
            let apart = dot(&normal, &touching.direction);
            if apart <= angle.cos() {
                continue;
            }
            let floor = *floor.get_or_insert_with(|| self.polytope.floor(facet));
            let spread = (floor / level).min(1.0).acos();
            if apart.min(1.0).acos() + spread + 2.0 * ANGLE <= angle {
                self.polytope.cover(facet, level);
                return true;
            }
        }
        false
    }

    /// Half-spaces that cut one domain out of the symmetries' orbits: the unit vectors to which a
    /// certain vector is as near as any of its images.
    ///
    /// Symmetries that are off by more than `most` would cost too much of the interval.
    pub(super) fn lay_out_domain(&mut self, most: f64) {
        self.domain.clear();
        if self.symmetries.error > most {
            return;
        }
        for map in &self.symmetries.maps {
            // The transpose of the map takes the vector to an image under the inverse.
            let image = (0..6).fold([0.0; 6], |s, k| add_scaled(&s, PLACE[k], &map[k]));
            let apart = add_scaled(&PLACE, -1.0, &image);
            let length = norm(&apart);
            if length > 1e-2 {
                self.domain.push(scale(&apart, 1.0 / length));
            }
        }
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
        let outside = -spread.min(FRAC_PI_2).sin();
        let settled = self.domain.iter().any(|c| dot(c, &normal) < outside);
        if settled {
            self.polytope.cover(facet, level);
        }
        settled
    }

    /// Looks for the face that the ball touches near a facet, and for a cap around it; true if the
    /// facet is settled by it.
    pub(super) fn hunt(
        &mut self,
        source: &mut impl Support,
        facet: usize,
        gap: f64,
        rounding: f64,
        bounds: &mut Bounds,
        hunt: &mut Hunt,
    ) -> bool {
        hunt.expansions += 1;
        if hunt.expansions < hunt.next {
            return false;
        }
        let plane = self.polytope.facets[facet].plane;
        let level = bounds.level(gap);
        let spread = if level > 0.0 {
            (plane.offset / level).clamp(-1.0, 1.0).acos()
        } else {
            0.0
        };
        let due = hunt.expansions >= 8 && hunt.expansions.is_power_of_two();
        if spread > COARSE && !due {
            return false;
        }
        let near = |cap: &Cap| {
            let apart = dot(&cap.touching.direction, &plane.normal).min(1.0).acos();
            apart < (2.0 * spread).max(0.02)
        };
        if self.caps.iter().any(near) {
            return false;
        }
        let touching = self
            .polytope
            .shares(facet)
            .and_then(|shares| source.touching(&plane.normal, &shares));
        let Some(touching) = touching else {
            hunt.failures += 1;
            hunt.next = hunt.expansions + 3 * hunt.failures;
            return false;
        };
        let height = dot(&touching.direction, &source.support(&touching.direction).0);
        bounds.below(height, &touching.direction);
        let level = bounds.level(gap.max(8.0 * rounding));
        let angle = source.cap(&touching, level);
        self.caps.push(Cap {
            touching,
            angle,
            level,
        });
        self.covered(facet)
    }
}
