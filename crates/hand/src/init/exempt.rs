//! Pairs of links that lie side by side by construction.

use super::fingers::{Finger, Resting};
use super::opposition::close;
use crate::collision::LinkShape;
use crate::model::HandModel;
use nalgebra::Isometry3;

/// Random states of the joints that are looked at.
const SAMPLES: usize = 150;
/// States between open and half closed that are looked at for each start.
const STATIONS: usize = 6;
/// Pairs nearer than this in this share of the random states never get away from each other.
const ALWAYS: f64 = 0.8;
/// What is added to the clearance, so that pairs on the verge of it count as near, metres.
const MARGIN: f64 = 5e-4;
/// Links joined by at most this many joints are exempt anyway.
pub(super) const WITHIN_JOINTS: usize = 2;

/// Pairs of links nearer than `clearance` (metres) in nearly all states of the joints, or in all states
/// from a start to the fingers half closed.
pub(super) fn pairs(
    hand: &Resting<'_>,
    fingers: &[Finger],
    starts: &[Vec<f64>],
    clearance: f64,
) -> Vec<[String; 2]> {
    let random: Vec<_> = (0..SAMPLES)
        .map(|k| hand.poses_at(&sample(hand, k)))
        .collect();
    let on_the_way: Vec<Vec<_>> = starts
        .iter()
        .map(|start| {
            let at = |k: usize| 0.5 * k as f64 / (STATIONS - 1) as f64;
            let state = |k: usize| hand.poses_at(&close(hand, fingers, start, at(k)));
            (0..STATIONS).map(state).collect()
        })
        .collect();
    let near = |poses: &Vec<Isometry3<f64>>, a: usize, b: usize| {
        hand.shapes[a].is_near(&poses[a], &hand.shapes[b], &poses[b], clearance + MARGIN)
    };
    let mut found = Vec::new();
    for (a, b) in candidates(hand.model, hand.shapes) {
        let touching = random.iter().filter(|p| near(p, a, b)).count();
        let always = touching as f64 >= ALWAYS * SAMPLES as f64;
        let by_start = on_the_way
            .iter()
            .any(|states| states.iter().all(|p| near(p, a, b)));
        if always || by_start {
            let name = |l: usize| hand.model.links[l].name.clone();
            found.push([name(a), name(b)]);
        }
    }
    found
}

/// Pairs of links with geometry that are not neighbours.
fn candidates(model: &HandModel, shapes: &[LinkShape]) -> Vec<(usize, usize)> {
    let solid: Vec<usize> = (0..shapes.len())
        .filter(|&l| !shapes[l].is_empty())
        .collect();
    let mut pairs = Vec::new();
    for (k, &a) in solid.iter().enumerate() {
        let others = solid[k + 1..].iter();
        let far = others.filter(|&&b| model.joints_between(a, b) > WITHIN_JOINTS);
        pairs.extend(far.map(|&b| (a, b)));
    }
    pairs
}

/// Joint values spread evenly over their limits: the multiples of irrational steps.
fn sample(hand: &Resting<'_>, k: usize) -> Vec<f64> {
    let value = |d: usize| {
        let (lower, upper) = hand.limits(d);
        let step = ((d + 2) as f64).sqrt() * 0.618_033_988_749_895;
        lower + (upper - lower) * (step * (k + 1) as f64).fract()
    };
    (0..hand.rest.len()).map(value).collect()
}
