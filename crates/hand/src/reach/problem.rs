//! The least-squares problem of bringing tips to contacts, and the closing that follows it.

use grasp::Contact;
use nalgebra::{DVector, Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::{ReachParams, Reached};
use crate::closing::close_hand;
use crate::collision::{CollisionObject, Precision};
use crate::contact::tip_contact;
use crate::hand::{Finger, Hand};
use crate::least_squares::{Stopping, minimise};

/// Weight of orientation errors against position errors, metres per radian. The first pass finds
/// the right side of the tip; the second has a small weight, so that the orientation does not
/// displace the tip from the contact.
const FACING_WEIGHTS: (f64, f64) = (4e-3, 2e-4);
/// Largest radius of the balls that approximate the object at its contacts, metres.
const MAX_DEPTH: f64 = 0.02;
/// Weight of a missing clearance.
const CLEARANCE_WEIGHT: f64 = 0.5;
/// Margin added to every clearance, metres.
const CLEARANCE_MARGIN: f64 = 1.5e-3;
/// A start is abandoned if its tips are farther than this from their contacts after the first
/// search (root sum of squares, metres).
const HOPELESS: f64 = 0.03;

/// A hand and an object, prepared for searches at any contacts.
#[derive(Debug, Clone)]
pub(super) struct Problem<'a> {
    pub(super) object: &'a CollisionObject<'a>,
    pub(super) hand: &'a Hand,
    /// The direction that each finger's tip faces, in the frame of its first tip link.
    pub(super) pads: Vec<Vector3<f64>>,
    /// Links with geometry that are not tips.
    others: Vec<usize>,
    /// Distance from the middle of each tip link to its surface in that direction, metres.
    pub(super) pad_depths: Vec<f64>,
    /// Radius of the balls inside the object that tips are to touch, metres.
    depth: f64,
}

/// Contacts with the finger assigned to each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task<'a> {
    pub(super) wanted: &'a [Contact],
    pub(super) fingers: &'a [usize],
    pub(super) params: &'a ReachParams,
}

/// Pose and joints as one vector: translation, rotation vector of the palm, driven joints.
pub(super) fn state(object_from_palm: &Isometry3<f64>, joints: &[f64]) -> DVector<f64> {
    let turn = object_from_palm.rotation.scaled_axis();
    let head = object_from_palm
        .translation
        .vector
        .iter()
        .chain(turn.iter());
    DVector::from_iterator(6 + joints.len(), head.chain(joints.iter()).copied())
}

/// The pose of the palm in such a vector.
fn pose(x: &DVector<f64>) -> Isometry3<f64> {
    let turn = Vector3::new(x[3], x[4], x[5]);
    Isometry3::from_parts(
        Translation3::new(x[0], x[1], x[2]),
        UnitQuaternion::from_scaled_axis(turn),
    )
}

/// The direction in which closing moves a tip, in the frame of its first link.
fn pad_direction(hand: &Hand, finger: &Finger) -> Vector3<f64> {
    let model = &hand.model;
    let link = finger.tip_links[0];
    let start = &hand.preshapes[0].joints;
    let mut closed = start.clone();
    for &(driven, ratio) in &finger.closing {
        closed[driven] += 1e-4 * ratio;
    }
    let mut before = vec![Isometry3::identity(); model.links.len()];
    let mut after = before.clone();
    model.update_links(start, 1..model.links.len(), &mut before);
    model.update_links(&closed, 1..model.links.len(), &mut after);
    let centre = hand.shapes[link].centre;
    let moved = after[link] * centre - before[link] * centre;
    before[link].inverse_transform_vector(&moved.try_normalize(0.0).unwrap_or_default())
}

/// Distance from the middle of a tip to its surface in the direction that its pad faces.
fn pad_depth(hand: &Hand, finger: &Finger, pad: &Vector3<f64>) -> f64 {
    let shape = &hand.shapes[finger.tip_links[0]];
    let far = 10.0 * shape.radius;
    let ahead = shape.centre + pad * far;
    far - shape.offset_to(&Isometry3::identity(), &ahead).dot(pad)
}

impl<'a> Problem<'a> {
    pub(super) fn new(object: &'a CollisionObject<'a>, hand: &'a Hand) -> Self {
        let pads: Vec<_> = hand
            .fingers
            .iter()
            .map(|f| pad_direction(hand, f))
            .collect();
        let is_tip = |l: &usize| hand.fingers.iter().any(|f| f.tip_links.contains(l));
        Problem {
            object,
            hand,
            others: (0..hand.shapes.len())
                .filter(|l| !is_tip(l) && !hand.shapes[*l].is_empty())
                .collect(),
            pad_depths: hand
                .fingers
                .iter()
                .zip(&pads)
                .map(|(f, pad)| pad_depth(hand, f, pad))
                .collect(),
            pads,
            depth: (0.7 * object.inner_radius()).min(MAX_DEPTH),
        }
    }

    fn links(&self, x: &DVector<f64>) -> Vec<Isometry3<f64>> {
        let model = &self.hand.model;
        let mut poses = vec![pose(x); model.links.len()];
        model.update_links(&x.as_slice()[6..], 1..model.links.len(), &mut poses);
        poses
    }

    /// The assignment of fingers to contacts with the least sum of squared distances at x.
    pub(super) fn assignment(&self, x: &DVector<f64>, wanted: &[Contact]) -> Vec<usize> {
        let poses = self.links(x);
        let cost = |contact: usize, finger: usize| {
            let link = self.hand.fingers[finger].tip_links[0];
            let tip = poses[link] * self.hand.shapes[link].centre;
            (tip - wanted[contact].position).norm_squared()
        };
        let mut order: Vec<usize> = (0..wanted.len()).collect();
        // Exchanges of two until none improves: exact for three contacts, a good approximation for
        // more.
        loop {
            let mut gained = false;
            for a in 0..order.len() {
                for b in 0..a {
                    let now = cost(a, order[a]) + cost(b, order[b]);
                    if cost(a, order[b]) + cost(b, order[a]) < now - 1e-15 {
                        order.swap(a, b);
                        gained = true;
                    }
                }
            }
            if !gained {
                return order;
            }
        }
    }

    /// Least squares without clearances, then with them; returns the misfit of the tips in metres.
    pub(super) fn solve(&self, x: &mut DVector<f64>, task: &Task<'_>) -> f64 {
        self.minimise(x, |x, _| {
            DVector::from_vec(self.tips(&self.links(x), task, FACING_WEIGHTS.0))
        });
        let misfit = self.misfit(x, task);
        if misfit > HOPELESS {
            return misfit;
        }
        self.settle(x, task)
    }

    /// Least squares with clearances from a state near the contacts; the misfit of the tips.
    pub(super) fn settle(&self, x: &mut DVector<f64>, task: &Task<'_>) -> f64 {
        self.minimise(x, |x, near| {
            let poses = self.links(x);
            let mut all = self.tips(&poses, task, FACING_WEIGHTS.1);
            self.push_clearances(&poses, task, near, &mut all);
            self.push_heights(&poses, task, &mut all);
            DVector::from_vec(all)
        });
        self.misfit(x, task)
    }

    fn minimise(
        &self,
        x: &mut DVector<f64>,
        residuals: impl Fn(&DVector<f64>, Option<&DVector<f64>>) -> DVector<f64>,
    ) {
        let stopping = Stopping {
            iterations: 25,
            cost: 1e-10,
            decrease: 1e-3,
        };
        let model = &self.hand.model;
        let project = |x: &mut DVector<f64>| model.clamp_to_limits(&mut x.as_mut_slice()[6..]);
        minimise(x, stopping, residuals, project);
    }

    fn misfit(&self, x: &DVector<f64>, task: &Task<'_>) -> f64 {
        let all = self.tips(&self.links(x), task, 0.0);
        let positions = all.chunks_exact(6).flat_map(|c| &c[..3]);
        positions.map(|v| v * v).sum::<f64>().sqrt()
    }

    /// Six residuals per contact. Three are the distance of the tip from touching, at the contact,
    /// a ball inside the object; the centre of the ball is `depth` below the contact, so that a
    /// tilt of the tip counts like a displacement. Three are the rotation of the pad away from the
    /// inward normal.
    fn tips(&self, poses: &[Isometry3<f64>], task: &Task<'_>, facing_weight: f64) -> Vec<f64> {
        let mut all = vec![0.0; 6 * task.wanted.len()];
        for (k, (contact, &finger)) in task.wanted.iter().zip(task.fingers).enumerate() {
            let links = &self.hand.fingers[finger].tip_links;
            let normal = contact.inward_normal.into_inner();
            let centre = contact.position + normal * self.depth;
            let reach = normal * (self.depth + 0.5 * task.params.rules.tip_gap);
            let offset = links
                .iter()
                .map(|&l| self.hand.shapes[l].offset_to(&poses[l], &centre))
                .min_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
                .map_or(-reach, |offset| offset - reach);
            let facing = poses[links[0]] * self.pads[finger] - normal;
            for axis in 0..3 {
                all[6 * k + axis] = offset[axis];
                all[6 * k + 3 + axis] = facing_weight * facing[axis];
            }
        }
        all
    }

    /// The missing clearance of each link that is not a tip.
    fn push_clearances(
        &self,
        poses: &[Isometry3<f64>],
        task: &Task<'_>,
        near: Option<&DVector<f64>>,
        all: &mut Vec<f64>,
    ) {
        let least = task.params.rules.object_clearance + CLEARANCE_MARGIN;
        let precision = Precision {
            cutoff: least,
            absolute: 1e-5,
            relative: 0.0,
        };
        for &l in &self.others {
            let idle = near.is_some_and(|n| n[all.len()] == 0.0);
            all.push(if idle {
                0.0
            } else {
                let shape = &self.hand.shapes[l];
                let gap = self.object.link_gap(shape, &poses[l], precision);
                CLEARANCE_WEIGHT * (least - gap.lower).max(0.0)
            });
        }
    }

    /// The missing height above the support of each link.
    fn push_heights(&self, poses: &[Isometry3<f64>], task: &Task<'_>, all: &mut Vec<f64>) {
        let rules = &task.params.rules;
        let Some(support) = &rules.support else {
            return;
        };
        let least = rules.support_clearance + CLEARANCE_MARGIN;
        for (link, pose) in poses.iter().enumerate() {
            let height = self.hand.link_height(link, support, pose);
            all.extend(height.map(|h| CLEARANCE_WEIGHT * (least - h).max(0.0)));
        }
    }

    /// Opens the fingers, closes them by the closing rules and measures their contacts.
    pub(super) fn close(
        &self,
        x: &DVector<f64>,
        task: &Task<'_>,
        starts: usize,
    ) -> Option<Reached> {
        let hand = self.hand;
        let rules = &task.params.rules;
        let object_from_palm = pose(x);
        let open = hand.opened(&x.as_slice()[6..], task.params.opening);
        let closed = close_hand(self.object, hand, &object_from_palm, &open, rules).ok()?;
        let mut reached = Reached {
            object_from_palm: closed.object_from_links[0],
            joints: closed.joints,
            finger_of_contact: task.fingers.to_vec(),
            contacts: Vec::with_capacity(task.fingers.len()),
            directions: Vec::with_capacity(task.fingers.len()),
            position_error: 0.0,
            normal_error: 0.0,
            starts,
        };
        for &finger in task.fingers {
            let tip = &hand.fingers[finger];
            let touch = tip_contact(self.object, hand, tip, &closed.object_from_links)
                .filter(|t| t.gap < rules.tip_gap)
                .filter(|t| !self.object.is_closed_hole(&t.position))?;
            reached.directions.push(touch.direction);
            reached.contacts.push(Contact {
                position: touch.position,
                inward_normal: touch.inward_normal,
            });
        }
        reached.measure_errors(task.wanted);
        Some(reached)
    }

    /// Centre of a finger's first tip link in the frame of the poses.
    pub(super) fn tip_centre(&self, finger: usize, poses: &[Isometry3<f64>]) -> Point3<f64> {
        let link = self.hand.fingers[finger].tip_links[0];
        poses[link] * self.hand.shapes[link].centre
    }
}
