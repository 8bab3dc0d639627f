//! Contacts of a hand with an object, and the grasp that they form.

use nalgebra::{Point3, UnitVector3};
use thiserror::Error;

/// How far from 1 the length of a normal may be before it is refused.
const UNIT_TOLERANCE: f64 = 1e-6;

/// A point of the object's surface where a finger presses along the inward normal.
///
/// Position in metres (or any length that the convention's torque length shares), in the frame of
/// the object; the normal points into the object and has unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Where the finger touches.
    pub position: Point3<f64>,
    /// The unit normal that points into the object.
    pub inward_normal: UnitVector3<f64>,
}

impl Contact {
    /// Checks one contact; `index` only names it in the error.
    pub fn validate(&self, index: usize) -> Result<(), ContactError> {
        if !self.position.coords.iter().all(|x| x.is_finite()) {
            return Err(ContactError::PositionNotFinite {
                index,
                value: self.position,
            });
        }
        let length = self.inward_normal.norm();
        // Written so that NaN fails too.
        if (length - 1.0).abs() <= UNIT_TOLERANCE {
            Ok(())
        } else {
            Err(ContactError::NormalNotUnit { index, length })
        }
    }
}

/// Two or more contacts and the point about which torques are taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Grasp {
    /// The contacts, in the order of the fingers.
    pub contacts: Vec<Contact>,
    /// The point z of the torque (c − z) × f, in the frame of the contacts.
    pub centre: Point3<f64>,
}

impl Grasp {
    /// A grasp of checked contacts about a finite centre.
    pub fn new(contacts: Vec<Contact>, centre: Point3<f64>) -> Result<Self, ContactError> {
        let grasp = Grasp { contacts, centre };
        grasp.validate()?;
        Ok(grasp)
    }

    /// Checks the number of contacts, every contact and the centre.
    pub fn validate(&self) -> Result<(), ContactError> {
        validate(&self.contacts, &self.centre)
    }
}

/// Checks the number of contacts, every contact and the centre.
pub(crate) fn validate(contacts: &[Contact], centre: &Point3<f64>) -> Result<(), ContactError> {
    if contacts.len() < 2 {
        return Err(ContactError::TooFew {
            count: contacts.len(),
        });
    }
    if !centre.coords.iter().all(|x| x.is_finite()) {
        return Err(ContactError::CentreNotFinite { value: *centre });
    }
    contacts
        .iter()
        .enumerate()
        .try_for_each(|(index, contact)| contact.validate(index))
}

/// Why contacts do not form a grasp.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ContactError {
    /// Fewer than two contacts.
    #[error("a grasp needs two contacts or more, this one has {count}")]
    TooFew {
        /// The contacts given.
        count: usize,
    },
    /// A position with NaN or infinity.
    #[error("contact {index}: position {value} is not finite")]
    PositionNotFinite {
        /// The contact, from 0.
        index: usize,
        /// The position given.
        value: Point3<f64>,
    },
    /// A normal whose length is not 1 (zero and NaN included).
    #[error("contact {index}: the normal has length {length}, not 1")]
    NormalNotUnit {
        /// The contact, from 0.
        index: usize,
        /// The length of the normal given.
        length: f64,
    },
    /// A centre with NaN or infinity.
    #[error("the centre {value} is not finite")]
    CentreNotFinite {
        /// The centre given.
        value: Point3<f64>,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Unit, Vector3};

    fn contact(x: f64, length: f64) -> Contact {
        Contact {
            position: Point3::new(x, 0.0, 0.0),
            inward_normal: Unit::new_unchecked(Vector3::new(length, 0.0, 0.0)),
        }
    }

    #[test]
    fn names_what_is_wrong() {
        let good = contact(1.0, 1.0);
        assert!(Grasp::new(vec![good, good], Point3::origin()).is_ok());
        assert_eq!(
            Grasp::new(vec![good], Point3::origin()),
            Err(ContactError::TooFew { count: 1 })
        );
        assert_eq!(
            Grasp::new(vec![good, contact(0.0, 0.5)], Point3::origin()),
            Err(ContactError::NormalNotUnit {
                index: 1,
                length: 0.5
            })
        );
        assert!(matches!(
            Grasp::new(vec![good, contact(f64::NAN, 1.0)], Point3::origin()),
            Err(ContactError::PositionNotFinite { index: 1, .. })
        ));
        assert!(matches!(
            Grasp::new(vec![good, contact(0.0, f64::NAN)], Point3::origin()),
            Err(ContactError::NormalNotUnit { index: 1, .. })
        ));
        assert!(matches!(
            Grasp::new(vec![good, good], Point3::new(0.0, f64::INFINITY, 0.0)),
            Err(ContactError::CentreNotFinite { .. })
        ));
    }
}
