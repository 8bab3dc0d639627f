//! A fast test, before closing, whether a hand at a pose is clear of points of a surface.

use nalgebra::{Isometry3, Point3, Vector3};

use crate::collision::LinkShape;
use crate::hand::Hand;

/// Links with the fingers in one state, and bounding boxes, in the palm frame.
pub(super) struct Obstacles<'a> {
    links: Vec<Placed<'a>>,
}

struct Placed<'a> {
    shape: &'a LinkShape,
    palm_from_link: Isometry3<f64>,
    least: Vector3<f64>,
    greatest: Vector3<f64>,
    clearance: f64,
}

impl<'a> Obstacles<'a> {
    /// All links with their clearances in metres: one for tips, which are ignored without it, and
    /// one for the others.
    pub(super) fn new(
        hand: &'a Hand,
        joints: &[f64],
        clearance: f64,
        of_tips: Option<f64>,
    ) -> Option<Self> {
        let poses = hand.model().root_from_links(joints).ok()?;
        let is_tip = |l: &usize| hand.fingers().iter().any(|f| f.tip_links.contains(l));
        let mut links = Vec::new();
        for (link, shape) in hand.shapes.iter().enumerate() {
            let wanted = if is_tip(&link) {
                of_tips
            } else {
                Some(clearance)
            };
            if let Some(clearance) = wanted.filter(|_| !shape.is_empty()) {
                links.push(Placed::new(shape, poses[link], clearance));
            }
        }
        Some(Obstacles { links })
    }

    /// Whether any of the points is within the clearance of a link.
    pub(super) fn meet(&self, palm_from_object: &Isometry3<f64>, points: &[Point3<f64>]) -> bool {
        points.iter().any(|p| {
            let p = palm_from_object * p;
            self.links.iter().any(|link| link.holds(&p))
        })
    }
}

impl<'a> Placed<'a> {
    fn new(shape: &'a LinkShape, palm_from_link: Isometry3<f64>, clearance: f64) -> Self {
        let mut least = Vector3::repeat(f64::INFINITY);
        let mut greatest = Vector3::repeat(f64::NEG_INFINITY);
        for vertex in shape.mesh(&palm_from_link).vertices {
            least = least.inf(&vertex.coords);
            greatest = greatest.sup(&vertex.coords);
        }
        Placed {
            shape,
            palm_from_link,
            least: least.add_scalar(-clearance),
            greatest: greatest.add_scalar(clearance),
            clearance,
        }
    }

    fn holds(&self, p: &Point3<f64>) -> bool {
        let boxed = (0..3).all(|k| self.least[k] <= p[k] && p[k] <= self.greatest[k]);
        boxed && self.shape.offset_to(&self.palm_from_link, p).norm() <= self.clearance
    }
}
