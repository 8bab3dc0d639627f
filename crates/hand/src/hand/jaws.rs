//! The two tips of a gripper as jaws: closing axis, opening and depth.

use nalgebra::{Isometry3, Point3, UnitVector3};

use super::Hand;
use crate::kinematics::KinematicsError;

/// Number of states between the pre-shape and the limits of the closing joints.
const STATIONS: usize = 24;

/// Two tips that face each other, in the palm frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Jaws {
    /// The driven joints.
    pub joints: Vec<f64>,
    /// From the second tip to the first, across the line of approach.
    pub axis: UnitVector3<f64>,
    /// The middle between the tips. In the pre-shape it has the height of the approach point; if
    /// the tips advance along the approach while they close, it advances with them.
    pub middle: Point3<f64>,
    /// The distance between the tips, metres.
    pub opening: f64,
    /// The distance from the middle back to the palm, metres.
    pub depth: f64,
}

impl Hand {
    /// The jaws of a hand of two fingers while they close from a pre-shape, given by its index: the
    /// widest first, until the tips meet. Empty for other hands, and if one tip is behind the
    /// other.
    ///
    /// # Errors
    /// The joint values give no poses.
    pub fn jaws(&self, preshape: usize) -> Result<Vec<Jaws>, KinematicsError> {
        let mut all = Vec::new();
        let Some(start) = self.preshapes.get(preshape) else {
            return Ok(all);
        };
        if self.fingers.len() != 2 {
            return Ok(all);
        }
        let open = self.model.root_from_links(&start.joints)?;
        let before = self.tip_height(&open);
        for station in 0..STATIONS {
            let share = station as f64 / (STATIONS - 1) as f64;
            let joints = self.closed(&start.joints, share);
            let poses = self.model.root_from_links(&joints)?;
            let advance = self.tip_height(&poses) - before;
            match self.jaws_at(joints, &poses, advance) {
                Some(jaws) => all.push(jaws),
                None => break,
            }
        }
        all.sort_by(|a, b| b.opening.total_cmp(&a.opening));
        Ok(all)
    }

    /// The joints with every group closed by this fraction of the range to the limits of its
    /// joints.
    pub fn closed(&self, joints: &[f64], share: f64) -> Vec<f64> {
        let mut closed = joints.to_vec();
        for group in &self.groups {
            let left = |&(driven, ratio): &(usize, f64)| {
                let (lower, upper) = self.model.joints[self.model.driven[driven]].limits;
                let end = if ratio > 0.0 { upper } else { lower };
                ((end - joints[driven]) / ratio).max(0.0)
            };
            let range = group.closing.iter().map(left).fold(0.0, f64::max);
            for &(driven, ratio) in &group.closing {
                closed[driven] += share * range * ratio;
            }
        }
        self.model.clamp_to_limits(&mut closed);
        closed
    }

    fn jaws_at(&self, joints: Vec<f64>, poses: &[Isometry3<f64>], advance: f64) -> Option<Jaws> {
        let [first, second] = &self.fingers[..] else {
            return None;
        };
        let approach = self.approach_axis.into_inner();
        let across = self.tip_centre(first.tip_links[0], poses)
            - self.tip_centre(second.tip_links[0], poses);
        let axis = UnitVector3::try_new(across - approach * across.dot(&approach), 1e-6)?;
        let start = self.approach_point + approach * advance;
        // Displacement of each tip from the start along the axis.
        let far = |links: &[usize], way: f64| {
            let of_link = |&l: &usize| {
                let offset = self.shapes[l].offset_to(&poses[l], &start);
                -offset.dot(&axis) * way
            };
            links.iter().map(of_link).fold(f64::INFINITY, f64::min)
        };
        let (one, two) = (far(&first.tip_links, 1.0), far(&second.tip_links, -1.0));
        let middle = start + axis.into_inner() * (0.5 * (one - two));
        let fixed = |l: &usize| !self.fingers.iter().any(|f| f.moving_links.contains(l));
        let depth = (0..self.shapes.len())
            .filter(|l| fixed(l) && !self.shapes[*l].is_empty())
            .map(|l| self.shapes[l].offset_to(&poses[l], &middle).norm())
            .fold(f64::INFINITY, f64::min);
        (one + two > 0.0).then_some(Jaws {
            joints,
            axis,
            middle,
            opening: one + two,
            depth,
        })
    }

    /// Mean height of the tips along the approach.
    fn tip_height(&self, poses: &[Isometry3<f64>]) -> f64 {
        let tips = || self.fingers.iter().flat_map(|f| &f.tip_links);
        let height = |&l: &usize| self.tip_centre(l, poses).coords.dot(&self.approach_axis);
        tips().map(height).sum::<f64>() / tips().count() as f64
    }

    fn tip_centre(&self, link: usize, poses: &[Isometry3<f64>]) -> Point3<f64> {
        poses[link] * self.shapes[link].centre
    }
}
