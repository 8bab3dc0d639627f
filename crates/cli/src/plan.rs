//! The main job: candidates by transfer and by synthesis, ranked.

pub(crate) mod fitted;
pub(crate) mod library;
pub(crate) mod page;
pub(crate) mod ranking;
pub(crate) mod reach;
pub(crate) mod result;
pub(crate) mod synthesis;
pub(crate) mod transfer;

use grasp::{Contact, Convention};
use nalgebra::{Isometry3, Point3};
use space::Objective;
use sph::Direction;

pub(crate) use fitted::Fitted;

/// The object that is grasped, and how quality is measured on it.
pub(crate) struct Target<'a> {
    pub(crate) name: &'a str,
    pub(crate) fit: &'a Fitted,
    /// The rule, as it holds on any object.
    pub(crate) rule: &'a Convention,
    /// With everything that the surface decides filled in.
    pub(crate) convention: Convention,
    /// The point about which torques are taken, centred frame.
    pub(crate) centre: Point3<f64>,
}

impl<'a> Target<'a> {
    pub(crate) fn new(name: &'a str, fit: &'a Fitted, rule: &'a Convention) -> Self {
        let objective = Objective::new(rule, &fit.shape, &fit.object_origin());
        Self {
            name,
            fit,
            rule,
            convention: objective.convention().clone(),
            centre: objective.centre(),
        }
    }

    /// Origin of the user's frame in the centred frame.
    pub(crate) fn object_origin(&self) -> Point3<f64> {
        self.fit.object_origin()
    }
}

/// A grasp on the target, centred frame, not yet ranked.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    /// The point of (S²)^m whose image the contacts are.
    pub(crate) directions: Vec<Direction>,
    pub(crate) contacts: Vec<Contact>,
    pub(crate) quality: f64,
    pub(crate) source: Source,
    pub(crate) hand: Option<HandPlacement>,
    /// For transfers, what they came with.
    pub(crate) carried: Option<transfer::Carried>,
}

/// Where a candidate comes from.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    Transfer {
        /// Id and name of the library object.
        from: String,
        /// Distance of its shape from the target's, metres.
        shape_distance: f64,
        /// Quality on the library object.
        source_quality: f64,
    },
    Synthesis {
        /// Index of the hand's pre-shape from which the fingers closed.
        preshape: usize,
    },
}

/// A hand at a grasp, centred frame.
#[derive(Clone, Debug)]
pub(crate) struct HandPlacement {
    pub(crate) object_from_palm: Isometry3<f64>,
    /// In the order of the hand's driven joints.
    pub(crate) joints: Vec<f64>,
    /// Largest distance from a contact of this hand to the grasp's own, metres.
    pub(crate) contact_error: f64,
    /// Whether the grasp's contacts are those that were looked for; else others that the hand makes.
    pub(crate) met: bool,
}
