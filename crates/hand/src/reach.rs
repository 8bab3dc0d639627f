//! From contacts to a hand: a pose and joint values that bring the tips to given contacts.
//!
//! Every start is a random pose near the contacts with an assignment of fingers to them. Damped
//! least squares over pose and joints brings the tips to the contacts, facing along the inward
//! normals, with the other parts clear of the object and the joints within their limits. Then the
//! fingers are opened a little and closed again by the closing rules, so that the reported hand
//! touches the surface and breaks no rule.

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

/// Settings of a search for a hand pose at contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReachParams {
    /// Number of random starts, at most.
    pub starts: usize,
    /// Largest distance of a contact from the wanted one, metres.
    pub tolerance: f64,
    /// The friction coefficient: normals may differ by its angle.
    pub friction: f64,
    /// The rules that the closed hand satisfies.
    pub rules: ClosingRules,
    /// Amount by which the fingers open before they close again, in units of closing.
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

/// The state of a hand: its pose and joints.
#[derive(Debug, Clone, PartialEq)]
pub struct HandState {
    /// Pose of the palm (the root link) in the centred frame.
    pub object_from_palm: Isometry3<f64>,
    /// One value per driven joint.
    pub joints: Vec<f64>,
}

/// A hand whose tips are at contacts.
#[derive(Debug, Clone, PartialEq)]
pub struct Reached {
    /// Pose of the palm (the root link) in the centred frame.
    pub object_from_palm: Isometry3<f64>,
    /// One value per driven joint.
    pub joints: Vec<f64>,
    /// The finger at each wanted contact.
    pub finger_of_contact: Vec<usize>,
    /// The hand's contacts, in the order of the wanted ones.
    pub contacts: Vec<Contact>,
    /// Their directions from the origin of the centred frame.
    pub directions: Vec<Direction>,
    /// Largest distance between a contact and the wanted one, metres.
    pub position_error: f64,
    /// Largest angle between normal and wanted normal, radians.
    pub normal_error: f64,
    /// Starts used.
    pub starts: usize,
}

impl Reached {
    /// Measures the distances of the contacts from the wanted ones.
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

/// The result of a search at contacts.
#[derive(Debug, Clone, PartialEq)]
pub enum ReachOutcome {
    /// A hand within the tolerance that satisfies every rule.
    Reached(Reached),
    /// The nearest hand that satisfies every rule, outside the tolerance.
    Near(Reached),
    /// No start ended in a hand that satisfies the rules.
    Nothing {
        /// Least root sum of squared distances of tips and contacts, metres.
        best_fit: f64,
    },
    /// The number of contacts is not the number of fingers.
    WrongCount {
        /// Contacts wanted.
        contacts: usize,
        /// Fingers of the hand.
        fingers: usize,
    },
}

/// A hand and an object, prepared for searches of hand poses at contacts.
#[derive(Debug, Clone)]
pub struct Reacher<'a> {
    problem: Problem<'a>,
}

/// Looks for a hand pose whose tips meet the wanted contacts (centred frame).
///
/// As [`Reacher::reach`] without known hands, for one search on an object.
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
    /// Prepares a hand and an object for any number of searches.
    pub fn new(object: &'a CollisionObject<'a>, hand: &'a Hand) -> Self {
        Reacher {
            problem: Problem::new(object, hand),
        }
    }

    /// Looks for a hand pose whose tips meet the wanted contacts (centred frame).
    ///
    /// Starts from the hands in `known` (see [`crate::carried_pose`]), then from random ones that
    /// fit the contacts, and stops at the first within the tolerance. The same generator state
    /// gives the same result. Cost: about a millisecond per start.
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
