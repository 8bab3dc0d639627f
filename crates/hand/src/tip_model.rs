//! What the contact of a fingertip transmits.

use grasp::ContactModel;

/// What the contacts of a hand's tips transmit, apart from the friction coefficient, which a
/// convention says.
///
/// Two point contacts never resist a torque about the line between them, so the grasps of a hand of
/// two fingers need one of the others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TipModel {
    /// A hard point with Coulomb friction.
    #[default]
    Point,
    /// A soft finger: a disc under even pressure, which resists torsion too
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

    /// One model per contact; none for points, which every convention has already.
    pub fn of_contacts(&self, friction: f64, contacts: usize) -> Vec<ContactModel> {
        match self {
            TipModel::Point => Vec::new(),
            _ => vec![self.contact_model(friction); contacts],
        }
    }
}
