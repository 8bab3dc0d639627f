//! Grasps of a hand on an object: sampled poses, closed fingers, ranked results.

use std::collections::BTreeMap;

use grasp::{Contact, Convention, GraspModel, QualityError, Workspace, epsilon};
use nalgebra::{Isometry3, Point3};
use rand::Rng;
use rayon::prelude::*;
use shape::SurfaceRef;
use sph::Direction;
use thiserror::Error;

use crate::closing::{ClosingRules, Rejection, close_hand};
use crate::collision::{CollisionObject, ObjectError};
use crate::contact::{TipContact, link_contact, tip_contact};
use crate::hand::Hand;
use crate::pose_sampling::{HandPose, PoseSampling};
use crate::tip_model::TipModel;

/// Settings of a synthesis run.
#[derive(Debug, Clone, PartialEq)]
pub struct SynthesisParams {
    /// Number of poses to try.
    pub poses: usize,
    /// The distribution of the poses.
    pub sampling: PoseSampling,
    /// The closing rules: when fingers have arrived, and the clearances.
    pub rules: ClosingRules,
    /// How quality is measured.
    pub convention: Convention,
    /// The point about which torques are taken, centred frame, metres.
    pub centre: Point3<f64>,
    /// What the contacts transmit, apart from friction.
    pub tips: TipModel,
    /// Grasps of lower quality count as unstable; the paper's bound is 0.01.
    pub least_quality: f64,
}

/// A grasp that a hand can make.
#[derive(Debug, Clone, PartialEq)]
pub struct HandGrasp {
    /// Pose of the palm (the root link) in the centred frame.
    pub object_from_palm: Isometry3<f64>,
    /// One value per driven joint, in the order of [`crate::HandModel::driven_names`].
    pub joints: Vec<f64>,
    /// Index of the pre-shape from which the fingers closed.
    pub preshape: usize,
    /// One contact per finger, or with [`ClosingRules::past_tips`] one per link that touches;
    /// centred frame, inward normals.
    pub contacts: Vec<Contact>,
    /// Directions of the contacts from the origin: the grasp's point of (S²)^m.
    pub directions: Vec<Direction>,
    /// Distance of each tip from its contact, metres.
    pub gaps: Vec<f64>,
    /// The link that makes each contact (the first of a finger's tip links).
    pub links: Vec<usize>,
    /// Quality under the run's convention.
    pub quality: f64,
}

/// The outcome of one pose.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// A grasp of at least the wanted quality.
    Stable(HandGrasp),
    /// A grasp of less than the wanted quality.
    Unstable(HandGrasp),
    /// No grasp.
    Rejected(Rejection),
}

/// The number of poses by outcome.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OutcomeCounts {
    /// Stable grasps.
    pub stable: usize,
    /// Grasps of too low a quality.
    pub unstable: usize,
    /// Rejected poses by reason.
    pub rejected: BTreeMap<Rejection, usize>,
}

/// Ranked grasps and the outcomes of all poses.
#[derive(Debug, Clone, PartialEq)]
pub struct Synthesis {
    /// Stable grasps, the best first.
    pub grasps: Vec<HandGrasp>,
    /// Counts over all poses.
    pub outcomes: OutcomeCounts,
}

/// Why a synthesis run cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SynthesisError {
    /// The object cannot be prepared.
    #[error(transparent)]
    Object(#[from] ObjectError),
    /// The quality cannot be computed.
    #[error(transparent)]
    Quality(#[from] QualityError),
}

impl OutcomeCounts {
    /// Adds one outcome.
    pub fn add(&mut self, outcome: &Outcome) {
        match outcome {
            Outcome::Stable(_) => self.stable += 1,
            Outcome::Unstable(_) => self.unstable += 1,
            Outcome::Rejected(reason) => *self.rejected.entry(*reason).or_default() += 1,
        }
    }

    /// Number of poses counted.
    pub fn total(&self) -> usize {
        self.stable + self.unstable + self.rejected.values().sum::<usize>()
    }

    /// Rejected poses by kind of reason, summed over links and fingers, in a fixed order.
    pub fn by_reason(&self) -> Vec<(&'static str, usize)> {
        Rejection::REASONS
            .iter()
            .map(|&name| {
                let of = self.rejected.iter().filter(|(r, _)| r.reason() == name);
                (name, of.map(|(_, count)| count).sum())
            })
            .collect()
    }
}

impl Rejection {
    /// All reasons, in the order in which they are tested.
    pub const REASONS: [&'static str; 10] = [
        "below_support",
        "obstacle",
        "base_near_object",
        "starts_in_object",
        "part_near_object",
        "tip_did_not_arrive",
        "parts_near_each_other",
        "no_contact",
        "on_closed_hole",
        "in_scan",
    ];

    /// The kind of reason, without link or finger.
    pub fn reason(&self) -> &'static str {
        match self {
            Rejection::BelowSupport { .. } => Self::REASONS[0],
            Rejection::Obstacle { .. } => Self::REASONS[1],
            Rejection::BaseNearObject { .. } => Self::REASONS[2],
            Rejection::StartsInObject { .. } => Self::REASONS[3],
            Rejection::PartNearObject { .. } => Self::REASONS[4],
            Rejection::TipDidNotArrive { .. } => Self::REASONS[5],
            Rejection::PartsNear { .. } => Self::REASONS[6],
            Rejection::NoContact { .. } => Self::REASONS[7],
            Rejection::OnClosedHole { .. } => Self::REASONS[8],
            Rejection::InScan { .. } => Self::REASONS[9],
        }
    }

    /// A sentence with the names of links and fingers.
    pub fn describe(&self, hand: &Hand) -> String {
        let link = |l: &usize| hand.model().links()[*l].name.as_str();
        let finger = |f: &usize| hand.fingers()[*f].name.as_str();
        match self {
            Rejection::BelowSupport { link: l } => {
                format!("'{}' is too near to the support plane or below it", link(l))
            }
            Rejection::Obstacle { link: l } => {
                format!("'{}' is too near to another piece of the scene", link(l))
            }
            Rejection::InScan { link: l } => {
                format!("'{}' is inside the scan", link(l))
            }
            Rejection::BaseNearObject { link: l } => {
                format!("'{}' is too near to the object", link(l))
            }
            Rejection::StartsInObject { finger: f } => {
                format!("finger '{}' starts in the object", finger(f))
            }
            Rejection::PartNearObject { link: l } => {
                format!("'{}' came too near to the object", link(l))
            }
            Rejection::TipDidNotArrive { finger: f } => {
                format!("the tip of finger '{}' met nothing", finger(f))
            }
            Rejection::PartsNear { first, second } => {
                format!("'{}' and '{}' are too near", link(first), link(second))
            }
            Rejection::NoContact { finger: f } => {
                format!("finger '{}' has no contact within the gap", finger(f))
            }
            Rejection::OnClosedHole { finger: f } => {
                format!("finger '{}' touches where a hole was closed", finger(f))
            }
        }
    }
}

/// Samples poses, closes the hand from each and ranks the stable grasps.
///
/// Poses are drawn in one sequence, then evaluated on the threads of rayon's pool; the result does not
/// depend on their number.
///
/// # Errors
/// The surface is too rough for the collision model, or the convention cannot be used.
pub fn synthesize<'a, R: Rng + ?Sized>(
    surface: impl Into<SurfaceRef<'a>>,
    hand: &Hand,
    params: &SynthesisParams,
    rng: &mut R,
) -> Result<Synthesis, SynthesisError> {
    synthesize_watched(surface, hand, params, rng, &|| {})
}

/// As [`synthesize`]; `pose_done` is called once per pose, from any thread.
///
/// # Errors
/// As [`synthesize`].
pub fn synthesize_watched<'a, R: Rng + ?Sized>(
    surface: impl Into<SurfaceRef<'a>>,
    hand: &Hand,
    params: &SynthesisParams,
    rng: &mut R,
    pose_done: &(dyn Fn() + Sync),
) -> Result<Synthesis, SynthesisError> {
    let object = CollisionObject::new(surface)?;
    Ok(synthesize_on(&object, hand, params, rng, pose_done)?)
}

/// As [`synthesize_watched`], on an object that has been prepared, perhaps with its surroundings.
///
/// # Errors
/// The convention cannot be used.
pub fn synthesize_on<R: Rng + ?Sized>(
    object: &CollisionObject<'_>,
    hand: &Hand,
    params: &SynthesisParams,
    rng: &mut R,
    pose_done: &(dyn Fn() + Sync),
) -> Result<Synthesis, QualityError> {
    let poses = params.sampling.sample(object, hand, params.poses, rng);
    let outcomes = poses
        .par_iter()
        .map(|pose| {
            let outcome = evaluate_pose(object, hand, pose, params);
            pose_done();
            outcome
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok(collect(outcomes))
}

/// Closes the hand from one pose and measures the grasp; depends on nothing else.
pub fn evaluate_pose(
    object: &CollisionObject<'_>,
    hand: &Hand,
    pose: &HandPose,
    params: &SynthesisParams,
) -> Result<Outcome, QualityError> {
    let grasp = match close_and_touch(object, hand, pose, &params.rules) {
        Ok(grasp) => grasp,
        Err(reason) => return Ok(Outcome::Rejected(reason)),
    };
    let friction = params.convention.friction;
    let models = params.tips.of_contacts(friction, grasp.contacts.len());
    let model = GraspModel::new(&grasp.contacts, &params.centre, &params.convention);
    let model = model.with_contact_models(&models);
    let found = epsilon(&model, &mut Workspace::new())?;
    let quality = found.value(&params.convention);
    let grasp = HandGrasp { quality, ..grasp };
    Ok(if quality > 0.0 && quality >= params.least_quality {
        Outcome::Stable(grasp)
    } else {
        Outcome::Unstable(grasp)
    })
}

fn close_and_touch(
    object: &CollisionObject<'_>,
    hand: &Hand,
    pose: &HandPose,
    rules: &ClosingRules,
) -> Result<HandGrasp, Rejection> {
    let start = &hand.preshapes()[pose.preshape].joints;
    let closed = close_hand(object, hand, &pose.object_from_palm, start, rules)?;
    let mut grasp = HandGrasp {
        object_from_palm: closed.object_from_links[0],
        joints: closed.joints,
        preshape: pose.preshape,
        contacts: Vec::with_capacity(hand.fingers().len()),
        directions: Vec::with_capacity(hand.fingers().len()),
        gaps: Vec::with_capacity(hand.fingers().len()),
        links: Vec::with_capacity(hand.fingers().len()),
        quality: 0.0,
    };
    let mut touch = |contact: TipContact, finger: usize, link: usize| {
        if object.is_closed_hole(&contact.position) {
            return Err(Rejection::OnClosedHole { finger });
        }
        grasp.contacts.push(Contact {
            position: contact.position,
            inward_normal: contact.inward_normal,
        });
        grasp.directions.push(contact.direction);
        grasp.gaps.push(contact.gap);
        grasp.links.push(link);
        Ok(())
    };
    let poses = &closed.object_from_links;
    for (finger, of_finger) in hand.fingers().iter().enumerate() {
        let near = |c: &TipContact| c.gap < rules.tip_gap;
        let touches = |l: &usize| closed.touching.contains(l);
        if !rules.past_tips {
            // If not all fingers must touch, this one need not.
            if !of_finger.tip_links.iter().any(touches) {
                continue;
            }
            let contact = tip_contact(object, hand, of_finger, poses)
                .filter(near)
                .ok_or(Rejection::NoContact { finger })?;
            touch(contact, finger, of_finger.tip_links[0])?;
            continue;
        }
        let moved = |l: &&usize| of_finger.moving_links.contains(l);
        for &link in closed.touching.iter().filter(moved) {
            let contact = link_contact(object, hand, link, poses)
                .filter(near)
                .ok_or(Rejection::NoContact { finger })?;
            touch(contact, finger, link)?;
        }
    }
    Ok(grasp)
}

/// Counts outcomes and ranks the stable grasps, the best first. Equal ones keep the order of their
/// poses.
pub fn collect(outcomes: impl IntoIterator<Item = Outcome>) -> Synthesis {
    let mut counts = OutcomeCounts::default();
    let mut grasps = Vec::new();
    for outcome in outcomes {
        counts.add(&outcome);
        if let Outcome::Stable(grasp) = outcome {
            grasps.push(grasp);
        }
    }
    grasps.sort_by(|a, b| b.quality.total_cmp(&a.quality));
    Synthesis {
        grasps,
        outcomes: counts,
    }
}
