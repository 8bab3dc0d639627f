//! Checks that the links stay above the plane on which the object stands.

use nalgebra::Isometry3;

use super::{ClosedHand, ClosingRules, Rejection};
use crate::hand::{FingerGroup, Hand};

/// Number of states of a group's closing motion at which its links are tested.
const STATIONS: usize = 12;

/// Checks that every link is above the plane by the clearance.
pub(super) fn check_all(
    hand: &Hand,
    poses: &[Isometry3<f64>],
    rules: &ClosingRules,
) -> Result<(), Rejection> {
    let lowest = rules.support.and_then(|s| hand.lowest_link(&s, poses));
    match lowest {
        Some((link, height)) if !(height >= rules.support_clearance) => {
            Err(Rejection::BelowSupport { link })
        }
        _ => Ok(()),
    }
}

/// Checks that the links of a group stay above the plane during its closing motion.
///
/// Only the joints are varied; for a compliant group the palm has its final pose.
pub(super) fn check_way(
    hand: &Hand,
    group: &FingerGroup,
    before: &[f64],
    state: &ClosedHand,
    rules: &ClosingRules,
) -> Result<(), Rejection> {
    let Some(support) = rules.support else {
        return Ok(());
    };
    let mut joints = state.joints.clone();
    let mut poses = state.object_from_links.clone();
    for station in 0..=STATIONS {
        let share = station as f64 / STATIONS as f64;
        for &(driven, _) in &group.closing {
            joints[driven] = before[driven] + share * (state.joints[driven] - before[driven]);
        }
        let links = group.moving_links.iter().copied();
        hand.model.update_links(&joints, links, &mut poses);
        for &link in &group.moving_links {
            let height = hand.link_height(link, &support, &poses[link]);
            if height.is_some_and(|h| !(h >= rules.support_clearance)) {
                return Err(Rejection::BelowSupport { link });
            }
        }
    }
    Ok(())
}
