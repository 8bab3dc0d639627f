//! What a contact can transmit: a normal force, friction, and torsion about the normal.

use thiserror::Error;

/// The forces that one contact can transmit for a unit normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactModel {
    /// The normal force alone.
    Frictionless,
    /// A point contact with Coulomb friction: |f_t| ≤ μ f_n.
    Point {
        /// The friction coefficient μ > 0.
        friction: f64,
    },
    /// A soft finger with an ellipsoidal limit surface: (|f_t|/μ)² + (τ_n/γ)² ≤ f_n².
    Soft {
        /// The friction coefficient μ > 0.
        friction: f64,
        /// γ > 0: the torsional moment about the normal that a unit normal force holds, in the unit
        /// of length of the positions.
        torsion: f64,
    },
}

impl ContactModel {
    pub(crate) fn validate(&self, index: usize) -> Result<(), ContactModelError> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        match *self {
            ContactModel::Point { friction } | ContactModel::Soft { friction, .. }
                if !positive(friction) =>
            {
                Err(ContactModelError::Friction {
                    index,
                    value: friction,
                })
            }
            ContactModel::Soft { torsion, .. } if !positive(torsion) => {
                Err(ContactModelError::Torsion {
                    index,
                    value: torsion,
                })
            }
            _ => Ok(()),
        }
    }

    /// μ and γ, 0 where there is none.
    pub(crate) fn limits(&self) -> (f64, f64) {
        match *self {
            ContactModel::Frictionless => (0.0, 0.0),
            ContactModel::Point { friction } => (friction, 0.0),
            ContactModel::Soft { friction, torsion } => (friction, torsion),
        }
    }
}

/// Why contact models do not fit a grasp.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ContactModelError {
    /// The number of models differs from the number of contacts.
    #[error("{contacts} contacts but {models} contact models")]
    Count {
        /// The contacts given.
        contacts: usize,
        /// The models given.
        models: usize,
    },
    /// A friction coefficient that is not finite and positive.
    #[error("contact {index}: friction coefficient {value} must be finite and positive")]
    Friction {
        /// The contact, from 0.
        index: usize,
        /// The coefficient given.
        value: f64,
    },
    /// A torsional limit that is not finite and positive.
    #[error("contact {index}: torsional limit {value} must be finite and positive")]
    Torsion {
        /// The contact, from 0.
        index: usize,
        /// The limit given.
        value: f64,
    },
}
