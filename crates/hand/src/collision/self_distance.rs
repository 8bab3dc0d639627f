//! Distances between the links of a hand.

use nalgebra::Isometry3;

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
    let (first, second) = (&hand.shapes[a], &hand.shapes[b]);
    let between = (poses[a] * first.centre - poses[b] * second.centre).norm();
    if between - first.radius - second.radius >= least {
        return None;
    }
    let mut nearest = f64::INFINITY;
    for p in &first.pieces {
        let world_from_p = poses[a] * p.link_from_piece;
        for q in &second.pieces {
            let world_from_q = poses[b] * q.link_from_piece;
            let centres =
                (world_from_p.translation.vector - world_from_q.translation.vector).norm();
            if centres - p.radius - q.radius < least {
                nearest = nearest.min(p.piece_distance(&world_from_p, q, &world_from_q));
            }
        }
    }
    (nearest < least).then_some(nearest)
}
