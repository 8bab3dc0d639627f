//! Closing the fingers of a hand on an object without penetration.

mod above;
mod around;
mod group;
mod touch;
mod wrapping;

use nalgebra::Isometry3;

use crate::collision::{CollisionObject, Precision, first_close_pair};
use crate::hand::{Finger, FingerGroup, Hand};
use group::close_group;
use shape::Support;
pub use touch::touching_joints;
use wrapping::wrap_group;

/// A finger has come to rest if a step closes it by less than this, in units of closing.
const LEAST_STEP: f64 = 1e-7;

/// The closing rules: when fingers have arrived, and the clearances (paper, Sec. IV-C).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosingRules {
    /// A tip has arrived when it is nearer to the surface than this, metres.
    pub tip_gap: f64,
    /// Other parts of the hand stay at least this far from the object, metres.
    pub object_clearance: f64,
    /// Parts of the hand stay at least this far from each other, metres.
    pub self_clearance: f64,
    /// Close past the tips (power grasps): a link other than a tip that touches the object makes a
    /// contact as a tip does. The joints that move it stop, and the joints beyond it continue.
    pub past_tips: bool,
    /// The plane on which the object stands, if it stands on one.
    pub support: Option<Support>,
    /// Every part of the hand stays at least this far above that plane, metres.
    pub support_clearance: f64,
    /// Accuracy of distances near a threshold, metres.
    pub tolerance: f64,
}

impl Default for ClosingRules {
    /// The paper's 1 mm, 5 mm and 5 mm, tips only; no support, with a clearance of 3 mm for one.
    fn default() -> Self {
        ClosingRules {
            tip_gap: 1e-3,
            object_clearance: 5e-3,
            self_clearance: 5e-3,
            past_tips: false,
            support: None,
            support_clearance: 3e-3,
            tolerance: 2e-5,
        }
    }
}

/// Why a pose of the hand gives no grasp. Links and fingers are given by index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rejection {
    /// A link is below the support plane, or too near to it.
    BelowSupport {
        /// The link.
        link: usize,
    },
    /// A link is too near to another piece of the scene.
    Obstacle {
        /// The link.
        link: usize,
    },
    /// A link is inside the scan of the object, outside of the fitted surface.
    InScan {
        /// The link.
        link: usize,
    },
    /// A link that closing does not move is too near to the object.
    BaseNearObject {
        /// The link.
        link: usize,
    },
    /// A finger is in the object before it starts to close.
    StartsInObject {
        /// The finger.
        finger: usize,
    },
    /// While closing, a link other than a tip came too near to the object.
    PartNearObject {
        /// The link.
        link: usize,
    },
    /// The finger closed to its joint limits and its tip touched nothing.
    TipDidNotArrive {
        /// The finger.
        finger: usize,
    },
    /// Two links are too near to each other when all fingers have closed.
    PartsNear {
        /// A link.
        first: usize,
        /// The other.
        second: usize,
    },
    /// The closest point of the smooth surface is not within the tip gap.
    NoContact {
        /// The finger.
        finger: usize,
    },
    /// A finger touches a part of the surface that closes a hole of the object.
    OnClosedHole {
        /// The finger.
        finger: usize,
    },
}

/// A hand whose fingers have closed.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedHand {
    /// One value per driven joint.
    pub joints: Vec<f64>,
    /// Pose of every link in the centred frame. That of the palm, the first, is unchanged, unless
    /// the palm is compliant ([`crate::FingerGroup::compliant`]).
    pub object_from_links: Vec<Isometry3<f64>>,
    /// Links that touch the object, finger by finger, from the palm outwards.
    pub touching: Vec<usize>,
    /// Steps taken by all fingers together.
    pub steps: usize,
}

/// Closes every finger from `joints` until its tip has arrived, or with
/// [`ClosingRules::past_tips`] until all its joints have stopped.
///
///
/// Each step is the distance still free divided by a bound on the speed of the moving points
/// (conservative advancement), so no part passes into the surface. Each finger stops separately;
/// fingers that the same joints close stop together. If not all must touch
/// ([`Hand::least_fingers`]), those that touch nothing keep their first joint values. Clearance
/// between fingers is tested in the final pose only, since the closing order is unspecified.
///
/// # Errors
///
/// The first rule that is broken.
pub fn close_hand(
    object: &CollisionObject<'_>,
    hand: &Hand,
    object_from_palm: &Isometry3<f64>,
    joints: &[f64],
    rules: &ClosingRules,
) -> Result<ClosedHand, Rejection> {
    let mut state = ClosedHand {
        joints: joints.to_vec(),
        object_from_links: vec![*object_from_palm; hand.model.links.len()],
        touching: Vec::new(),
        steps: 0,
    };
    let links = 1..hand.model.links.len();
    hand.model
        .update_links(joints, links, &mut state.object_from_links);
    above::check_all(hand, &state.object_from_links, rules)?;
    around::check_open(object, hand, &state.object_from_links)?;
    check_base(object, hand, &state.object_from_links, rules)?;
    let mut missing = None;
    for group in &hand.groups {
        for &finger in &group.fingers {
            check_start(object, hand, finger, &state.object_from_links)?;
        }
        let closed = if rules.past_tips {
            wrap_group(object, hand, group, rules, &mut state)
        } else {
            close_group(object, hand, group, rules, &mut state)
        };
        match closed {
            Err(reason @ Rejection::TipDidNotArrive { .. }) => {
                // Fingers without a contact stay open.
                missing = missing.or(Some(reason));
                reopen(hand, group, joints, &mut state);
            }
            other => {
                other?;
                above::check_way(hand, group, joints, &state, rules)?;
            }
        }
        if group.compliant {
            check_base(object, hand, &state.object_from_links, rules)?;
        }
    }
    if let Some(reason) = missing
        && arrived(hand, &state) < hand.least_fingers
    {
        return Err(reason);
    }
    above::check_all(hand, &state.object_from_links, rules)?;
    match first_close_pair(hand, &state.object_from_links, rules.self_clearance) {
        Some((first, second, _)) => Err(Rejection::PartsNear { first, second }),
        None => around::check_closed(object, hand, joints, &state).map(|()| state),
    }
}

fn reopen(hand: &Hand, group: &FingerGroup, joints: &[f64], state: &mut ClosedHand) {
    for &(driven, _) in &group.closing {
        state.joints[driven] = joints[driven];
    }
    let links = group.moving_links.iter().copied();
    hand.model
        .update_links(&state.joints, links, &mut state.object_from_links);
    state.touching.retain(|l| !group.moving_links.contains(l));
}

/// Number of fingers with a link that touches.
fn arrived(hand: &Hand, state: &ClosedHand) -> usize {
    let touches = |f: &&Finger| f.moving_links.iter().any(|l| state.touching.contains(l));
    hand.fingers.iter().filter(touches).count()
}

/// Checks that the links that no finger moves are clear of the object.
fn check_base(
    object: &CollisionObject<'_>,
    hand: &Hand,
    poses: &[Isometry3<f64>],
    rules: &ClosingRules,
) -> Result<(), Rejection> {
    let moves = |link: &usize| hand.fingers.iter().any(|f| f.moving_links.contains(link));
    for link in (0..hand.shapes.len()).filter(|l| !moves(l)) {
        let free = clearance(object, hand, link, &poses[link], rules);
        if free < rules.object_clearance || object.holds_piece_of(&hand.shapes[link], &poses[link])
        {
            return Err(Rejection::BaseNearObject { link });
        }
    }
    Ok(())
}

/// A lower bound on the distance of a link to the smooth surface, exact near the clearance.
fn clearance(
    object: &CollisionObject<'_>,
    hand: &Hand,
    link: usize,
    pose: &Isometry3<f64>,
    rules: &ClosingRules,
) -> f64 {
    let least = rules.object_clearance + object.mesh_error();
    let precision = Precision {
        cutoff: 4.0 * least,
        absolute: rules.tolerance,
        relative: 0.2,
    };
    let rough = object.link_gap(&hand.shapes[link], pose, precision);
    if rough.lower >= least || rough.upper < least {
        return rough.lower - object.mesh_error();
    }
    let exact = Precision {
        relative: 0.0,
        ..precision
    };
    object.link_gap(&hand.shapes[link], pose, exact).lower - object.mesh_error()
}

/// Distance of a finger's tip to the mesh.
pub(crate) fn tip_gap(
    object: &CollisionObject<'_>,
    hand: &Hand,
    finger: &Finger,
    poses: &[Isometry3<f64>],
    mut precision: Precision,
) -> (f64, f64) {
    let (mut lower, mut upper) = (f64::INFINITY, f64::INFINITY);
    for &link in &finger.tip_links {
        let gap = object.link_gap(&hand.shapes[link], &poses[link], precision);
        lower = gap.lower.min(lower);
        upper = gap.upper.min(upper);
        precision.cutoff = precision.cutoff.min(upper);
    }
    (lower, upper)
}

fn check_start(
    object: &CollisionObject<'_>,
    hand: &Hand,
    index: usize,
    poses: &[Isometry3<f64>],
) -> Result<(), Rejection> {
    let inside = |&link: &usize| object.holds_piece_of(&hand.shapes[link], &poses[link]);
    if hand.fingers[index].moving_links.iter().any(inside) {
        return Err(Rejection::StartsInObject { finger: index });
    }
    Ok(())
}
