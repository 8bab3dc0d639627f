//! Closing fingers past their tips: every joint moves until a link that it moves touches.

use super::{ClosedHand, ClosingRules, LEAST_STEP, Rejection};
use crate::collision::{CollisionObject, Gap, Precision};
use crate::hand::{FingerGroup, Hand};

/// The state of a group's closing joints.
struct Wrapping<'a> {
    object: &'a CollisionObject<'a>,
    hand: &'a Hand,
    group: &'a FingerGroup,
    rules: &'a ClosingRules,
    /// Closing joints that still move.
    active: Vec<bool>,
}

/// Closes a group joint by joint, by conservative advancement as with tips alone.
///
///
/// A joint stops at its limit or when any link that it moves is within the tip gap. Joints never
/// open.
///
/// # Errors
///
/// A finger starts in the object, or none of its links touches.
pub(super) fn wrap_group(
    object: &CollisionObject<'_>,
    hand: &Hand,
    group: &FingerGroup,
    rules: &ClosingRules,
    state: &mut ClosedHand,
) -> Result<(), Rejection> {
    let mut wrapping = Wrapping {
        object,
        hand,
        group,
        rules,
        active: vec![true; group.closing.len()],
    };
    loop {
        let step = wrapping.free_step(state).ok_or(Rejection::StartsInObject {
            finger: group.fingers[0],
        })?;
        wrapping.stop_at_limits(state);
        if !wrapping.active.contains(&true) {
            break;
        }
        if step > LEAST_STEP {
            wrapping.advance(step, state);
        }
    }
    let before = state.touching.len();
    for &link in &group.moving_links {
        let gap = wrapping.gap(link, state);
        if !hand.shapes[link].is_empty() && wrapping.has_arrived(&gap) {
            state.touching.push(link);
        }
    }
    let touches = |finger: usize| {
        let links = &hand.fingers[finger].moving_links;
        state.touching[before..].iter().any(|l| links.contains(l))
    };
    match group.fingers.iter().find(|f| !touches(**f)) {
        Some(&finger) => Err(Rejection::TipDidNotArrive { finger }),
        None => Ok(()),
    }
}

impl Wrapping<'_> {
    /// The step that every link allows; links that have arrived stop their joints. `None` if a link
    /// is in the object.
    fn free_step(&mut self, state: &ClosedHand) -> Option<f64> {
        // A link moves to half of the gap, between overlap and the threshold of arrival.
        let aim = 0.5 * self.rules.tip_gap;
        let mut step = f64::INFINITY;
        for (k, &link) in self.group.moving_links.iter().enumerate() {
            if self.hand.shapes[link].is_empty() || self.speed(k) <= 0.0 {
                continue;
            }
            let gap = self.gap(link, state);
            if gap.lower <= 0.0 {
                return None;
            }
            let free = (gap.lower - aim) / self.speed(k);
            if self.has_arrived(&gap) || !(free > LEAST_STEP) {
                for (active, speed) in self.active.iter_mut().zip(&self.group.joint_speeds[k]) {
                    *active &= *speed <= 0.0;
                }
            } else {
                step = step.min(free);
            }
        }
        Some(step)
    }

    fn gap(&self, link: usize, state: &ClosedHand) -> Gap {
        let precision = Precision {
            cutoff: f64::INFINITY,
            absolute: self.rules.tolerance,
            relative: 0.1,
        };
        let pose = &state.object_from_links[link];
        self.object
            .link_gap(&self.hand.shapes[link], pose, precision)
    }

    fn has_arrived(&self, gap: &Gap) -> bool {
        gap.upper + self.object.mesh_error() < self.rules.tip_gap
    }

    /// Bound on the speed of a moving link under the joints that still move.
    fn speed(&self, link: usize) -> f64 {
        let parts = self.group.joint_speeds[link].iter().zip(&self.active);
        parts.filter(|(_, active)| **active).map(|(s, _)| s).sum()
    }

    fn limit(&self, joint: usize) -> f64 {
        let (driven, ratio) = self.group.closing[joint];
        let (lower, upper) = self.hand.model.joints[self.hand.model.driven[driven]].limits;
        if ratio > 0.0 { upper } else { lower }
    }

    fn stop_at_limits(&mut self, state: &ClosedHand) {
        for joint in 0..self.active.len() {
            let (driven, ratio) = self.group.closing[joint];
            let left = (self.limit(joint) - state.joints[driven]) / ratio;
            self.active[joint] &= left > LEAST_STEP;
        }
    }

    fn advance(&self, step: f64, state: &mut ClosedHand) {
        for (joint, &(driven, ratio)) in self.group.closing.iter().enumerate() {
            if self.active[joint] {
                let left = (self.limit(joint) - state.joints[driven]) / ratio;
                state.joints[driven] += ratio * step.min(left);
            }
        }
        self.hand.model.update_links(
            &state.joints,
            self.group.moving_links.iter().copied(),
            &mut state.object_from_links,
        );
        state.steps += 1;
    }
}
