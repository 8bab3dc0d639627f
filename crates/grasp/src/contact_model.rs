//! What a contact can transmit: a normal force, friction, and torsion about the normal.

use thiserror::Error;

/// The forces that one contact can transmit for a unit normal force.
///
/// Which systems mean which: `GraspIt!` has all but the patch (its soft fingers take the torsion from
/// the pad's curvature, here it is given); Dex-Net has point and soft contacts (torsion coefficient
/// 0.001 m for its metrics); `FRoGGeR`, `OpenRAVE` and the paper have point contacts. A convention
/// carries no contact model: [`GraspModel::with_contact_models`](crate::GraspModel::with_contact_models)
/// adds one to any of them.
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
    /// A stiff square pad, at the four corners of which point contacts share the force: they lie at
    /// `radius` from the contact along ±t and ±n×t, with t the convention's tangent, and press along
    /// the contact's own normal. Corners that lie on a curved surface, or other footprints, are plain
    /// contacts: the hull of a grasp does not ask which contacts belong together.
    Patch {
        /// The friction coefficient μ > 0.
        friction: f64,
        /// The distance of each corner from the contact, positive, in the unit of the positions.
        radius: f64,
    },
}

impl ContactModel {
    /// A soft contact of a disc of this radius under even pressure: γ = 2/3 μ r.
    ///
    /// That is the torsion ∫ μ p ρ dA of the whole disc slipping, p = f_n/(π r²).
    pub fn soft_disc(friction: f64, radius: f64) -> Self {
        ContactModel::Soft {
            friction,
            torsion: 2.0 / 3.0 * friction * radius,
        }
    }

    /// The friction coefficient, 0 without friction.
    pub fn friction(&self) -> f64 {
        self.limits().0
    }

    pub(crate) fn validate(&self, index: usize) -> Result<(), ContactModelError> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        match *self {
            ContactModel::Point { friction }
            | ContactModel::Soft { friction, .. }
            | ContactModel::Patch { friction, .. }
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
            ContactModel::Patch { radius, .. } if !positive(radius) => {
                Err(ContactModelError::Radius {
                    index,
                    value: radius,
                })
            }
            _ => Ok(()),
        }
    }

    /// How many ellipsoids of wrenches a contact has, each from a point of its own.
    pub(crate) fn points(&self) -> usize {
        match self {
            ContactModel::Patch { .. } => 4,
            _ => 1,
        }
    }

    /// Where the point with this number lies, along the tangent and the binormal.
    pub(crate) fn place(&self, point: usize) -> [f64; 2] {
        match *self {
            ContactModel::Patch { radius, .. } => {
                let sign = if point < 2 { radius } else { -radius };
                if point.is_multiple_of(2) {
                    [sign, 0.0]
                } else {
                    [0.0, sign]
                }
            }
            _ => [0.0, 0.0],
        }
    }

    /// μ and γ, 0 where there is none.
    pub(crate) fn limits(&self) -> (f64, f64) {
        match *self {
            ContactModel::Frictionless => (0.0, 0.0),
            ContactModel::Point { friction } => (friction, 0.0),
            ContactModel::Soft { friction, torsion } => (friction, torsion),
            ContactModel::Patch { friction, .. } => (friction, 0.0),
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
    /// A radius of a patch that is not finite and positive.
    #[error("contact {index}: patch radius {value} must be finite and positive")]
    Radius {
        /// The contact, from 0.
        index: usize,
        /// The radius given.
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
