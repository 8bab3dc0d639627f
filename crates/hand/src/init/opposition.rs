//! From where fingers close so that they oppose each other about a ball in front of the palm.

use nalgebra::{Point3, Vector3};

use super::fingers::{Finger, Resting};

/// Stations of the closing motion.
const STATIONS: usize = 16;
/// Radii of balls that are looked at, metres.
const RADII: (f64, f64) = (0.012, 0.06);
/// A radius that most hands can hold, metres.
const USUAL_RADIUS: f64 = 0.035;
/// What is left between the ball and the palm, metres.
const PALM_GAP: f64 = 5e-3;
/// Values of a free joint that are compared, over its range.
const VALUES: usize = 5;
/// Free joints are turned one after another this many times.
const SWEEPS: usize = 2;
/// Free joints stay within a quarter turn of 0, radians.
const WIDEST_TURN: f64 = 1.6;
/// What turning a free joint over its whole range costs, in units of the score.
const COST_OF_TURNING: f64 = 0.05;
/// How far the first joint of a finger opens, radians.
const WIDEST_OPENING: f64 = 1.05;

/// Joint values from which fingers close, and the ball that they hold best.
#[derive(Clone, Debug)]
pub(super) struct Start {
    pub(super) name: String,
    pub(super) joints: Vec<f64>,
    /// Middle of the ball in the palm frame.
    pub(super) centre: Point3<f64>,
    pub(super) score: f64,
}

/// How fingers stand before they close.
#[derive(Clone, Copy, Debug)]
enum Stance {
    /// All closing joints at rest.
    Straight,
    /// As far open as joints allow, up to 60°.
    Open,
    /// The first joint open and the others bent back.
    Hooked,
    /// All joints bent by a part of their range.
    Bent,
}

const STANCES: [(Stance, &str); 4] = [
    (Stance::Straight, "straight"),
    (Stance::Open, "open"),
    (Stance::Hooked, "hooked"),
    (Stance::Bent, "bent"),
];

/// Ways to start, the most promising first; those that no ball suits are left out.
pub(super) fn starts(hand: &Resting<'_>, fingers: &[Finger]) -> Vec<Start> {
    let mut found: Vec<Start> = Vec::new();
    for (stance, name) in STANCES {
        let Some(joints) = stand(hand, fingers, stance) else {
            continue;
        };
        let turned = turn_free_joints(hand, fingers, &joints);
        let moved = turned != joints;
        let both = [(joints, ""), (turned, "_opposed")];
        for (joints, turned) in both.into_iter().take(1 + usize::from(moved)) {
            let (score, centre) = score(hand, fingers, &joints);
            if score > 0.0 && !found.iter().any(|f| f.joints == joints) {
                found.push(Start {
                    name: format!("{name}{turned}"),
                    joints,
                    centre,
                    score,
                });
            }
        }
    }
    found.sort_by(|a, b| b.score.total_cmp(&a.score));
    found
}

/// The joint values of a stance; none where it is that of another.
fn stand(hand: &Resting<'_>, fingers: &[Finger], stance: Stance) -> Option<Vec<f64>> {
    let mut joints = hand.rest.clone();
    let mut differs = false;
    for finger in fingers {
        for (k, &(driven, share)) in finger.closing.iter().enumerate() {
            let (lower, upper) = hand.limits(driven);
            let (open, closed) = if share > 0.0 {
                (lower, upper)
            } else {
                (upper, lower)
            };
            let rest = hand.rest[driven];
            if !finger.curls {
                joints[driven] = open;
                continue;
            }
            let towards = |end: f64, most: f64| (end - rest).clamp(-most, most);
            let value = rest
                + match stance {
                    Stance::Straight => 0.0,
                    Stance::Open => towards(open, WIDEST_OPENING),
                    Stance::Hooked if k == 0 => towards(open, WIDEST_OPENING),
                    Stance::Hooked => towards(closed, WIDEST_OPENING),
                    Stance::Bent => 0.25 * (closed - rest),
                };
            differs |= (value - rest).abs() > 0.1;
            joints[driven] = value;
        }
    }
    // Jaws have one stance.
    (differs || matches!(stance, Stance::Straight)).then_some(joints)
}

/// Driven joints that close no finger, turned one after another to the best of a few values.
fn turn_free_joints(hand: &Resting<'_>, fingers: &[Finger], joints: &[f64]) -> Vec<f64> {
    let closes = |d: usize| fingers.iter().any(|f| f.closing.iter().any(|c| c.0 == d));
    let free: Vec<usize> = (0..joints.len()).filter(|&d| !closes(d)).collect();
    let cost = |q: &[f64]| {
        let share = |&d: &usize| {
            let (lower, upper) = hand.limits(d);
            (q[d] - hand.rest[d]).abs() / (upper - lower).max(1e-9)
        };
        COST_OF_TURNING * free.iter().map(share).sum::<f64>()
    };
    let value = |q: &[f64]| score(hand, fingers, q).0 - cost(q);
    let mut best = (value(joints), joints.to_vec());
    for _ in 0..SWEEPS {
        for &driven in &free {
            let (lower, upper) = hand.limits(driven);
            let (lower, upper) = (lower.max(-WIDEST_TURN), upper.min(WIDEST_TURN));
            for k in 0..VALUES {
                let mut turned = best.1.clone();
                turned[driven] = lower + (upper - lower) * k as f64 / (VALUES - 1) as f64;
                let found = value(&turned);
                if found > best.0 + 1e-9 {
                    best = (found, turned);
                }
            }
        }
    }
    best.1
}

/// How well the fingers close about balls in front of the palm, and the middle of the best ball.
fn score(hand: &Resting<'_>, fingers: &[Finger], joints: &[f64]) -> (f64, Point3<f64>) {
    let ways = ways(hand, fingers, joints);
    let poses = hand.poses_at(joints);
    let fixed = fixed_links(hand, fingers);
    let mut sum = 0.0;
    let mut best = (0.0, Point3::origin());
    for station in 0..STATIONS {
        let ends: Vec<Point3<f64>> = ways.iter().map(|way| way[station]).collect();
        let (centre, reach) = enclosing_ball(&ends);
        let thickness = fingers.iter().map(|f| f.radius).sum::<f64>() / fingers.len() as f64;
        let radius = reach - thickness;
        if !(RADII.0..=RADII.1).contains(&radius) {
            continue;
        }
        let palm = fixed
            .iter()
            .map(|&l| hand.shapes[l].offset_to(&poses[l], &centre).norm())
            .fold(f64::INFINITY, f64::min);
        if palm < radius + PALM_GAP {
            continue;
        }
        let held = hold(&ways, &centre, reach);
        sum += held / STATIONS as f64;
        let weight = held * (1.0 - ((radius - USUAL_RADIUS) / USUAL_RADIUS).abs()).max(0.1);
        if weight > best.0 {
            best = (weight, centre);
        }
    }
    (sum, best.1)
}

/// Links that no finger moves.
pub(super) fn fixed_links(hand: &Resting<'_>, fingers: &[Finger]) -> Vec<usize> {
    let moved = |link: usize| {
        let path = hand.model.path_to_root(link);
        fingers
            .iter()
            .any(|f| f.path.iter().any(|j| path.contains(j)))
    };
    (0..hand.shapes.len())
        .filter(|&l| !hand.shapes[l].is_empty() && !moved(l))
        .collect()
}

/// Where the end of each finger is while it closes.
fn ways(hand: &Resting<'_>, fingers: &[Finger], joints: &[f64]) -> Vec<Vec<Point3<f64>>> {
    let mut ways = vec![Vec::with_capacity(STATIONS); fingers.len()];
    for station in 0..STATIONS {
        let closed = close(
            hand,
            fingers,
            joints,
            station as f64 / (STATIONS - 1) as f64,
        );
        let poses = hand.poses_at(&closed);
        for (way, finger) in ways.iter_mut().zip(fingers) {
            way.push(poses[finger.tips[0]] * finger.end);
        }
    }
    ways
}

/// Every finger closed by a share of its range.
pub(super) fn close(
    hand: &Resting<'_>,
    fingers: &[Finger],
    joints: &[f64],
    share: f64,
) -> Vec<f64> {
    let mut closed = joints.to_vec();
    for finger in fingers {
        let left = |&(driven, ratio): &(usize, f64)| {
            let (lower, upper) = hand.limits(driven);
            let end = if ratio > 0.0 { upper } else { lower };
            ((end - joints[driven]) / ratio).max(0.0)
        };
        let range = finger.closing.iter().map(left).fold(0.0, f64::max);
        for &(driven, ratio) in &finger.closing {
            closed[driven] = joints[driven] + share * range * ratio;
        }
    }
    hand.model.clamp_to_limits(&mut closed);
    closed
}

/// 0 where the ends do not close about a ball, up to 1 where they press it evenly from all sides.
fn hold(ways: &[Vec<Point3<f64>>], centre: &Point3<f64>, reach: f64) -> f64 {
    let mut normals = Vec::new();
    let mut inward = 0.0;
    for way in ways {
        let arrives = (1..way.len()).find(|&k| (way[k] - centre).norm() <= 1.02 * reach);
        let Some(at) = arrives.filter(|_| (way[0] - centre).norm() > reach) else {
            // Fingers that do not arrive hold nothing.
            continue;
        };
        let Some(normal) = (centre - way[at]).try_normalize(1e-9) else {
            continue;
        };
        let moving = (way[at] - way[at - 1]).try_normalize(1e-12);
        inward += moving.map_or(0.0, |m| m.dot(&normal).max(0.0));
        normals.push(normal);
    }
    if normals.len() < 2 {
        return 0.0;
    }
    let share = normals.len() as f64 / ways.len() as f64;
    let inward = (2.0 * inward / normals.len() as f64).min(1.0);
    let unbalanced = least_sum(&normals).norm();
    share * share * inward * (1.0 - unbalanced).max(0.0)
}

/// The point of the convex hull of unit vectors that is nearest to the origin, roughly.
fn least_sum(normals: &[Vector3<f64>]) -> Vector3<f64> {
    let mut at = normals[0];
    for _ in 0..60 {
        let towards = normals
            .iter()
            .min_by(|a, b| a.dot(&at).total_cmp(&b.dot(&at)));
        let Some(towards) = towards else {
            break;
        };
        let way = towards - at;
        let length = way.norm_squared();
        if length < 1e-12 {
            break;
        }
        at += way * (-at.dot(&way) / length).clamp(0.0, 1.0);
    }
    at
}

/// Middle and radius of a ball that holds all points and is nearly the least.
fn enclosing_ball(points: &[Point3<f64>]) -> (Point3<f64>, f64) {
    let mut centre = points[0];
    let farthest = |centre: &Point3<f64>| {
        let far = |p: &Point3<f64>| (p - centre).norm_squared();
        let found = points.iter().max_by(|a, b| far(a).total_cmp(&far(b)));
        *found.unwrap_or(&points[0])
    };
    for step in 1..=80 {
        centre += (farthest(&centre) - centre) / (step + 1) as f64;
    }
    (centre, (farthest(&centre) - centre).norm())
}
