//! The fingers of a hand: their tips, the joints that close them, and which way.

use nalgebra::{Isometry3, Point3, Vector3};

use super::bodies::{Bodies, Chain};
use crate::collision::LinkShape;
use crate::model::{Drive, HandModel, JointKind};

/// Axes within this cosine bend a finger in the same plane.
const PARALLEL: f64 = 0.8;
/// The part of a tip that counts as its end, metres.
const TIP_LENGTH: f64 = 0.012;
/// A joint whose axis passes the tip nearer than this does not bend the finger, metres.
const LEAST_LEVER: f64 = 3e-3;
/// A joint that goes this many times farther one way than the other curls the finger that way.
const ONE_SIDED: f64 = 2.5;
/// The step with which both ways are compared where the range does not tell, radians.
const TRIAL_BEND: f64 = 0.3;
/// The shares of the joints of a finger in the closing motion, from the palm outwards.
const SHARES: [f64; 4] = [1.0, 0.7, 0.5, 0.4];
/// Bars of a linkage lie in the plane of the finger within this, metres.
const SAME_PLANE: f64 = 0.012;

/// A finger of the proposal.
#[derive(Clone, Debug)]
pub(super) struct Finger {
    /// The links of its tip, that with the end first.
    pub(super) tips: Vec<usize>,
    /// Joints that move it alone, from the palm outwards.
    pub(super) path: Vec<usize>,
    /// Driven joints that close it with signed shares, from the palm outwards.
    pub(super) closing: Vec<(usize, f64)>,
    /// Whether its end curls: two joints or more bend it the same way.
    pub(super) curls: bool,
    /// The end of the tip in the frame of its first link.
    pub(super) end: Point3<f64>,
    /// Half of the thickness of the tip at its end, metres.
    pub(super) radius: f64,
}

/// A hand whose fingers are looked for, at rest.
pub(super) struct Resting<'a> {
    pub(super) model: &'a HandModel,
    pub(super) shapes: &'a [LinkShape],
    /// Driven values nearest to 0.
    pub(super) rest: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
}

impl<'a> Resting<'a> {
    pub(super) fn new(model: &'a HandModel, shapes: &'a [LinkShape]) -> Self {
        let mut rest = vec![0.0; model.driven_count()];
        model.clamp_to_limits(&mut rest);
        let mut resting = Resting {
            model,
            shapes,
            rest,
            poses: Vec::new(),
        };
        resting.poses = resting.poses_at(&resting.rest);
        resting
    }

    /// Poses of all links in the palm frame.
    pub(super) fn poses_at(&self, driven: &[f64]) -> Vec<Isometry3<f64>> {
        let mut poses = vec![Isometry3::identity(); self.model.links.len()];
        self.model
            .update_links(driven, 0..self.model.links.len(), &mut poses);
        poses
    }

    /// Where the end of a finger is.
    pub(super) fn end_at(&self, finger: &Finger, driven: &[f64]) -> Point3<f64> {
        self.poses_at(driven)[finger.tips[0]] * finger.end
    }

    pub(super) fn limits(&self, driven: usize) -> (f64, f64) {
        self.model.joints[self.model.driven[driven]].limits
    }

    /// Origin and axis of a joint, at rest, palm frame.
    fn axis(&self, joint: usize) -> (Point3<f64>, Vector3<f64>) {
        let joint = &self.model.joints[joint];
        let pose = self.poses[joint.parent] * joint.parent_from_joint;
        (
            Point3::from(pose.translation.vector),
            pose * joint.axis.into_inner(),
        )
    }

    fn vertices(&self, link: usize) -> Vec<Point3<f64>> {
        self.shapes[link].mesh(&self.poses[link]).vertices
    }

    /// How far links reach from the origin of a joint.
    pub(super) fn length(&self, joint: usize, links: &[usize]) -> f64 {
        let from = self.axis(joint).0;
        let points = links.iter().flat_map(|&l| self.vertices(l));
        points.map(|p| (p - from).norm()).fold(0.0, f64::max)
    }

    /// The driven value behind a joint and how fast the joint follows it.
    fn rate(&self, joint: usize) -> Option<(usize, f64)> {
        match self.model.joints[joint].drive {
            Drive::Fixed => None,
            Drive::Driven(driven) => Some((driven, 1.0)),
            Drive::Mimic {
                driven, multiplier, ..
            } => Some((driven, multiplier)),
        }
    }

    /// The fingers of a hand; bars of linkages beside them are left out.
    pub(super) fn fingers(&self, bodies: &Bodies) -> Vec<Finger> {
        let chains = bodies.chains(&|joint, links| self.length(joint, links));
        let found = chains
            .iter()
            .filter_map(|chain| self.finger(bodies, chain))
            .collect();
        let mut fingers = self.without_bars(found);
        self.share_alike(&mut fingers);
        for k in 0..fingers.len() {
            let sign = self.sign(&fingers, k);
            for (_, share) in &mut fingers[k].closing {
                *share *= sign;
            }
        }
        self.agree(&mut fingers);
        for finger in &mut fingers {
            let closing = finger.closing.clone();
            finger.tips.retain(|&tip| self.is_moved(tip, &closing));
        }
        fingers.retain(|f| !f.tips.is_empty());
        fingers
    }

    /// Whether a closing joint moves a link.
    fn is_moved(&self, link: usize, closing: &[(usize, f64)]) -> bool {
        let closes = |&joint: &usize| {
            let rate = self.rate(joint).filter(|(_, rate)| *rate != 0.0);
            rate.is_some_and(|(driven, _)| closing.iter().any(|c| c.0 == driven))
        };
        self.model.path_to_root(link).iter().any(closes)
    }

    /// A finger whose closing joints all have the sense of its last joint.
    fn finger(&self, bodies: &Bodies, chain: &Chain) -> Option<Finger> {
        let last = *chain.path.last()?;
        let mut tips = Vec::new();
        for &body in &chain.ends {
            tips.extend(bodies.solid_links(body, self.shapes));
        }
        let (first, end, radius) = self.tip_end(last, &tips)?;
        tips.sort_by_key(|&l| l != first);
        let mut finger = Finger {
            tips,
            path: chain.path.clone(),
            closing: Vec::new(),
            curls: false,
            end,
            radius,
        };
        let (closing, curl) = self.closing(&finger)?;
        finger.curls = curl;
        let shares = SHARES.iter().chain(std::iter::repeat(&SHARES[3]));
        finger.closing = closing
            .into_iter()
            .zip(shares)
            .map(|((driven, sense), share)| (driven, sense * share))
            .collect();
        Some(finger)
    }

    /// The link with the end of a tip, the end in its frame, and half of the thickness there.
    fn tip_end(&self, last: usize, tips: &[usize]) -> Option<(usize, Point3<f64>, f64)> {
        let from = self.axis(last).0;
        let points: Vec<(usize, Point3<f64>)> = tips
            .iter()
            .flat_map(|&l| self.vertices(l).into_iter().map(move |p| (l, p)))
            .collect();
        let mean = points.iter().map(|(_, p)| p - from).sum::<Vector3<f64>>();
        let along = mean.try_normalize(1e-9)?;
        let reach = |p: &Point3<f64>| (p - from).dot(&along);
        let (first, farthest) = points
            .iter()
            .max_by(|a, b| reach(&a.1).total_cmp(&reach(&b.1)))?;
        let least = reach(farthest) - TIP_LENGTH;
        let end: Vec<&Point3<f64>> = points
            .iter()
            .map(|(_, p)| p)
            .filter(|p| reach(p) >= least)
            .collect();
        let mut low = Vector3::repeat(f64::INFINITY);
        let mut high = Vector3::repeat(f64::NEG_INFINITY);
        for p in end {
            low = low.inf(&p.coords);
            high = high.sup(&p.coords);
        }
        let sides = high - low;
        let middle = Point3::from((low + high) / 2.0);
        let thickness = sides.min().clamp(0.004, 0.03);
        let local = self.poses[*first].inverse_transform_point(&middle);
        Some((*first, local, thickness / 2.0))
    }

    /// Driven joints that bend a finger in the plane of its last joint, with the sense in which each
    /// turns that way, and whether together they curl its end.
    fn closing(&self, finger: &Finger) -> Option<(Vec<(usize, f64)>, bool)> {
        let end = self.poses[finger.tips[0]] * finger.end;
        let bends = |joint: &&usize| {
            let (origin, axis) = self.axis(**joint);
            let slides = self.model.joints[**joint].kind == JointKind::Prismatic;
            slides || axis.cross(&(end - origin)).norm() > LEAST_LEVER
        };
        let last = *finger.path.iter().rev().find(bends)?;
        let (driven, rate) = self.rate(last)?;
        if self.model.joints[last].kind == JointKind::Prismatic {
            return Some((vec![(driven, rate.signum())], false));
        }
        let reference = self.axis(last).1;
        let mut closing: Vec<(usize, f64)> = Vec::new();
        let mut turns: Vec<(usize, f64)> = Vec::new();
        for &joint in &finger.path {
            let cosine = self.axis(joint).1.dot(&reference);
            let revolute = self.model.joints[joint].kind == JointKind::Revolute;
            let Some((driven, rate)) = self.rate(joint).filter(|_| revolute) else {
                continue;
            };
            if cosine.abs() < PARALLEL {
                continue;
            }
            let sense = (rate * cosine).signum();
            if !closing.iter().any(|c| c.0 == driven) {
                closing.push((driven, sense));
            }
            turns.push((driven, sense));
        }
        let net = |&(driven, _): &(usize, f64)| {
            let of_driven = turns.iter().filter(|t| t.0 == driven);
            of_driven.map(|t| t.1).sum::<f64>().abs()
        };
        let curl = closing.iter().map(net).sum::<f64>() >= 2.0;
        Some((closing, curl))
    }

    /// Leaves out parts that one motor moves beside a longer finger in the same plane.
    fn without_bars(&self, found: Vec<Finger>) -> Vec<Finger> {
        let end = |f: &Finger| self.poses[f.tips[0]] * f.end;
        let way = |f: &Finger| self.velocity(f).try_normalize(1e-9).unwrap_or_default();
        let is_bar = |k: usize| {
            let bar = &found[k];
            let (at, moving) = (end(bar), way(bar));
            found.iter().enumerate().any(|(other, finger)| {
                let same = finger.closing.iter().any(|c| c.0 == bar.closing[0].0);
                let along = moving.dot(&way(finger)) > 0.5;
                let length = |f: &Finger| (end(f) - Point3::origin()).norm();
                let longer = (length(finger), k) > (length(bar), other);
                let normal = self.plane_normal(finger);
                let beside = (end(finger) - at).dot(&normal).abs() < SAME_PLANE;
                other != k && same && along && longer && beside
            })
        };
        let kept: Vec<usize> = (0..found.len()).filter(|&k| !is_bar(k)).collect();
        kept.into_iter().map(|k| found[k].clone()).collect()
    }

    /// How the end of a finger moves when its closing joints do, at rest, with the present signs.
    pub(super) fn velocity(&self, finger: &Finger) -> Vector3<f64> {
        let step = 1e-3;
        let moved = |sign: f64| {
            let mut driven = self.rest.clone();
            for &(d, share) in &finger.closing {
                driven[d] += sign * step * share;
            }
            self.end_at(finger, &driven)
        };
        (moved(1.0) - moved(-1.0)) / (2.0 * step)
    }

    /// Normal of the plane in which a finger moves.
    fn plane_normal(&self, finger: &Finger) -> Vector3<f64> {
        let turning = finger
            .path
            .iter()
            .rev()
            .find(|&&j| self.model.joints[j].kind == JointKind::Revolute);
        match turning {
            Some(&joint) => self.axis(joint).1,
            None => {
                let base = self.axis(finger.path[0]).0;
                let out = self.poses[finger.tips[0]] * finger.end - base;
                let normal = self.velocity(finger).cross(&out);
                normal.try_normalize(1e-12).unwrap_or_default()
            }
        }
    }

    /// Fingers that share a motor close by the joints that they share.
    fn share_alike(&self, fingers: &mut [Finger]) {
        for k in 1..fingers.len() {
            for other in 0..k {
                let (before, after) = fingers.split_at_mut(k);
                let (a, b) = (&mut before[other], &mut after[0]);
                let in_a: Vec<usize> = a.closing.iter().map(|c| c.0).collect();
                let in_b: Vec<usize> = b.closing.iter().map(|c| c.0).collect();
                if in_a.iter().any(|d| in_b.contains(d)) {
                    a.closing.retain(|c| in_b.contains(&c.0));
                    b.closing.retain(|c| in_a.contains(&c.0));
                }
            }
        }
    }

    /// Fingers that share motors have the same shares, those of the first of them.
    fn agree(&self, fingers: &mut [Finger]) {
        for k in 1..fingers.len() {
            let own = &fingers[k].closing;
            let shares = |f: &&Finger| f.closing.iter().any(|c| own.iter().any(|o| o.0 == c.0));
            if let Some(closing) = fingers[..k].iter().find(shares).map(|f| f.closing.clone()) {
                fingers[k].closing = closing;
            }
        }
    }

    /// Which way a finger closes: 1 for the sense of its last joint, -1 for the other.
    fn sign(&self, fingers: &[Finger], which: usize) -> f64 {
        let finger = &fingers[which];
        let range = |sign: f64| {
            let far = |&(driven, share): &(usize, f64)| {
                let (lower, upper) = self.limits(driven);
                let end = if sign * share > 0.0 { upper } else { lower };
                (end - self.rest[driven]).abs()
            };
            finger.closing.iter().map(far).sum::<f64>()
        };
        if finger.curls {
            let (up, down) = (range(1.0), range(-1.0));
            if up > ONE_SIDED * down {
                return 1.0;
            }
            if down > ONE_SIDED * up {
                return -1.0;
            }
            let bent = |sign: f64| {
                let mut driven = self.rest.clone();
                for &(d, share) in &finger.closing {
                    driven[d] += sign * TRIAL_BEND * share;
                }
                driven
            };
            return self.nearer(fingers, which, &bent(1.0), &bent(-1.0));
        }
        let end_of = |sign: f64| {
            let mut driven = self.middle();
            for &(d, share) in &finger.closing {
                let (lower, upper) = self.limits(d);
                driven[d] = if sign * share > 0.0 { upper } else { lower };
            }
            driven
        };
        self.nearer(fingers, which, &end_of(1.0), &end_of(-1.0))
    }

    /// Driven values in the middle of their limits.
    fn middle(&self) -> Vec<f64> {
        let half = |d: usize| 0.5 * (self.limits(d).0 + self.limits(d).1);
        (0..self.rest.len()).map(half).collect()
    }

    /// 1 where the first state brings a finger nearer to the other ends than the second, else -1.
    fn nearer(&self, fingers: &[Finger], which: usize, first: &[f64], second: &[f64]) -> f64 {
        let apart = |driven: &[f64]| {
            let poses = self.poses_at(driven);
            let end = |f: &Finger| poses[f.tips[0]] * f.end;
            let others = fingers.iter().enumerate().filter(|(k, _)| *k != which);
            let sum: Vector3<f64> = others.map(|(_, f)| end(f).coords).sum();
            let middle = sum / (fingers.len() - 1).max(1) as f64;
            (end(&fingers[which]).coords - middle).norm()
        };
        if apart(first) <= apart(second) {
            1.0
        } else {
            -1.0
        }
    }
}

impl Resting<'_> {
    /// Takes from fingers the closing joints that move others which they do not close.
    pub(super) fn separate(&self, fingers: &mut [Finger]) {
        let moves = |driven: usize, finger: &Finger| {
            let rate = |&j: &usize| self.rate(j).is_some_and(|(d, _)| d == driven);
            finger.path.iter().any(rate)
        };
        let all = fingers.to_vec();
        for (k, finger) in fingers.iter_mut().enumerate() {
            let foreign = |driven: usize| {
                let others = all.iter().enumerate().filter(|(other, _)| *other != k);
                let mut strange = others.filter(|(_, f)| !f.closing.iter().any(|c| c.0 == driven));
                strange.any(|(_, f)| moves(driven, f))
            };
            let own: Vec<(usize, f64)> = finger
                .closing
                .iter()
                .copied()
                .filter(|c| !foreign(c.0))
                .collect();
            if !own.is_empty() {
                finger.closing = own;
            }
        }
    }
}
