//! Contact models of fingertips.

use grasp::ContactModel;

/// The contact model of a hand's tips without the friction coefficient, which the convention gives.
///
/// Two point contacts resist no torque about the line between them, so grasps of a hand with two
/// fingers need one of the other models.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TipModel {
    /// A hard point with Coulomb friction.
    #[default]
    Point,
    /// A soft finger: a disc under uniform pressure, which also resists torsion
    /// ([`ContactModel::soft_disc`]).
    Soft {
        /// Radius of the disc, metres.
        radius: f64,
    },
    /// A stiff square pad ([`ContactModel::Patch`]).
    Patch {
        /// Distance of each corner from the contact, metres.
        radius: f64,
    },
}

impl TipModel {
    /// The contact model under a friction coefficient.
    pub fn contact_model(&self, friction: f64) -> ContactModel {
        match *self {
            TipModel::Point => ContactModel::Point { friction },
            TipModel::Soft { radius } => ContactModel::soft_disc(friction, radius),
            TipModel::Patch { radius } => ContactModel::Patch { friction, radius },
        }
    }

    /// One model per contact; `None` for hard points, the default of every convention.
    pub fn of_contacts(&self, friction: f64, contacts: usize) -> Vec<ContactModel> {
        match self {
            TipModel::Point => Vec::new(),
            _ => vec![self.contact_model(friction); contacts],
        }
    }
}
