//! Whether the links stay away from obstacles and out of the scan.

use nalgebra::Isometry3;

use super::{ClosedHand, Rejection};
use crate::collision::CollisionObject;
use crate::hand::Hand;

/// Stations of the way from the open to the closed hand at which links are compared with obstacles.
const STATIONS: usize = 4;

/// The open hand is away from the obstacles.
pub(super) fn check_open(
    object: &CollisionObject<'_>,
    hand: &Hand,
    poses: &[Isometry3<f64>],
) -> Result<(), Rejection> {
    let around = object.surroundings();
    if around.obstacles.is_empty() {
        return Ok(());
    }
    let meets = |&l: &usize| around.meets_obstacle(&hand.shapes[l], &poses[l]);
    match (0..hand.shapes.len()).find(meets) {
        Some(link) => Err(Rejection::Obstacle { link }),
        None => Ok(()),
    }
}

/// The hand is away from the obstacles while it closes, seen from where the palm ended, and the closed
/// hand is outside the scan.
pub(super) fn check_closed(
    object: &CollisionObject<'_>,
    hand: &Hand,
    before: &[f64],
    state: &ClosedHand,
) -> Result<(), Rejection> {
    let around = object.surroundings();
    if !around.obstacles.is_empty() {
        let mut poses = state.object_from_links.clone();
        for station in 1..=STATIONS {
            let share = station as f64 / STATIONS as f64;
            let joints: Vec<f64> = before
                .iter()
                .zip(&state.joints)
                .map(|(start, end)| start + share * (end - start))
                .collect();
            let links = 1..poses.len();
            hand.model.update_links(&joints, links, &mut poses);
            check_open(object, hand, &poses)?;
        }
    }
    if around.cloud.is_empty() {
        return Ok(());
    }
    let poses = &state.object_from_links;
    let holds = |&l: &usize| around.holds_scan(&hand.shapes[l], &poses[l]);
    match (0..hand.shapes.len()).find(holds) {
        Some(link) => Err(Rejection::InScan { link }),
        None => Ok(()),
    }
}
