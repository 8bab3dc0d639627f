//! Conventions of grasp quality as named values: every system prints another number for one grasp.

use crate::contact::Contact;
use nalgebra::{Point3, Unit, UnitVector3, Vector3};
use thiserror::Error;

/// How long the edges of a friction cone are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeNorm {
    /// f = n + μ(…): the component along the normal is 1.
    UnitNormalComponent,
    /// The same edge divided by its length √(1+μ²).
    UnitLength,
}

/// The length by which torques are divided to become comparable with forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TorqueLength {
    /// A fixed length in metres, positive.
    Metres(f64),
    /// The largest distance of a contact from the centre. To reproduce systems that use the object's
    /// largest vertex distance, pass that distance as `Metres`.
    MaxContactDistance,
}

impl TorqueLength {
    /// The length in metres for these contacts about `centre`.
    pub fn resolve(
        &self,
        contacts: &[Contact],
        centre: &Point3<f64>,
    ) -> Result<f64, ConventionError> {
        let value = match *self {
            TorqueLength::Metres(value) => value,
            TorqueLength::MaxContactDistance => contacts
                .iter()
                .map(|c| (c.position - centre).norm())
                .fold(0.0, f64::max),
        };
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else {
            Err(ConventionError::TorqueLength { value })
        }
    }
}

/// Which point a caller who knows the object puts into `Grasp::centre`.
///
/// This crate knows no surface: it takes the centre of the grasp as it is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CentreRule {
    /// The mean of the point cloud.
    CloudMean,
    /// The centre of mass of the solid.
    CentreOfMass,
    /// The origin of the object's frame.
    ObjectOrigin,
    /// The centre that the grasp carries.
    Given,
}

/// How a friction cone is represented.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edges {
    /// A pyramid of this many edges, three or more, inscribed in the round cone.
    Polygon(usize),
    /// The round cone itself; results are intervals of at most this width (in units of quality).
    Round {
        /// The width at which the search may stop, positive.
        tolerance: f64,
    },
}

/// Where the first edge of a pyramid points: quality depends on it, since pyramids have a phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TangentRule {
    /// Along the projection of the coordinate axis least aligned with the normal (`tangent`).
    LeastAligned,
    /// Along the projection of a fixed vector; `LeastAligned` where it is parallel to the normal.
    /// FRoGGeR projects (1.2, 2.3, 3.4).
    Projected(Vector3<f64>),
}

impl TangentRule {
    /// The vector whose projection the tangent is.
    pub(crate) fn axis(&self, normal: &UnitVector3<f64>) -> Vector3<f64> {
        match *self {
            TangentRule::Projected(axis) if normal.cross(&axis).norm() > 1e-6 * axis.norm() => axis,
            _ => Vector3::ith(normal.iamin(), 1.0),
        }
    }

    /// The discontinuities of the tangent around the normal `side`, evaluated at `normal`.
    ///
    /// Each is a function of the normal that is ≥ 0 on the side of `side` and 0 where the tangent
    /// jumps, given as its value and its gradient at `normal`. `LeastAligned` jumps where two
    /// components of the normal are equally small; `Projected` has a single singular normal and no
    /// such surface.
    pub fn discontinuities(
        &self,
        side: &UnitVector3<f64>,
        normal: &UnitVector3<f64>,
    ) -> impl Iterator<Item = (f64, Vector3<f64>)> + use<> {
        let n = normal.into_inner();
        let least = side.iamin();
        let others = match self {
            TangentRule::LeastAligned => 0..3,
            TangentRule::Projected(_) => 0..0,
        };
        others.filter(move |k| *k != least).map(move |k| {
            let mut slope = Vector3::zeros();
            slope[k] = n[k].signum();
            slope[least] = -n[least].signum();
            (n[k].abs() - n[least].abs(), slope)
        })
    }

    /// How much rounding the projection amplifies: the vector's length over that of its projection.
    pub(crate) fn condition(&self, normal: &UnitVector3<f64>) -> f64 {
        let axis = self.axis(normal);
        axis.norm() / (axis - normal.into_inner() * normal.dot(&axis)).norm()
    }

    /// The unit tangent at a normal.
    pub fn tangent(&self, normal: &UnitVector3<f64>) -> UnitVector3<f64> {
        let axis = self.axis(normal);
        let n = normal.into_inner();
        Unit::new_normalize(axis - n * n.dot(&axis))
    }
}

/// Everything that turns contacts into a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Convention {
    /// The name under which results are reported.
    pub name: String,
    /// The length of cone edges.
    pub edge_norm: EdgeNorm,
    /// The divisor of torques.
    pub torque_length: TorqueLength,
    /// The point that callers put into `Grasp::centre`.
    pub centre: CentreRule,
    /// The friction coefficient μ > 0.
    pub friction: f64,
    /// The representation of the friction cone.
    pub edges: Edges,
    /// Where the first edge of each pyramid points.
    pub tangent: TangentRule,
    /// The number printed for a grasp that is not force-closed.
    pub not_closed: f64,
    /// The quality from which a grasp counts as stable. The paper's 0.01 belongs to `paper` alone,
    /// since every convention has a scale of its own; 0 under the others: stable means closed.
    pub stable_above: f64,
}

/// The quality from which the paper counts a grasp as stable (Sec. IV-E), in its own scale.
const PAPER_STABLE_ABOVE: f64 = 0.01;

impl Convention {
    /// The names that `Convention::named` knows.
    pub const NAMES: [&'static str; 6] =
        ["paper", "graspit", "dexnet", "frogger", "openrave", "unit"];

    /// Our reading of Grasp Moduli Spaces (ICRA 2014), which states none of these numbers: μ = 1, ten
    /// edges of unit normal component, torques in centimetres about the mean of the cloud. A grasp is
    /// stable from a quality of 0.01 (Sec. IV-E).
    pub fn paper() -> Self {
        let torque_length = TorqueLength::Metres(0.01);
        Convention {
            stable_above: PAPER_STABLE_ABOVE,
            ..Self::of("paper", torque_length, CentreRule::CloudMean, 1.0, 10)
        }
    }

    /// `GraspIt!`: torques over the largest distance from the centre of mass, eight edges, −1 when not
    /// closed. Its μ comes from a table of materials; this is rubber on plastic (1.0).
    pub fn graspit() -> Self {
        let torque_length = TorqueLength::MaxContactDistance;
        Convention {
            not_closed: -1.0,
            ..Self::of("graspit", torque_length, CentreRule::CentreOfMass, 1.0, 8)
        }
    }

    /// Dex-Net: torques in millimetres about the centre of mass, μ = 0.5, eight edges.
    pub fn dexnet() -> Self {
        let torque_length = TorqueLength::Metres(1e-3);
        Self::of("dexnet", torque_length, CentreRule::CentreOfMass, 0.5, 8)
    }

    /// `FRoGGeR`: edges of unit length, torques in metres about the object's origin, μ = 0.7, four
    /// edges, −1 when not closed.
    pub fn frogger() -> Self {
        let torque_length = TorqueLength::Metres(1.0);
        Convention {
            edge_norm: EdgeNorm::UnitLength,
            not_closed: -1.0,
            ..Self::of("frogger", torque_length, CentreRule::ObjectOrigin, 0.7, 4)
        }
    }

    /// `OpenRAVE`: edges of unit length, torques in metres about the object's origin, μ = 0.4, eight
    /// edges.
    pub fn openrave() -> Self {
        let torque_length = TorqueLength::Metres(1.0);
        Convention {
            edge_norm: EdgeNorm::UnitLength,
            ..Self::of("openrave", torque_length, CentreRule::ObjectOrigin, 0.4, 8)
        }
    }

    /// No scaling at all: edges of unit normal component, torques in metres about the centre that the
    /// grasp carries; μ = 1 and eight edges until told otherwise.
    pub fn unit() -> Self {
        let torque_length = TorqueLength::Metres(1.0);
        Self::of("unit", torque_length, CentreRule::Given, 1.0, 8)
    }

    fn of(
        name: &str,
        torque_length: TorqueLength,
        centre: CentreRule,
        friction: f64,
        edges: usize,
    ) -> Self {
        Convention {
            name: name.to_owned(),
            edge_norm: EdgeNorm::UnitNormalComponent,
            torque_length,
            centre,
            friction,
            edges: Edges::Polygon(edges),
            tangent: TangentRule::LeastAligned,
            not_closed: 0.0,
            stable_above: 0.0,
        }
    }

    /// A convention by one of [`Convention::NAMES`].
    ///
    /// All begin their edges by [`TangentRule::LeastAligned`], so that one file of grasps means one
    /// set of edges; the systems' own frames differ from it in the phase of the pyramids.
    ///
    /// # Errors
    /// A name that is none of these.
    pub fn named(name: &str) -> Result<Self, UnknownConvention> {
        match name {
            "paper" => Ok(Self::paper()),
            "graspit" => Ok(Self::graspit()),
            "dexnet" => Ok(Self::dexnet()),
            "frogger" => Ok(Self::frogger()),
            "openrave" => Ok(Self::openrave()),
            "unit" => Ok(Self::unit()),
            _ => Err(UnknownConvention {
                name: name.to_owned(),
            }),
        }
    }

    /// The same convention with torques per `metres`.
    ///
    /// A threshold of stability belongs to a scale of torques: under another one a grasp counts as
    /// stable when it is closed.
    pub fn with_torque_length(self, metres: f64) -> Self {
        let torque_length = TorqueLength::Metres(metres);
        let stable_above = if torque_length == self.torque_length {
            self.stable_above
        } else {
            0.0
        };
        Self {
            torque_length,
            stable_above,
            ..self
        }
    }

    /// Whether a grasp of this quality counts as stable: closed, and not below
    /// [`Convention::stable_above`]. For an interval, pass its proved lower end.
    pub fn is_stable(&self, quality: f64) -> bool {
        quality > 0.0 && quality >= self.stable_above
    }

    /// Checks friction, edges and a fixed torque length.
    pub fn validate(&self) -> Result<(), ConventionError> {
        if !(self.friction.is_finite() && self.friction > 0.0) {
            return Err(ConventionError::Friction {
                value: self.friction,
            });
        }
        match self.edges {
            Edges::Polygon(count) if !(3..=MAX_EDGES).contains(&count) => {
                return Err(ConventionError::Edges { count });
            }
            Edges::Round { tolerance } if !(tolerance.is_finite() && tolerance > 0.0) => {
                return Err(ConventionError::Tolerance { value: tolerance });
            }
            _ => {}
        }
        if let TangentRule::Projected(axis) = self.tangent
            && !(axis.iter().all(|x| x.is_finite()) && axis.norm() > 0.0)
        {
            return Err(ConventionError::Tangent { axis });
        }
        match self.torque_length {
            TorqueLength::Metres(value) if !(value.is_finite() && value > 0.0) => {
                Err(ConventionError::TorqueLength { value })
            }
            _ => Ok(()),
        }
    }
}

/// The most edges per contact; beyond it the round cone is the better choice.
pub(crate) const MAX_EDGES: usize = 1024;

/// A name that is none of `Convention::NAMES`.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("unknown convention {name:?}; known: paper, graspit, dexnet, frogger, openrave, unit")]
pub struct UnknownConvention {
    /// The name given.
    pub name: String,
}

/// A convention with a number out of range.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ConventionError {
    /// Friction not finite and positive.
    #[error("friction coefficient {value}: must be finite and positive")]
    Friction {
        /// The coefficient given.
        value: f64,
    },
    /// Too few or too many edges.
    #[error("{count} edges per friction cone: must be between 3 and {MAX_EDGES}")]
    Edges {
        /// The edges given.
        count: usize,
    },
    /// A tolerance of the round cone that is not finite and positive.
    #[error("tolerance {value} of the round cone: must be finite and positive")]
    Tolerance {
        /// The tolerance given.
        value: f64,
    },
    /// A tangent rule with a vector that is zero or not finite.
    #[error("tangent rule: the vector {axis:?} must be finite and not zero")]
    Tangent {
        /// The vector given.
        axis: Vector3<f64>,
    },
    /// A torque length that is not finite and positive (or all contacts lie at the centre).
    #[error("torque length {value}: must be finite and positive")]
    TorqueLength {
        /// The length found.
        value: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_known_and_valid() {
        for name in Convention::NAMES {
            let convention = Convention::named(name).unwrap();
            assert_eq!(convention.name, name);
            assert_eq!(convention.validate(), Ok(()));
        }
        let error = Convention::named("grasp-it").unwrap_err();
        for name in Convention::NAMES {
            assert!(error.to_string().contains(name));
        }
    }

    #[test]
    fn refuses_numbers_out_of_range() {
        let unit = Convention::unit();
        for friction in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let bad = Convention {
                friction,
                ..unit.clone()
            };
            assert!(matches!(
                bad.validate(),
                Err(ConventionError::Friction { .. })
            ));
        }
        let bad = Convention {
            edges: Edges::Polygon(2),
            ..unit.clone()
        };
        assert_eq!(bad.validate(), Err(ConventionError::Edges { count: 2 }));
        let bad = Convention {
            edges: Edges::Round { tolerance: 0.0 },
            ..unit.clone()
        };
        assert_eq!(
            bad.validate(),
            Err(ConventionError::Tolerance { value: 0.0 })
        );
        let bad = Convention {
            torque_length: TorqueLength::Metres(-0.01),
            ..unit
        };
        assert_eq!(
            bad.validate(),
            Err(ConventionError::TorqueLength { value: -0.01 })
        );
    }
}
