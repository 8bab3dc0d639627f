//! The heights of a hand's links above the plane on which the object stands.

use nalgebra::Isometry3;
use shape::Support;

use crate::hand::Hand;

impl Hand {
    /// The link that is nearest to a plane, or farthest below it, and its least height, for poses of
    /// all links in the plane's frame; `None` for a hand without geometry.
    ///
    /// Exact for primitives and for the convex hulls that replace meshes. Linear in the number of
    /// pieces.
    pub fn lowest_link(&self, support: &Support, poses: &[Isometry3<f64>]) -> Option<(usize, f64)> {
        let heights = (0..self.shapes.len()).filter_map(|link| {
            let height = self.link_height(link, support, &poses[link])?;
            Some((link, height))
        });
        heights.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Least height of a link above a plane; `None` without geometry.
    pub(crate) fn link_height(
        &self,
        link: usize,
        support: &Support,
        pose: &Isometry3<f64>,
    ) -> Option<f64> {
        let shape = &self.shapes[link];
        if shape.is_empty() {
            return None;
        }
        let local = support.seen_from(pose);
        Some(-shape.extent(&-local.normal.into_inner()) - local.offset_m)
    }
}
