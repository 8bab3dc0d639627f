//! The contacts of a hand whose pose and joints are given.

use grasp::Contact;
use hand::{CollisionObject, Hand, KinematicsError, tip_contact};
use nalgebra::Isometry3;

use crate::error::Error;
use crate::object::Object;

/// Steps by which a finger that is inside the object is opened, metres, and their largest number.
const STEP: f64 = 5e-4;
const MOST_STEPS: usize = 40;

/// An object prepared for the contacts of hands whose pose and joints are given.
pub struct HandContacts<'a> {
    object: &'a Object,
    collision: CollisionObject<'a>,
    hand: &'a Hand,
}

/// The contacts that a hand makes, in the frame of the cloud.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundContacts {
    /// One contact per finger whose tip is at the surface.
    pub contacts: Vec<Contact>,
    /// Names of the fingers without a contact, and why.
    pub without: Vec<(String, NoContact)>,
}

/// Why a finger makes no contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoContact {
    /// The tip is so far from the surface, metres.
    Away(f64),
    /// The tip is deep inside the object.
    Inside,
    /// The surface there closes a hole of the object, so that there is nothing to touch.
    ClosedHole,
}

impl<'a> HandContacts<'a> {
    /// Tips nearer to the surface than this make a contact, metres.
    pub const REACH: f64 = 5e-3;

    /// Prepares an object and a hand.
    ///
    /// # Errors
    /// The surface is too rough for the collision model.
    pub fn new(object: &'a Object, hand: &'a Hand) -> Result<Self, Error> {
        Ok(Self {
            object,
            collision: CollisionObject::new(object.field()).map_err(hand::SynthesisError::from)?,
            hand,
        })
    }

    /// For each finger the point of the surface that is nearest to its tip, if it is within
    /// [`Self::REACH`]. A finger that is inside the object is opened first, by 2 cm at most, until its
    /// tip is outside: joint values of a grasp command a position inside the object, against which the
    /// finger presses.
    ///
    /// `cloud_from_palm` is the pose of the hand's root link in the frame of the cloud; `joints` has one
    /// value per driven joint.
    ///
    /// # Errors
    /// The number of joint values is wrong, or one is not finite.
    pub fn of(
        &self,
        cloud_from_palm: &Isometry3<f64>,
        joints: &[f64],
    ) -> Result<FoundContacts, KinematicsError> {
        let frame = self.object.frame();
        let centred_from_palm = frame.pose_to_centred(cloud_from_palm);
        let mut found = FoundContacts {
            contacts: Vec::new(),
            without: Vec::new(),
        };
        for (index, finger) in self.hand.fingers().iter().enumerate() {
            let group = self
                .hand
                .groups()
                .iter()
                .find(|g| g.fingers.contains(&index));
            let unit = group.map_or(0.0, |g| STEP / g.largest_speed());
            let mut touch = None;
            for step in 0..=MOST_STEPS {
                let opening = step as f64 * unit;
                let mut opened = joints.to_vec();
                for &(joint, rate) in group.iter().flat_map(|g| &g.closing) {
                    opened[joint] -= rate * opening;
                }
                let links = self.hand.model().root_from_links(&opened)?;
                let placed: Vec<_> = links.iter().map(|l| centred_from_palm * l).collect();
                touch = tip_contact(&self.collision, self.hand, finger, &placed);
                if touch.is_some() {
                    break;
                }
            }
            match touch {
                Some(touch) if self.collision.is_closed_hole(&touch.position) => {
                    found
                        .without
                        .push((finger.name.clone(), NoContact::ClosedHole));
                }
                Some(touch) if touch.gap <= Self::REACH => found.contacts.push(Contact {
                    position: frame.to_cloud(&touch.position),
                    inward_normal: touch.inward_normal,
                }),
                other => {
                    let why = other.map_or(NoContact::Inside, |touch| NoContact::Away(touch.gap));
                    found.without.push((finger.name.clone(), why));
                }
            }
        }
        Ok(found)
    }
}
