//! Distances between the links of a hand.

use nalgebra::Isometry3;

use super::piece::LinkShape;
use crate::hand::Hand;

/// The first tested pair of links closer than `least`, with its distance.
///
/// `poses` are those of all links in one frame.
pub(crate) fn first_close_pair(
    hand: &Hand,
    poses: &[Isometry3<f64>],
    least: f64,
) -> Option<(usize, usize, f64)> {
    hand.tested_pairs.iter().find_map(|&(a, b)| {
        let gap = pair_distance_below(hand, poses, a, b, least);
        gap.map(|distance| (a, b, distance))
    })
}

/// All tested pairs of links closer than `least`, with their distances.
pub(crate) fn all_close_pairs(
    hand: &Hand,
    poses: &[Isometry3<f64>],
    least: f64,
) -> Vec<(usize, usize, f64)> {
    let pairs = hand.tested_pairs.iter();
    pairs
        .filter_map(|&(a, b)| pair_distance_below(hand, poses, a, b, least).map(|d| (a, b, d)))
        .collect()
}

/// Distance of two links if it is below `least`.
fn pair_distance_below(
    hand: &Hand,
    poses: &[Isometry3<f64>],
    a: usize,
    b: usize,
    least: f64,
) -> Option<f64> {
    hand.shapes[a].distance_below(&poses[a], &hand.shapes[b], &poses[b], least)
}

impl LinkShape {
    /// Whether another link is nearer than `least`, metres; both poses in one frame.
    pub(crate) fn is_near(
        &self,
        pose: &Isometry3<f64>,
        other: &LinkShape,
        pose_of_other: &Isometry3<f64>,
        least: f64,
    ) -> bool {
        self.distance_below(pose, other, pose_of_other, least)
            .is_some()
    }

    /// The distance of another link if it is below `least`.
    fn distance_below(
        &self,
        pose: &Isometry3<f64>,
        other: &LinkShape,
        pose_of_other: &Isometry3<f64>,
        least: f64,
    ) -> Option<f64> {
        let between = (pose * self.centre - pose_of_other * other.centre).norm();
        if between - self.radius - other.radius >= least {
            return None;
        }
        let mut nearest = f64::INFINITY;
        for p in &self.pieces {
            let world_from_p = pose * p.link_from_piece;
            for q in &other.pieces {
                let world_from_q = pose_of_other * q.link_from_piece;
                let centres =
                    (world_from_p.translation.vector - world_from_q.translation.vector).norm();
                if centres - p.radius - q.radius < least {
                    nearest = nearest.min(p.piece_distance(&world_from_p, q, &world_from_q));
                }
            }
        }
        (nearest < least).then_some(nearest)
    }
}
