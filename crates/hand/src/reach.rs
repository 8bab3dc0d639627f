//! From contacts to a hand: a pose and joint values that bring the tips to given contacts.
//!
//! Every start is a random pose about the contacts and an assignment of fingers to them.
//! Damped least squares over pose and joints brings the tips to the contacts, facing
//! along the inward normals, with the other parts clear of the object and the joints within their
//! limits. Then the fingers are opened a little and closed again by the closing rules, so
//! that what is reported touches the surface and breaks no rule.

mod improve;
mod problem;
mod start;

use grasp::Contact;
use nalgebra::Isometry3;
use rand::Rng;
use sph::Direction;

use crate::closing::ClosingRules;
use crate::collision::CollisionObject;
use crate::hand::Hand;
pub use improve::{ImproveParams, Improvement};
use problem::{Problem, Task};
use start::{Start, orders};

/// A start whose tips come nearer than this (root sum of squares, metres) is closed and checked.
const PROMISING: f64 = 3e-3;

/// What is wanted of a hand that reaches contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReachParams {
    /// Number of random starts, at most.
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

/// A hand somewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct HandState {
    /// Pose of the palm (the root link) in the object frame.
    pub object_from_palm: Isometry3<f64>,
    /// One value a driven joint.
    pub joints: Vec<f64>,
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

impl Reached {
    /// Measures how far the contacts are from wanted ones.
    fn measure_errors(&mut self, wanted: &[Contact]) {
        (self.position_error, self.normal_error) = (0.0, 0.0);
        for (made, wanted) in self.contacts.iter().zip(wanted) {
            let apart = (made.position - wanted.position).norm();
            let turned = made.inward_normal.angle(&wanted.inward_normal);
            self.position_error = self.position_error.max(apart);
            self.normal_error = self.normal_error.max(turned);
        }
    }
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

/// A hand and an object, prepared for looking for hand poses at contacts.
#[derive(Debug, Clone)]
pub struct Reacher<'a> {
    problem: Problem<'a>,
}

/// Looks for a hand pose whose tips meet the wanted contacts (object frame).
///
/// The same as [`Reacher::reach`] without known hands, for one search on an object.
pub fn reach_contacts<R: Rng + ?Sized>(
    object: &CollisionObject<'_>,
    hand: &Hand,
    wanted: &[Contact],
    params: &ReachParams,
    rng: &mut R,
) -> ReachOutcome {
    Reacher::new(object, hand).reach(wanted, params, &[], rng)
}

impl<'a> Reacher<'a> {
    /// Prepares both; for any number of searches.
    pub fn new(object: &'a CollisionObject<'a>, hand: &'a Hand) -> Self {
        Reacher {
            problem: Problem::new(object, hand),
        }
    }

    /// Looks for a hand pose whose tips meet the wanted contacts (object frame).
    ///
    /// Starts from the hands in `known` (see [`crate::carried_pose`]), then from random ones that
    /// suit the contacts, and stops at the first within the tolerance. The same generator state
    /// gives the same result. Cost: a millisecond a start.
    pub fn reach<R: Rng + ?Sized>(
        &self,
        wanted: &[Contact],
        params: &ReachParams,
        known: &[HandState],
        rng: &mut R,
    ) -> ReachOutcome {
        let problem = &self.problem;
        let fingers = problem.hand.fingers.len();
        if wanted.len() != fingers {
            return ReachOutcome::WrongCount {
                contacts: wanted.len(),
                fingers,
            };
        }
        let orders = orders(fingers);
        let mut nearest: Option<Reached> = None;
        let mut best_fit = f64::INFINITY;
        for number in 1..=params.starts + known.len() {
            let start = match known.get(number - 1) {
                Some(hand) => problem.known_start(hand, wanted),
                None if number % 2 == 0 => problem.aligned_start(wanted, &orders, rng),
                None => problem.approaching_start(wanted, params.rules.support.as_ref(), rng),
            };
            let Start { mut x, fingers } = start;
            let task = Task {
                wanted,
                fingers: &fingers,
                params,
            };
            let fit = problem.solve(&mut x, &task);
            best_fit = best_fit.min(fit);
            if !(fit <= PROMISING) {
                continue;
            }
            if let Some(found) = problem.close(&x, &task, number) {
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
}
