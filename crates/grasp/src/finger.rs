//! What a contact can transmit: frictionless, with friction, or with friction and torsion.

use crate::contact::{self, Contact};
use crate::convention::{Convention, EdgeNorm};
use crate::hull::plane::{V6, add_scaled, dot, norm, scale};
use crate::hull::support::Support;
use crate::wrench::WrenchError;
use nalgebra::{Point3, Vector3};
use thiserror::Error;

/// The forces that one contact can transmit for a unit normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finger {
    /// The normal force alone.
    Frictionless,
    /// A point contact with Coulomb friction: |f_t| ≤ μ f_n.
    Hard {
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

impl Finger {
    fn validate(&self, index: usize) -> Result<(), FingerError> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        match *self {
            Finger::Hard { friction } | Finger::Soft { friction, .. } if !positive(friction) => {
                Err(FingerError::Friction {
                    index,
                    value: friction,
                })
            }
            Finger::Soft { torsion, .. } if !positive(torsion) => Err(FingerError::Torsion {
                index,
                value: torsion,
            }),
            _ => Ok(()),
        }
    }

    /// μ and γ, 0 where there is none.
    pub(crate) fn limits(&self) -> (f64, f64) {
        match *self {
            Finger::Frictionless => (0.0, 0.0),
            Finger::Hard { friction } => (friction, 0.0),
            Finger::Soft { friction, torsion } => (friction, torsion),
        }
    }
}

/// A grasp ready to be measured: contacts, the centre, the convention, and the fingers if they
/// differ from the convention's hard finger.
#[derive(Clone, Copy, Debug)]
pub struct Setup<'a> {
    /// Two or more contacts.
    pub contacts: &'a [Contact],
    /// The point about which torques are taken.
    pub centre: &'a Point3<f64>,
    /// How wrenches are made and measured.
    pub convention: &'a Convention,
    /// One finger a contact, or none at all: hard fingers with the convention's friction.
    pub fingers: &'a [Finger],
}

impl Setup<'_> {
    /// Checks everything and resolves the torque length.
    pub(crate) fn validate(&self) -> Result<f64, WrenchError> {
        contact::validate(self.contacts, self.centre)?;
        self.convention.validate()?;
        if !self.fingers.is_empty() && self.fingers.len() != self.contacts.len() {
            return Err(WrenchError::Finger(FingerError::Count {
                contacts: self.contacts.len(),
                fingers: self.fingers.len(),
            }));
        }
        for (index, finger) in self.fingers.iter().enumerate() {
            finger.validate(index)?;
        }
        let length = self.convention.torque_length;
        Ok(length.resolve(self.contacts, self.centre)?)
    }

    /// The finger of a contact.
    pub fn finger(&self, contact: usize) -> Finger {
        self.fingers.get(contact).copied().unwrap_or(Finger::Hard {
            friction: self.convention.friction,
        })
    }

    /// The scale of a contact's wrenches: 1, or 1/√(1+μ²) for edges of unit length.
    pub(crate) fn edge_scale(&self, contact: usize) -> f64 {
        match self.convention.edge_norm {
            EdgeNorm::UnitNormalComponent => 1.0,
            EdgeNorm::UnitLength => 1.0 / self.finger(contact).limits().0.hypot(1.0),
        }
    }
}

/// Why fingers do not fit a grasp.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum FingerError {
    /// Another number of fingers than of contacts.
    #[error("{contacts} contacts but {fingers} fingers")]
    Count {
        /// The contacts given.
        contacts: usize,
        /// The fingers given.
        fingers: usize,
    },
    /// A friction coefficient that is not finite and positive.
    #[error("finger {index}: friction coefficient {value} must be finite and positive")]
    Friction {
        /// The finger, from 0.
        index: usize,
        /// The coefficient given.
        value: f64,
    },
    /// A torsional limit that is not finite and positive.
    #[error("finger {index}: torsional limit {value} must be finite and positive")]
    Torsion {
        /// The finger, from 0.
        index: usize,
        /// The limit given.
        value: f64,
    },
}

/// The wrenches of one contact at unit normal force: the ellipsoid base + Σ a_k axis_k, |a| ≤ 1,
/// with two axes of friction and one of torsion (zero where there is none).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    pub(crate) contact: u32,
    pub(crate) base: V6,
    pub(crate) axes: [V6; 3],
}

impl Cone {
    pub(crate) fn new(setup: &Setup<'_>, contact: usize, length: f64) -> Self {
        let Contact {
            position,
            inward_normal,
        } = &setup.contacts[contact];
        let (friction, torsion) = setup.finger(contact).limits();
        let unit = setup.edge_scale(contact);
        let arm = position - setup.centre;
        let of_force = |f: Vector3<f64>| {
            let t = arm.cross(&f) / length;
            [f.x, f.y, f.z, t.x, t.y, t.z]
        };
        let n = inward_normal.into_inner() * unit;
        let t = setup.convention.tangent.tangent(inward_normal).into_inner();
        let b = inward_normal.cross(&t);
        let twist = n * (torsion / length);
        Cone {
            contact: contact as u32,
            base: of_force(n),
            axes: [
                of_force(t * (unit * friction)),
                of_force(b * (unit * friction)),
                [0.0, 0.0, 0.0, twist.x, twist.y, twist.z],
            ],
        }
    }

    /// The farthest point of the ellipsoid along `direction`, and its height.
    #[inline]
    pub(crate) fn farthest(&self, direction: &V6) -> (V6, f64) {
        let slopes = self.axes.map(|axis| dot(&axis, direction));
        let length = (slopes[0] * slopes[0] + slopes[1] * slopes[1] + slopes[2] * slopes[2]).sqrt();
        let height = dot(&self.base, direction) + length;
        if length == 0.0 {
            return (self.base, height);
        }
        let mut point = self.base;
        for (axis, slope) in self.axes.iter().zip(slopes) {
            point = add_scaled(&point, slope / length, axis);
        }
        (point, height)
    }

    /// The height of the farthest point alone.
    #[inline]
    fn height(&self, direction: &V6) -> f64 {
        let slopes = self.axes.map(|axis| dot(&axis, direction));
        let square = slopes[0] * slopes[0] + slopes[1] * slopes[1] + slopes[2] * slopes[2];
        dot(&self.base, direction) + square.sqrt()
    }

    /// No point of the ellipsoid is longer.
    pub(crate) fn reach(&self) -> f64 {
        let square: f64 = self.axes.iter().map(|a| dot(a, a)).sum();
        norm(&self.base) + square.sqrt()
    }

    /// The corners of the inscribed polytope: an edge for each pair (cos, sin) of `circle`, and the
    /// two poles of torsion.
    pub(crate) fn corners<'a>(&'a self, circle: &'a [(f64, f64)]) -> impl Iterator<Item = V6> + 'a {
        let [t, b, twist] = &self.axes;
        let no_friction = dot(t, t) == 0.0;
        let edges = circle
            .iter()
            .take(if no_friction { 1 } else { circle.len() })
            .map(move |&(cos, sin)| add_scaled(&add_scaled(&self.base, cos, t), sin, b));
        let poles = [1.0, -1.0]
            .into_iter()
            .take(if dot(twist, twist) == 0.0 { 0 } else { 2 })
            .map(move |sign| add_scaled(&self.base, sign, twist));
        edges.chain(poles)
    }
}

/// The hull of several round cones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundSource<'a>(pub(crate) &'a [Cone]);

impl Support for RoundSource<'_> {
    fn support(&mut self, direction: &V6) -> (V6, u32) {
        let mut best = (0, f64::NEG_INFINITY);
        for (i, cone) in self.0.iter().enumerate() {
            let height = cone.height(direction);
            if height > best.1 {
                best = (i, height);
            }
        }
        let cone = &self.0[best.0];
        (cone.farthest(direction).0, cone.contact)
    }
}

/// A direction in which points of round cones lie.
pub(crate) fn toward(cones: &[Cone]) -> V6 {
    cones
        .iter()
        .fold([0.0; 6], |s, c| add_scaled(&s, 1.0, &scale(&c.base, 1.0)))
}
