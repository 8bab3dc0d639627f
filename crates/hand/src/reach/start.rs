//! Starts of the search: hands whose tips have about the same mutual distances as the contacts.

use std::f64::consts::TAU;

use grasp::Contact;
use nalgebra::{DVector, Isometry3, Point3, UnitVector3, Vector3};
use rand::{Rng, RngExt};

use super::HandState;
use super::problem::{Problem, state};
use crate::alignment::{DEPTH, align, contact_points};
use shape::Support;

/// Number of half-closed hands among which a start is chosen.
const SHAPES: usize = 24;

/// A pose and joints near the contacts, and the finger assigned to each contact.
pub(super) struct Start {
    pub(super) x: DVector<f64>,
    pub(super) fingers: Vec<usize>,
}

/// Two points per finger in the palm frame: the middle of its pad and a point in front of it.
struct Fist {
    joints: Vec<f64>,
    points: Vec<[Point3<f64>; 2]>,
}

impl Problem<'_> {
    /// The best start among random half-closed hands and all assignments of fingers to contacts:
    /// the one whose pads a rigid motion brings nearest to the contacts, after that motion.
    pub(super) fn aligned_start<R: Rng + ?Sized>(
        &self,
        wanted: &[Contact],
        orders: &[Vec<usize>],
        rng: &mut R,
    ) -> Start {
        let targets: Vec<_> = wanted.iter().map(contact_points).collect();
        let mut best = (f64::INFINITY, self.fist(rng), &orders[0]);
        for _ in 1..SHAPES {
            let fist = self.fist(rng);
            let misfits = orders
                .iter()
                .map(|o| misfit_of_distances(&targets, &fist, o));
            let least = misfits.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((k, misfit)) = least
                && misfit < best.0
            {
                best = (misfit, fist, &orders[k]);
            }
        }
        let (_, fist, order) = best;
        let pairs: Vec<_> = order
            .iter()
            .zip(&targets)
            .flat_map(|(&finger, target)| fist.points[finger].into_iter().zip(*target))
            .collect();
        Start {
            x: state(&align(&pairs), &fist.joints),
            fingers: order.clone(),
        }
    }

    /// A half-closed hand that approaches the contacts along the normal of their plane or from a
    /// random direction.
    pub(super) fn approaching_start<R: Rng + ?Sized>(
        &self,
        wanted: &[Contact],
        support: Option<&Support>,
        rng: &mut R,
    ) -> Start {
        let hand = self.hand;
        let count = wanted.len() as f64;
        let centre = wanted
            .iter()
            .map(|c| c.position.coords)
            .sum::<Vector3<f64>>()
            / count;
        let mut draw = || rng.random_range(-1.0..1.0);
        let spread = Vector3::new(draw(), draw(), draw());
        let first = wanted[0].position.coords - centre;
        let across = wanted[1..]
            .iter()
            .map(|c| first.cross(&(c.position.coords - centre)))
            .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
            .and_then(|c| c.try_normalize(1e-9))
            .unwrap_or_else(Vector3::z);
        let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        let from = UnitVector3::try_new(across * side + spread * 0.8, 1e-6);
        let mut from = from.unwrap_or(Vector3::z_axis());
        if let Some(support) = support
            && support.normal.dot(&from) < 0.0
        {
            // From above.
            from = -from;
        }
        let roll = rng.random_range(0.0..TAU);
        let (low, high) = hand.standoff;
        let distance = rng.random_range(low - 0.2 * low.abs()..=high + 0.1 * high.abs());
        let mut pose = crate::pose_sampling::aimed(hand, &from, distance, roll);
        pose.translation.vector += centre;
        let preshape = &hand.preshapes[rng.random_range(0..hand.preshapes.len())];
        let mut joints = preshape.joints.clone();
        for finger in &hand.fingers {
            let closed = rng.random_range(0.2..1.0);
            for &(driven, ratio) in &finger.closing {
                joints[driven] += closed * ratio;
            }
        }
        hand.model.clamp_to_limits(&mut joints);
        let x = state(&pose, &joints);
        let fingers = self.assignment(&x, wanted);
        Start { x, fingers }
    }

    /// A hand in a random pre-shape or with random joints, each finger partly closed.
    fn fist<R: Rng + ?Sized>(&self, rng: &mut R) -> Fist {
        let hand = self.hand;
        let model = &hand.model;
        let preshape = &hand.preshapes[rng.random_range(0..hand.preshapes.len())];
        let mut joints = preshape.joints.clone();
        let closes = |driven: usize| {
            let mut all = hand.fingers.iter().flat_map(|f| &f.closing);
            all.any(|(d, _)| *d == driven)
        };
        for (driven, joint) in model.driven_joints().enumerate() {
            if !closes(driven) && rng.random_bool(0.5) {
                joints[driven] = rng.random_range(joint.limits.0..=joint.limits.1);
            }
        }
        for finger in &hand.fingers {
            let closed = rng.random_range(0.1..1.3);
            for &(driven, ratio) in &finger.closing {
                joints[driven] += (closed + rng.random_range(-0.4..0.4)) * ratio;
            }
        }
        model.clamp_to_limits(&mut joints);
        let mut poses = vec![Isometry3::identity(); model.links.len()];
        model.update_links(&joints, 1..model.links.len(), &mut poses);
        let points = (0..hand.fingers.len())
            .map(|finger| {
                let link = hand.fingers[finger].tip_links[0];
                let ahead = poses[link] * self.pads[finger];
                let pad = self.tip_centre(finger, &poses) + ahead * self.pad_depths[finger];
                [pad, pad + ahead * DEPTH]
            })
            .collect();
        Fist { joints, points }
    }

    /// A start from a given pose; each contact is assigned to the nearest finger.
    pub(super) fn known_start(&self, hand: &HandState, wanted: &[Contact]) -> Start {
        let mut joints = hand.joints.clone();
        joints.resize(self.hand.model.driven_count(), 0.0);
        self.hand.model.clamp_to_limits(&mut joints);
        let x = state(&hand.object_from_palm, &joints);
        let fingers = self.assignment(&x, wanted);
        Start { x, fingers }
    }
}

/// A misfit of the points of the fingers and of the contacts that no rigid motion changes: Σ over
/// pairs of points (difference of their distances)².
fn misfit_of_distances(targets: &[[Point3<f64>; 2]], fist: &Fist, order: &[usize]) -> f64 {
    let mut sum = 0.0;
    for (i, a) in targets.iter().enumerate() {
        for (j, b) in targets.iter().enumerate().skip(i + 1) {
            let (f, g) = (&fist.points[order[i]], &fist.points[order[j]]);
            for (k, l) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                sum += ((a[k] - b[l]).norm() - (f[k] - g[l]).norm()).powi(2);
            }
        }
    }
    sum
}

/// Assignments of fingers to contacts: all permutations for up to four contacts, otherwise the
/// cyclic ones.
pub(super) fn orders(count: usize) -> Vec<Vec<usize>> {
    if count > 4 {
        let turned = |by: usize| (0..count).map(|k| (k + by) % count).collect();
        return (0..count).map(turned).collect();
    }
    let mut all = vec![Vec::new()];
    for last in 0..count {
        all = all
            .iter()
            .flat_map(|order: &Vec<usize>| {
                (0..=order.len()).map(move |place| {
                    let mut longer = order.clone();
                    longer.insert(place, last);
                    longer
                })
            })
            .collect();
    }
    all
}
