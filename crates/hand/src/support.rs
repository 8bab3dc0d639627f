//! The plane on which the object stands, and the heights of a hand's links above it.

use nalgebra::{Isometry3, Point3, UnitVector3};

use crate::hand::Hand;

/// The half-space {x : normal · x ≥ offset} above the plane on which the object stands.
///
/// Lengths in metres, in the frame in which a hand is placed: the object frame here, the frame of the
/// cloud where a user gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Unit normal, towards the object.
    pub normal: UnitVector3<f64>,
    /// Signed distance of the plane from the origin.
    pub offset: f64,
}

impl Support {
    /// Height of a point above the plane.
    pub fn height(&self, p: &Point3<f64>) -> f64 {
        self.normal.dot(&p.coords) - self.offset
    }

    /// The plane seen from a frame at this pose, given in the frame of the plane.
    pub fn seen_from(&self, pose: &Isometry3<f64>) -> Self {
        Support {
            normal: pose.inverse_transform_unit_vector(&self.normal),
            offset: -self.height(&pose.translation.vector.into()),
        }
    }
}

impl Hand {
    /// The link that is nearest to a plane, or farthest below it, and its least height, for poses of
    /// all links in the plane's frame; `None` for a hand without geometry.
    ///
    /// Exact for primitives and for the hulls that stand in for meshes. Linear in the pieces.
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
        Some(-shape.extent(&-local.normal.into_inner()) - local.offset)
    }
}
