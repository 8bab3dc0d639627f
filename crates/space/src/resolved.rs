//! A convention resolved on one surface.

use grasp::{CentreRule, Convention, TorqueLength};
use nalgebra::Point3;
use shape::Surface;
use sph::direction::even_directions;

/// Number of evenly spread points of the surface among which the farthest from the centre is found.
const EXTENT_DIRECTIONS: usize = 2_000;

/// A [`Convention`] resolved on one surface: the centre of torques is a point, and the torque
/// length is in metres.
///
/// A convention is a rule (torques "about the centre of mass", "per largest distance"), and the
/// same rule gives another centre and length on every surface. The types differ, so that a resolved
/// convention cannot be used as the rule on another surface.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedConvention {
    convention: Convention,
    centre: Point3<f64>,
}

impl ResolvedConvention {
    /// Resolves a rule on a surface in the centred frame.
    ///
    /// `object_origin` is the origin of the user's frame in the centred frame, metres; conventions
    /// with [`CentreRule::ObjectOrigin`] and [`CentreRule::Given`] take torques about it. The mean of
    /// the cloud is the origin of the centred frame. A torque length of `MaxContactDistance`
    /// becomes the largest distance of the surface from the centre, as in the systems that use it,
    /// taken over 2,000 evenly spread points.
    pub fn new(rule: &Convention, surface: &impl Surface, object_origin: &Point3<f64>) -> Self {
        let centre = match rule.centre {
            CentreRule::CloudMean => Point3::origin(),
            CentreRule::CentreOfMass => surface.centre_of_mass(),
            CentreRule::ObjectOrigin | CentreRule::Given => *object_origin,
        };
        let mut convention = rule.clone();
        if convention.torque_length == TorqueLength::MaxContactDistance {
            let farthest = even_directions(EXTENT_DIRECTIONS)
                .iter()
                .map(|p| (surface.point(p) - centre).norm())
                .fold(0.0, f64::max);
            convention.torque_length = TorqueLength::Metres(farthest);
        }
        Self { convention, centre }
    }

    /// The convention with its torque length in metres.
    pub fn convention(&self) -> &Convention {
        &self.convention
    }

    /// The point about which torques are taken, centred frame, metres.
    pub fn centre(&self) -> Point3<f64> {
        self.centre
    }

    /// The same with another friction coefficient.
    pub fn with_friction(&self, friction: f64) -> Self {
        let mut other = self.clone();
        other.convention.friction = friction;
        other
    }
}
