//! Grasps: a point of (S²)^m with its contacts, quality, origin and hand.

use grasp::{Contact, Epsilon};
use hand::OutcomeCounts;
use nalgebra::{Isometry3, Point3, UnitVector3};
use sph::Direction;

use crate::frame::CloudFrame;

/// A grasp on one object.
///
/// The directions, a point of (S²)^m, are stored with the grasp; they are not recomputed from
/// positions.
#[derive(Clone, Debug)]
pub struct Grasp {
    directions: Vec<Direction>,
    contacts: Vec<Contact>,
    epsilon: Epsilon,
    source: Source,
    hand: Option<HandPlacement>,
    frame: CloudFrame,
}

/// The origin of a grasp.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Source {
    /// Transferred from a known object.
    Transfer {
        /// Id and name of that object.
        from: String,
        /// Distance of its shape from this object's, metres.
        shape_distance: f64,
        /// Quality on that object.
        source_quality: f64,
        /// Quality on this object of the same directions, before any ascent.
        naive: f64,
    },
    /// Made by closing a hand on the object.
    Synthesis {
        /// Index of the hand's pre-shape from which the fingers closed.
        preshape: usize,
    },
    /// The contacts were given.
    Given,
}

/// A hand at a grasp.
#[derive(Clone, Debug, PartialEq)]
pub struct HandPlacement {
    /// Pose of the palm in the centred frame.
    pub centred_from_palm: Isometry3<f64>,
    /// Joint values in the order of the hand's driven joints, radians or metres.
    pub joints: Vec<f64>,
    /// The same before the fingers close.
    pub pregrasp_joints: Vec<f64>,
    /// Largest distance from a contact of this hand to the grasp's own contact, metres.
    pub contact_error: f64,
    /// Whether the hand meets the requested contacts. If not, the contacts are others that the hand
    /// makes near them.
    pub met: bool,
    /// Least height of a link above the plane on which the object stands, metres, where there is one.
    pub clearance_to_support: Option<f64>,
}

impl Grasp {
    pub(crate) fn new(
        directions: Vec<Direction>,
        contacts: Vec<Contact>,
        epsilon: Epsilon,
        source: Source,
        frame: CloudFrame,
    ) -> Self {
        Self {
            directions,
            contacts,
            epsilon,
            source,
            hand: None,
            frame,
        }
    }

    pub(crate) fn place(&mut self, hand: HandPlacement) {
        self.hand = Some(hand);
    }

    pub(crate) fn with_hand(self, hand: Option<HandPlacement>) -> Self {
        Self { hand, ..self }
    }

    /// Epsilon quality under the convention of the measure that made the grasp; 0 when the grasp is
    /// not force-closed.
    pub fn quality(&self) -> f64 {
        self.epsilon.quality
    }

    /// The quality with its proved interval, and the wrench that the grasp resists least.
    pub fn epsilon(&self) -> &Epsilon {
        &self.epsilon
    }

    /// Directions of the contacts from the centre of the object: the point of (S²)^m.
    pub fn directions(&self) -> &[Direction] {
        &self.directions
    }

    /// The contacts in the centred frame, normals into the object.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// Positions of the contacts in the frame of the cloud, metres.
    pub fn contacts_in_cloud(&self) -> Vec<Point3<f64>> {
        let in_cloud = |c: &Contact| self.frame.to_cloud(&c.position);
        self.contacts.iter().map(in_cloud).collect()
    }

    /// Unit normals at the contacts, into the object.
    pub fn inward_normals(&self) -> Vec<UnitVector3<f64>> {
        self.contacts.iter().map(|c| c.inward_normal).collect()
    }

    /// The origin of the grasp.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The hand of the grasp, if one was found.
    pub fn hand(&self) -> Option<&HandPlacement> {
        self.hand.as_ref()
    }

    /// Pose of the palm in the frame of the cloud, if the grasp has a hand.
    pub fn palm_in_cloud(&self) -> Option<Isometry3<f64>> {
        let in_cloud = |hand: &HandPlacement| self.frame.pose_to_cloud(&hand.centred_from_palm);
        self.hand.as_ref().map(in_cloud)
    }
}

/// A list of grasps, and the outcomes of the hand poses that were tried for it.
#[derive(Clone, Debug, Default)]
pub struct Grasps {
    pub(crate) list: Vec<Grasp>,
    pub(crate) outcomes: Option<OutcomeCounts>,
}

impl Grasps {
    /// Adds the grasps of another list.
    pub fn extend(&mut self, other: Grasps) {
        self.list.extend(other.list);
        self.outcomes = self.outcomes.take().or(other.outcomes);
    }

    /// The `count` best force-closed grasps, the best first; equal ones stay in the order in which
    /// they were found.
    pub fn best(&self, count: usize) -> Vec<&Grasp> {
        let mut ranked: Vec<&Grasp> = self.list.iter().filter(|g| g.quality() > 0.0).collect();
        ranked.sort_by(|a, b| b.quality().total_cmp(&a.quality()));
        ranked.truncate(count);
        ranked
    }

    /// All grasps, in the order in which they were found.
    pub fn iter(&self) -> impl Iterator<Item = &Grasp> {
        self.list.iter()
    }

    /// Number of grasps.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there is no grasp.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The outcomes of the hand poses, if poses were tried.
    pub fn outcomes(&self) -> Option<&OutcomeCounts> {
        self.outcomes.as_ref()
    }
}

/// Force-closed grasps: those with a hand first, and the best first among both kinds. Equal ones stay in
/// the order in which they were found.
pub fn ranked(mut grasps: Vec<Grasp>) -> Vec<Grasp> {
    grasps.retain(|g| g.quality() > 0.0);
    let without_hand = |g: &Grasp| g.hand().is_none();
    grasps.sort_by(|a, b| {
        let by_hand = without_hand(a).cmp(&without_hand(b));
        by_hand.then_with(|| b.quality().total_cmp(&a.quality()))
    });
    grasps
}
