//! Closing the fingers of one group until their tips have arrived.

use nalgebra::{Isometry3, Translation3, Vector3};

use super::{ClosedHand, ClosingRules, LEAST_STEP, Rejection, clearance, tip_gap};
use crate::collision::{CollisionObject, Precision};
use crate::hand::{FingerGroup, Hand};

/// Least move of a compliant palm, metres.
const LEAST_SHIFT: f64 = 1e-6;
/// Fraction of a free distance that the palm moves in one step.
const SAFE: f64 = 0.9;
/// Largest number of steps of one closing; a few dozen suffice when the tips start on both sides of
/// the middle.
const MAX_STEPS: usize = 4000;

/// The state of a group while it closes.
struct Closing<'a> {
    object: &'a CollisionObject<'a>,
    hand: &'a Hand,
    group: &'a FingerGroup,
    rules: &'a ClosingRules,
    start: Vec<f64>,
}

/// Closes a group by conservative advancement until the tips of its fingers have arrived.
///
/// The joints stop when the first tip arrives. If the group is compliant, the palm moves along the
/// line between the tips, so that both gaps become equal.
///
///
/// # Errors
///
/// A tip starts in the object or does not arrive, or another part comes too near.
pub(super) fn close_group(
    object: &CollisionObject<'_>,
    hand: &Hand,
    group: &FingerGroup,
    rules: &ClosingRules,
    state: &mut ClosedHand,
) -> Result<(), Rejection> {
    let closing = Closing {
        object,
        hand,
        group,
        rules,
        start: state.joints.clone(),
    };
    let end = closing.range();
    // The tips move to half of the gap, between overlap and the threshold of arrival.
    let aim = 0.5 * rules.tip_gap;
    let mut closed = 0.0;
    for _ in 0..MAX_STEPS {
        let gaps = closing.gaps(state);
        let free_step = closing.part_step(state)?;
        let (mut step, mut late) = (f64::INFINITY, None);
        for (&finger, &(lower, upper)) in group.fingers.iter().zip(&gaps) {
            if lower <= 0.0 {
                return Err(Rejection::StartsInObject { finger });
            }
            if !(upper + object.mesh_error() < rules.tip_gap) {
                late = late.or(Some(finger));
            }
            step = step.min((lower - aim) / closing.tip_speed(finger));
        }
        let Some(late) = late else {
            for &finger in &group.fingers {
                let tips = &hand.fingers[finger].tip_links;
                state.touching.extend_from_slice(tips);
            }
            return Ok(());
        };
        let moved = group.compliant && closing.recentre(&gaps, state)?;
        if moved {
            continue;
        }
        if closed >= end {
            return Err(Rejection::TipDidNotArrive { finger: late });
        }
        if !(step > LEAST_STEP) {
            // The distance is at the resolution of the facets and still above the gap, or the first
            // tip has arrived and stops the joints.
            return Err(if group.fingers.len() == 1 {
                Rejection::NoContact { finger: late }
            } else {
                Rejection::TipDidNotArrive { finger: late }
            });
        }
        closed = (closed + step.min(free_step)).min(end);
        closing.apply(closed, state);
        state.steps += 1;
    }
    let finger = group.fingers[0];
    Err(Rejection::TipDidNotArrive { finger })
}

impl Closing<'_> {
    /// The amount of closing after which all joints of the group are at their limits.
    fn range(&self) -> f64 {
        let left = |&(driven, ratio): &(usize, f64)| {
            let (lower, upper) = self.limits(driven);
            let end = if ratio > 0.0 { upper } else { lower };
            ((end - self.start[driven]) / ratio).max(0.0)
        };
        self.group.closing.iter().map(left).fold(0.0, f64::max)
    }

    fn limits(&self, driven: usize) -> (f64, f64) {
        self.hand.model.joints[self.hand.model.driven[driven]].limits
    }

    fn apply(&self, closed: f64, state: &mut ClosedHand) {
        for &(driven, ratio) in &self.group.closing {
            let (lower, upper) = self.limits(driven);
            state.joints[driven] = (self.start[driven] + ratio * closed).clamp(lower, upper);
        }
        self.hand.model.update_links(
            &state.joints,
            self.group.moving_links.iter().copied(),
            &mut state.object_from_links,
        );
    }

    /// Bounds on the distance of each finger's tip, exact enough to decide whether it has arrived.
    fn gaps(&self, state: &ClosedHand) -> Vec<(f64, f64)> {
        let precision = Precision {
            cutoff: f64::INFINITY,
            absolute: self.rules.tolerance,
            relative: 0.1,
        };
        let gap = |&finger: &usize| {
            let finger = &self.hand.fingers[finger];
            tip_gap(
                self.object,
                self.hand,
                finger,
                &state.object_from_links,
                precision,
            )
        };
        self.group.fingers.iter().map(gap).collect()
    }

    /// The step that the parts other than tips allow; an error where one is too near.
    fn part_step(&self, state: &ClosedHand) -> Result<f64, Rejection> {
        let mut step = f64::INFINITY;
        for (&link, &speed) in self.group.moving_links.iter().zip(&self.group.speed_bounds) {
            if self.is_tip(link) || self.hand.shapes[link].is_empty() {
                continue;
            }
            let free = self.clearance(link, state);
            if free < self.rules.object_clearance {
                return Err(Rejection::PartNearObject { link });
            }
            step = step.min(free / speed);
        }
        Ok(step)
    }

    fn clearance(&self, link: usize, state: &ClosedHand) -> f64 {
        let pose = &state.object_from_links[link];
        clearance(self.object, self.hand, link, pose, self.rules)
    }

    fn is_tip(&self, link: usize) -> bool {
        let mut fingers = self.group.fingers.iter();
        fingers.any(|&f| self.hand.fingers[f].tip_links.contains(&link))
    }

    fn tip_speed(&self, finger: usize) -> f64 {
        let tips = &self.hand.fingers[finger].tip_links;
        let links = self.group.moving_links.iter().zip(&self.group.speed_bounds);
        links
            .filter(|(link, _)| tips.contains(link))
            .map(|(_, speed)| *speed)
            .fold(0.0, f64::max)
    }

    /// Moves the whole hand along the line between the two tips towards equal gaps; returns whether
    /// it moved.
    ///
    /// No link moves farther than its distance from the object, so none penetrates it.
    fn recentre(&self, gaps: &[(f64, f64)], state: &mut ClosedHand) -> Result<bool, Rejection> {
        let &[(first, _), (second, _)] = gaps else {
            return Ok(false);
        };
        let axis = self.axis(state);
        let wanted = 0.5 * (second - first);
        // Distances are known to a tenth; gaps that agree within that count as equal.
        if wanted.abs() < (0.06 * first.max(second)).max(2.0 * self.rules.tolerance) {
            return Ok(false);
        }
        let mut free = SAFE * first.min(second);
        for link in 0..self.hand.shapes.len() {
            if !self.is_tip(link) && !self.hand.shapes[link].is_empty() {
                let left = self.clearance(link, state);
                if left < self.rules.object_clearance {
                    return Err(Rejection::PartNearObject { link });
                }
                free = free.min(SAFE * left);
            }
        }
        let shift = axis * wanted.clamp(-free, free);
        if !(shift.norm() > LEAST_SHIFT) {
            return Ok(false);
        }
        let moved = Isometry3::from_parts(Translation3::from(shift), Default::default());
        for pose in &mut state.object_from_links {
            *pose = moved * *pose;
        }
        state.steps += 1;
        Ok(true)
    }

    /// The direction from the second tip to the first, perpendicular to the approach, centred
    /// frame.
    fn axis(&self, state: &ClosedHand) -> Vector3<f64> {
        let middle = |finger: usize| {
            let link = self.hand.fingers[self.group.fingers[finger]].tip_links[0];
            state.object_from_links[link] * self.hand.shapes[link].centre
        };
        let across = middle(0) - middle(1);
        let approach = state.object_from_links[0] * self.hand.approach_axis;
        let across = across - approach.into_inner() * across.dot(&approach);
        across.try_normalize(1e-9).unwrap_or_default()
    }
}
