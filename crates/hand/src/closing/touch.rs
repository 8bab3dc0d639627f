//! From a hand that has closed to one whose tips touch.

use nalgebra::Isometry3;

use super::tip_gap;
use crate::collision::{CollisionObject, Precision};
use crate::hand::{FingerGroup, Hand};

/// Tips nearer than this hold the object, metres.
const HOLDS: f64 = 1.5e-3;
/// A tip touches when it is nearer than this to the mesh of the object, metres.
const TOUCHES: f64 = 2e-4;
/// Steps of one group, at most.
const MAX_STEPS: usize = 100;

/// The joints of a closed hand with the fingers closed on until their tips touch the surface.
///
/// A closed hand ([`crate::close_hand`]) leaves up to a millimetre between its tips and the object.
/// Each group goes on, without passing into the object, until the first of its tips is nearer than
/// 0.2 mm; groups that hold nothing stay as they are.
pub fn touching_joints(
    object: &CollisionObject<'_>,
    hand: &Hand,
    object_from_palm: &Isometry3<f64>,
    joints: &[f64],
) -> Vec<f64> {
    let mut joints = joints.to_vec();
    let mut poses = vec![*object_from_palm; hand.model.links.len()];
    let links = 1..hand.model.links.len();
    hand.model.update_links(&joints, links, &mut poses);
    for group in &hand.groups {
        touch(object, hand, group, &mut joints, &mut poses);
    }
    joints
}

fn touch(
    object: &CollisionObject<'_>,
    hand: &Hand,
    group: &FingerGroup,
    joints: &mut [f64],
    poses: &mut [Isometry3<f64>],
) {
    let precision = Precision {
        cutoff: f64::INFINITY,
        absolute: 2e-5,
        relative: 0.0,
    };
    let speed = group.speed_bounds.iter().copied().fold(0.0, f64::max);
    for _ in 0..MAX_STEPS {
        let (mut lower, mut upper) = (f64::INFINITY, f64::INFINITY);
        for &finger in &group.fingers {
            let gap = tip_gap(object, hand, &hand.fingers[finger], poses, precision);
            (lower, upper) = (lower.min(gap.0), upper.min(gap.1));
        }
        let step = (lower - 0.5 * TOUCHES) / speed;
        if upper > HOLDS || upper <= TOUCHES || !(step > 0.0) {
            return;
        }
        let before = joints.to_vec();
        for &(driven, ratio) in &group.closing {
            joints[driven] += step * ratio;
        }
        hand.model.clamp_to_limits(joints);
        if *joints == before {
            return;
        }
        let links = group.moving_links.iter().copied();
        hand.model.update_links(joints, links, poses);
    }
}
