//! From contacts to a hand: a pose and joint values that bring the tips to given contacts.
//!
//! Every start is a random pose about the contacts and an assignment of fingers to them.
//! Damped least squares over pose and joints brings the tips to the contacts, facing
//! along the inward normals, with the other parts clear of the object and the joints within their
//! limits. Then the fingers are opened a little and closed again by the closing rules, so
//! that what is reported touches the surface and breaks no rule.

use std::f64::consts::TAU;

use grasp::Contact;
use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion, UnitVector3, Vector3};
use rand::{Rng, RngExt};
use sph::Direction;

use crate::closing::{ClosingRules, close_hand};
use crate::collision::{CollisionObject, Precision};
use crate::contact::tip_contact;
use crate::hand::{Finger, Hand};
use crate::least_squares::{Stopping, minimise};

/// Length by which a turned tip counts as a misplaced one, metres a radian: first to find
/// the right side of the tip, then hardly, so that it does not pull the tip off the contact.
const FACING_WEIGHTS: (f64, f64) = (4e-3, 2e-4);
/// The balls that stand in for the object at its contacts are no larger than this, metres.
const MAX_DEPTH: f64 = 0.02;
/// Share of a missing clearance that counts.
const CLEARANCE_WEIGHT: f64 = 0.5;
/// A start whose tips come nearer than this (root sum of squares, metres) is closed and checked.
const PROMISING: f64 = 3e-3;

/// What is wanted of a hand that reaches contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReachParams {
    /// Number of starts, at most.
    pub starts: usize,
    /// Contacts may be this far from where they were wanted, metres.
    pub tolerance: f64,
    /// The friction coefficient: normals may differ by its angle.
    pub friction: f64,
    /// The rules that the closed hand keeps.
    pub rules: ClosingRules,
    /// How far fingers open before they close again, in units of closing.
    pub opening: f64,
}

impl Default for ReachParams {
    /// 2 mm, μ = 1, the paper's clearances, 60 starts.
    fn default() -> Self {
        ReachParams {
            starts: 60,
            tolerance: 2e-3,
            friction: 1.0,
            rules: ClosingRules::default(),
            opening: 0.25,
        }
    }
}

/// A hand at contacts.
#[derive(Debug, Clone, PartialEq)]
pub struct Reached {
    /// Pose of the palm (the root link) in the object frame.
    pub object_from_palm: Isometry3<f64>,
    /// One value a driven joint.
    pub joints: Vec<f64>,
    /// Which finger holds each wanted contact.
    pub finger_of_contact: Vec<usize>,
    /// The contacts that the hand makes, in the order of the wanted ones.
    pub contacts: Vec<Contact>,
    /// Their directions from the object's origin.
    pub directions: Vec<Direction>,
    /// Largest distance between a contact and the wanted one, metres.
    pub position_error: f64,
    /// Largest angle between normal and wanted normal, radians.
    pub normal_error: f64,
    /// Starts used.
    pub starts: usize,
}

/// How reaching contacts went.
#[derive(Debug, Clone, PartialEq)]
pub enum ReachOutcome {
    /// Within the tolerance and without a rule broken.
    Reached(Reached),
    /// All rules kept, but not as near as wanted; the nearest.
    Near(Reached),
    /// No start ended in a hand that keeps the rules.
    Nothing {
        /// Least root sum of squared distances of tips and contacts, metres.
        best_fit: f64,
    },
    /// There are not as many contacts as fingers.
    WrongCount {
        /// Contacts wanted.
        contacts: usize,
        /// Fingers of the hand.
        fingers: usize,
    },
}

/// Looks for a hand pose whose tips meet the wanted contacts (object frame).
///
/// Stops at the first start within the tolerance. The same generator state gives the
/// same result. Cost: some milliseconds a start.
pub fn reach_contacts<R: Rng + ?Sized>(
    object: &CollisionObject<'_>,
    hand: &Hand,
    wanted: &[Contact],
    params: &ReachParams,
    rng: &mut R,
) -> ReachOutcome {
    let fingers = hand.fingers.len();
    if wanted.len() != fingers {
        return ReachOutcome::WrongCount {
            contacts: wanted.len(),
            fingers,
        };
    }
    let problem = Problem::new(object, hand, wanted, params);
    let mut nearest: Option<Reached> = None;
    let mut best_fit = f64::INFINITY;
    for start in 1..=params.starts {
        let mut x = problem.random_start(rng);
        let finger_of_contact = problem.assignment(&x);
        let fit = problem.solve(&mut x, &finger_of_contact);
        best_fit = best_fit.min(fit);
        if fit > PROMISING {
            continue;
        }
        if let Some(found) = problem.close(&x, &finger_of_contact, start) {
            let cone = params.friction.atan();
            if found.position_error <= params.tolerance && found.normal_error <= cone {
                return ReachOutcome::Reached(found);
            }
            let nearer = |n: &Reached| found.position_error < n.position_error;
            if nearest.as_ref().is_none_or(nearer) {
                nearest = Some(found);
            }
        }
    }
    nearest.map_or(ReachOutcome::Nothing { best_fit }, ReachOutcome::Near)
}

/// Where a tip faces: the direction in which closing moves it, in the frame of its first link.
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

struct Problem<'a> {
    object: &'a CollisionObject<'a>,
    hand: &'a Hand,
    wanted: &'a [Contact],
    params: &'a ReachParams,
    pads: Vec<Vector3<f64>>,
    /// Links that are no tips.
    others: Vec<usize>,
    /// Radius of the balls inside the object that tips are to touch, metres.
    depth: f64,
}

impl<'a> Problem<'a> {
    fn new(
        object: &'a CollisionObject<'a>,
        hand: &'a Hand,
        wanted: &'a [Contact],
        params: &'a ReachParams,
    ) -> Self {
        let is_tip = |l: &usize| hand.fingers.iter().any(|f| f.tip_links.contains(l));
        Problem {
            object,
            hand,
            wanted,
            params,
            pads: hand
                .fingers
                .iter()
                .map(|f| pad_direction(hand, f))
                .collect(),
            others: (0..hand.shapes.len())
                .filter(|l| !is_tip(l) && !hand.shapes[*l].is_empty())
                .collect(),
            depth: (0.7 * object.surface().radius_bounds().0).min(MAX_DEPTH),
        }
    }

    /// Variables: translation, rotation vector of the palm, then the driven joints.
    fn pose(&self, x: &DVector<f64>) -> Isometry3<f64> {
        let turn = Vector3::new(x[3], x[4], x[5]);
        Isometry3::from_parts(
            Translation3::new(x[0], x[1], x[2]),
            UnitQuaternion::from_scaled_axis(turn),
        )
    }

    fn links(&self, x: &DVector<f64>) -> Vec<Isometry3<f64>> {
        let model = &self.hand.model;
        let mut poses = vec![self.pose(x); model.links.len()];
        model.update_links(&x.as_slice()[6..], 1..model.links.len(), &mut poses);
        poses
    }

    /// A hand that approaches the contacts across their plane or from anywhere, half closed.
    fn random_start<R: Rng + ?Sized>(&self, rng: &mut R) -> DVector<f64> {
        let hand = self.hand;
        let count = self.wanted.len() as f64;
        let centre = self
            .wanted
            .iter()
            .map(|c| c.position.coords)
            .sum::<Vector3<f64>>()
            / count;
        let mut draw = || rng.random_range(-1.0..1.0);
        let spread = Vector3::new(draw(), draw(), draw());
        let first = self.wanted[0].position.coords - centre;
        let across = self.wanted[1..]
            .iter()
            .map(|c| first.cross(&(c.position.coords - centre)))
            .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
            .and_then(|c| c.try_normalize(1e-9))
            .unwrap_or_else(Vector3::z);
        let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        let from = UnitVector3::try_new(across * side + spread * 0.8, 1e-6);
        let from = from.unwrap_or(Vector3::z_axis());
        let roll = rng.random_range(0.0..TAU);
        let (low, high) = hand.standoff;
        let distance = rng.random_range(0.8 * low..=1.1 * high);
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
        let turn = pose.rotation.scaled_axis();
        let head = pose.translation.vector.iter().chain(turn.iter());
        DVector::from_iterator(6 + joints.len(), head.chain(joints.iter()).copied())
    }

    /// The assignment of fingers to contacts with the least sum of squared distances at x.
    fn assignment(&self, x: &DVector<f64>) -> Vec<usize> {
        let poses = self.links(x);
        let cost = |contact: usize, finger: usize| {
            let link = self.hand.fingers[finger].tip_links[0];
            let tip = poses[link] * self.hand.shapes[link].centre;
            (tip - self.wanted[contact].position).norm_squared()
        };
        let mut order: Vec<usize> = (0..self.wanted.len()).collect();
        // Exchanging two at a time until none gains is exact for three, good for more.
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

    /// Least squares without, then with clearances; returns the misfit of the tips in metres.
    fn solve(&self, x: &mut DVector<f64>, fingers: &[usize]) -> f64 {
        let stopping = Stopping {
            iterations: 25,
            cost: 1e-10,
            decrease: 1e-3,
        };
        let project = |x: &mut DVector<f64>| {
            self.hand.model.clamp_to_limits(&mut x.as_mut_slice()[6..]);
        };
        minimise(
            x,
            stopping,
            |x| self.tips(x, fingers, FACING_WEIGHTS.0),
            project,
        );
        if self.misfit(x, fingers) > 0.03 {
            return self.misfit(x, fingers);
        }
        let both = |x: &DVector<f64>| {
            let tips = self.tips(x, fingers, FACING_WEIGHTS.1);
            let free = self.clearances(x);
            DVector::from_iterator(
                tips.len() + free.len(),
                tips.iter().chain(free.iter()).copied(),
            )
        };
        minimise(x, stopping, both, project);
        self.misfit(x, fingers)
    }

    fn misfit(&self, x: &DVector<f64>, fingers: &[usize]) -> f64 {
        let all = self.tips(x, fingers, 0.0);
        let positions = all.as_slice().chunks_exact(6).flat_map(|c| &c[..3]);
        positions.map(|v| v * v).sum::<f64>().sqrt()
    }

    /// Six residuals a contact: how far the tip is from touching, at the contact, a ball
    /// that lies inside the object there (its centre is `depth` below the contact, so a
    /// tip that is tilted is off by as much as one that is moved), and how the pad is
    /// turned from the inward normal.
    fn tips(&self, x: &DVector<f64>, fingers: &[usize], facing_weight: f64) -> DVector<f64> {
        let poses = self.links(x);
        let mut all = DVector::zeros(6 * self.wanted.len());
        for (k, (contact, &finger)) in self.wanted.iter().zip(fingers).enumerate() {
            let links = &self.hand.fingers[finger].tip_links;
            let normal = contact.inward_normal.into_inner();
            let centre = contact.position + normal * self.depth;
            let reach = normal * (self.depth + 0.5 * self.params.rules.tip_gap);
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

    /// What each other link lacks of its clearance.
    fn clearances(&self, x: &DVector<f64>) -> DVector<f64> {
        let least = 1.3 * self.params.rules.object_clearance;
        let poses = self.links(x);
        let precision = Precision {
            cutoff: least,
            absolute: 1e-5,
            relative: 0.0,
        };
        let lacking = self.others.iter().map(|&l| {
            let gap = self
                .object
                .link_gap(&self.hand.shapes[l], &poses[l], precision);
            CLEARANCE_WEIGHT * (least - gap.lower).max(0.0)
        });
        DVector::from_iterator(self.others.len(), lacking)
    }

    /// Opens the fingers, closes them by the rules and measures where they touch.
    fn close(&self, x: &DVector<f64>, fingers: &[usize], starts: usize) -> Option<Reached> {
        let hand = self.hand;
        let pose = self.pose(x);
        let mut open = x.as_slice()[6..].to_vec();
        for &(driven, ratio) in hand.fingers.iter().flat_map(|f| &f.closing) {
            open[driven] -= self.params.opening * ratio;
        }
        hand.model.clamp_to_limits(&mut open);
        let closed = close_hand(self.object, hand, &pose, &open, &self.params.rules).ok()?;
        let mut reached = Reached {
            object_from_palm: pose,
            joints: closed.joints,
            finger_of_contact: fingers.to_vec(),
            contacts: Vec::with_capacity(fingers.len()),
            directions: Vec::with_capacity(fingers.len()),
            position_error: 0.0,
            normal_error: 0.0,
            starts,
        };
        for (contact, &finger) in self.wanted.iter().zip(fingers) {
            let tip = &hand.fingers[finger];
            let touch = tip_contact(self.object, hand, tip, &closed.object_from_links)
                .filter(|t| t.gap < self.params.rules.tip_gap)?;
            let apart = (touch.position - contact.position).norm();
            let turned = touch.inward_normal.angle(&contact.inward_normal);
            reached.position_error = reached.position_error.max(apart);
            reached.normal_error = reached.normal_error.max(turned);
            reached.directions.push(touch.direction);
            reached.contacts.push(Contact {
                position: touch.position,
                inward_normal: touch.inward_normal,
            });
        }
        Some(reached)
    }
}
