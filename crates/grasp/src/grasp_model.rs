//! A grasp together with everything that decides its wrenches, borrowed from the caller.

use nalgebra::Point3;

use crate::contact::{self, Contact, Grasp};
use crate::contact_model::{ContactModel, ContactModelError};
use crate::convention::{Convention, EdgeNorm};
use crate::wrench::WrenchError;

/// A grasp ready to be measured: contacts, centre, contact models and the convention.
///
/// Every measure of this crate takes one: [`Grasp::under`] and [`GraspModel::new`] make it for point
/// contacts with the convention's friction, [`GraspModel::with_contact_models`] for any others.
#[derive(Clone, Copy, Debug)]
pub struct GraspModel<'a> {
    /// Two or more contacts.
    pub contacts: &'a [Contact],
    /// The point about which torques are taken.
    pub centre: &'a Point3<f64>,
    /// How wrenches are made and measured.
    pub convention: &'a Convention,
    /// One model per contact; if empty, point contacts with the convention's friction.
    pub contact_models: &'a [ContactModel],
}

impl Grasp {
    /// The grasp as a model of point contacts with the convention's friction.
    pub fn under<'a>(&'a self, convention: &'a Convention) -> GraspModel<'a> {
        GraspModel::new(&self.contacts, &self.centre, convention)
    }
}

impl<'a> GraspModel<'a> {
    /// Point contacts with the convention's friction.
    pub fn new(
        contacts: &'a [Contact],
        centre: &'a Point3<f64>,
        convention: &'a Convention,
    ) -> Self {
        GraspModel {
            contacts,
            centre,
            convention,
            contact_models: &[],
        }
    }

    /// The same grasp with one contact model per contact.
    #[must_use]
    pub fn with_contact_models(self, contact_models: &'a [ContactModel]) -> Self {
        GraspModel {
            contact_models,
            ..self
        }
    }

    /// Checks everything and resolves the torque length.
    pub(crate) fn validate(&self) -> Result<f64, WrenchError> {
        contact::validate(self.contacts, self.centre)?;
        self.convention.validate()?;
        let (contacts, models) = (self.contacts.len(), self.contact_models.len());
        if models != 0 && models != contacts {
            return Err(ContactModelError::Count { contacts, models }.into());
        }
        for (index, model) in self.contact_models.iter().enumerate() {
            model.validate(index)?;
        }
        let length = self.convention.torque_length;
        Ok(length.resolve(self.contacts, self.centre)?)
    }

    /// The model of a contact.
    pub fn contact_model(&self, contact: usize) -> ContactModel {
        let point = ContactModel::Point {
            friction: self.convention.friction,
        };
        self.contact_models.get(contact).copied().unwrap_or(point)
    }

    /// The scale of a contact's wrenches: 1, or 1/√(1+μ²) for edges of unit length.
    pub(crate) fn edge_scale(&self, contact: usize) -> f64 {
        match self.convention.edge_norm {
            EdgeNorm::UnitNormalComponent => 1.0,
            EdgeNorm::UnitLength => 1.0 / self.contact_model(contact).limits().0.hypot(1.0),
        }
    }
}
