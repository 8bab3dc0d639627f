//! What settles facets of a curved hull: caps around touching faces, and symmetries.

use super::{Bounds, Search};
use crate::hull::cap::Cap;
use crate::hull::plane::dot;
use crate::hull::support::Support;

/// Angles are taken to be as uncertain as this: what rounding does to an arc cosine near one.
const ANGLE: f64 = 1e-7;
/// A facet whose rays may lie this far from its normal is too coarse to begin a touching face.
const COARSE: f64 = 0.7;
/// Facets whose rays may lie farther from their normals do not lie beside a minimum.
const BESIDE: f64 = 0.1;

/// When to look for a touching face again.
#[derive(Default)]
pub(super) struct Hunt {
    expansions: usize,
    next: usize,
    failures: usize,
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
                ..
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
        let Some(shares) = self.polytope.shares(facet) else {
            return false;
        };
        let level_of = |bounds: &Bounds| bounds.level(gap.max(8.0 * rounding));
        let near = |cap: &Cap| {
            let apart = dot(&cap.touching.direction, &plane.normal).min(1.0).acos();
            apart < (2.0 * spread).max(0.02)
        };
        if !self.caps.iter().any(near)
            && let Some(touching) = source.touching(&plane.normal, &shares)
        {
            let height = dot(&touching.direction, &source.support(&touching.direction).0);
            bounds.below(height, &touching.direction);
            let level = level_of(bounds);
            let known = |cap: &Cap| dot(&cap.touching.direction, &touching.direction) > 1.0 - 1e-12;
            if !self.caps.iter().any(known) {
                self.caps.push(Cap {
                    touching,
                    touches: true,
                    angle: source.cap(&touching, level),
                    level,
                });
                if self.covered(facet) {
                    return true;
                }
            }
        }
        if spread < BESIDE
            && let Some(touching) = source.beside(&plane.normal, &shares)
        {
            let height = dot(&touching.direction, &source.support(&touching.direction).0);
            bounds.below(height, &touching.direction);
            let level = level_of(bounds);
            let angle = source.cap(&touching, level);
            let apart = dot(&touching.direction, &plane.normal).min(1.0).acos();
            if angle > apart + spread {
                self.caps.push(Cap {
                    touching,
                    touches: false,
                    angle,
                    level,
                });
                if self.covered(facet) {
                    return true;
                }
            }
        }
        hunt.failures += 1;
        hunt.next = hunt.expansions + 3 * hunt.failures;
        false
    }
}
