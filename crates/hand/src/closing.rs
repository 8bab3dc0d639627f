//! Closing the fingers of a hand on an object without ever passing through it.

mod wrapping;

use nalgebra::Isometry3;

use crate::collision::{CollisionObject, Precision, first_close_pair};
use crate::hand::{Finger, Hand};
use wrapping::wrap_finger;

/// A finger that could close no farther than this in a step has come to rest; in units of closing.
const LEAST_STEP: f64 = 1e-7;

/// When fingers have arrived and what must stay clear (paper, Sec. IV-C).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosingRules {
    /// A tip has arrived when it is nearer to the surface than this, metres.
    pub tip_gap: f64,
    /// Other parts of the hand stay at least this far from the object, metres.
    pub object_clearance: f64,
    /// Parts of the hand stay at least this far from each other, metres.
    pub self_clearance: f64,
    /// Close past the tips (power grasps): where a link other than a tip meets the object it
    /// holds it as a tip does, the joints that move it stop and those beyond go on.
    pub past_tips: bool,
    /// Distances are found to this accuracy where they decide, metres.
    pub tolerance: f64,
}

impl Default for ClosingRules {
    /// The paper's 1 mm, 5 mm and 5 mm, tips only.
    fn default() -> Self {
        ClosingRules {
            tip_gap: 1e-3,
            object_clearance: 5e-3,
            self_clearance: 5e-3,
            past_tips: false,
            tolerance: 2e-5,
        }
    }
}

/// Why a pose of the hand gives no grasp. Links and fingers by index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rejection {
    /// A link that closing does not move is too near to the object.
    BaseNearObject {
        /// The link.
        link: usize,
    },
    /// A finger is in the object before it begins to close.
    StartsInObject {
        /// The finger.
        finger: usize,
    },
    /// While closing, a link other than a tip came too near to the object.
    PartNearObject {
        /// The link.
        link: usize,
    },
    /// The finger closed to its joint limits and its tip met nothing.
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
}

/// A hand whose fingers have closed.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedHand {
    /// One value a driven joint.
    pub joints: Vec<f64>,
    /// Pose of every link in the object frame.
    pub object_from_links: Vec<Isometry3<f64>>,
    /// Links that hold the object, finger by finger, from the palm outwards.
    pub touching: Vec<usize>,
    /// Steps taken by all fingers together.
    pub steps: usize,
}

/// Closes every finger from `joints` until its tip has arrived, or with
/// [`ClosingRules::past_tips`] until all its joints have stopped.
///
/// Each step is the distance still free divided by a bound on the speed of the moving
/// points (conservative advancement), so no part passes into the surface. Fingers stop
/// one by one, each on its own. How they pass each other on the way depends on when each
/// motor runs, which nobody has said, so their distance is tested where they end. Errors: the
/// first rule broken.
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
    check_base(object, hand, &state.object_from_links, rules)?;
    for index in 0..hand.fingers.len() {
        check_start(object, hand, index, &state.object_from_links)?;
        if rules.past_tips {
            wrap_finger(object, hand, index, rules, &mut state)?;
        } else {
            close_finger(object, hand, index, rules, &mut state)?;
        }
    }
    match first_close_pair(hand, &state.object_from_links, rules.self_clearance) {
        Some((first, second, _)) => Err(Rejection::PartsNear { first, second }),
        None => Ok(state),
    }
}

/// Links that no finger moves must be clear of the object.
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

fn close_finger(
    object: &CollisionObject<'_>,
    hand: &Hand,
    index: usize,
    rules: &ClosingRules,
    state: &mut ClosedHand,
) -> Result<(), Rejection> {
    let finger = &hand.fingers[index];
    let start = state.joints.clone();
    let end = closing_range(hand, finger, &start);
    // The tip is brought to half of the gap, between touching and not having arrived.
    let aim = 0.5 * rules.tip_gap;
    let mut closed = 0.0;
    loop {
        let (tip_lower, tip_upper) = settle_tip(object, hand, finger, rules, state);
        let free_step = part_step(object, hand, finger, rules, state)?;
        if tip_lower <= 0.0 {
            return Err(Rejection::StartsInObject { finger: index });
        }
        if tip_upper + object.mesh_error() < rules.tip_gap {
            state.touching.extend_from_slice(&finger.tip_links);
            return Ok(());
        }
        if closed >= end {
            return Err(Rejection::TipDidNotArrive { finger: index });
        }
        let tip_speed = fastest(finger, |link| finger.tip_links.contains(&link));
        let tip_step = (tip_lower - aim) / tip_speed;
        if !(tip_step > LEAST_STEP) {
            // As near as the facets tell apart, and that is not near enough.
            return Err(Rejection::NoContact { finger: index });
        }
        closed = (closed + tip_step.min(free_step)).min(end);
        apply(hand, finger, &start, closed, state);
        state.steps += 1;
    }
}

/// How far a finger can close before all its closing joints are at their limits.
fn closing_range(hand: &Hand, finger: &Finger, joints: &[f64]) -> f64 {
    let model = &hand.model;
    finger
        .closing
        .iter()
        .map(|&(driven, ratio)| {
            let (lower, upper) = model.joints[model.driven[driven]].limits;
            let end = if ratio > 0.0 { upper } else { lower };
            ((end - joints[driven]) / ratio).max(0.0)
        })
        .fold(0.0, f64::max)
}

fn apply(hand: &Hand, finger: &Finger, start: &[f64], closed: f64, state: &mut ClosedHand) {
    let model = &hand.model;
    for &(driven, ratio) in &finger.closing {
        let (lower, upper) = model.joints[model.driven[driven]].limits;
        state.joints[driven] = (start[driven] + ratio * closed).clamp(lower, upper);
    }
    model.update_links(
        &state.joints,
        finger.moving_links.iter().copied(),
        &mut state.object_from_links,
    );
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

/// Bounds on the tip's distance, exact enough to tell whether it has arrived.
fn settle_tip(
    object: &CollisionObject<'_>,
    hand: &Hand,
    finger: &Finger,
    rules: &ClosingRules,
    state: &ClosedHand,
) -> (f64, f64) {
    let precision = Precision {
        cutoff: f64::INFINITY,
        absolute: rules.tolerance,
        relative: 0.1,
    };
    tip_gap(object, hand, finger, &state.object_from_links, precision)
}

/// The step that the parts other than tips allow; an error where one is too near.
fn part_step(
    object: &CollisionObject<'_>,
    hand: &Hand,
    finger: &Finger,
    rules: &ClosingRules,
    state: &ClosedHand,
) -> Result<f64, Rejection> {
    let mut step = f64::INFINITY;
    for (&link, &speed) in finger.moving_links.iter().zip(&finger.speed_bounds) {
        if finger.tip_links.contains(&link) || hand.shapes[link].is_empty() {
            continue;
        }
        let free = clearance(object, hand, link, &state.object_from_links[link], rules);
        if free < rules.object_clearance {
            return Err(Rejection::PartNearObject { link });
        }
        step = step.min(free / speed);
    }
    Ok(step)
}

fn fastest(finger: &Finger, wanted: impl Fn(usize) -> bool) -> f64 {
    finger
        .moving_links
        .iter()
        .zip(&finger.speed_bounds)
        .filter(|(link, _)| wanted(**link))
        .map(|(_, speed)| *speed)
        .fold(0.0, f64::max)
}
