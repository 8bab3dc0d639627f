//! A hand ready for use: the model with its spec resolved and checked.

use nalgebra::{Point3, UnitVector3, Vector3};
use thiserror::Error;

use crate::collision::{ConvexPiece, GeometryError, LinkShape};
use crate::hand_spec::{FingerSpec, HandSpec, PreshapeSpec};
use crate::kinematics::KinematicsError;
use crate::model::{Drive, HandModel, JointKind};

/// A finger of a [`Hand`].
#[derive(Debug, Clone)]
pub struct Finger {
    /// Its name.
    pub name: String,
    /// Links that make the tip.
    pub tip_links: Vec<usize>,
    /// Driven joints that close it with their share of the motion.
    pub closing: Vec<(usize, f64)>,
    /// Links that move when it closes, parents first.
    pub moving_links: Vec<usize>,
    /// For each moving link, a bound on the speed of its points, in metres a unit of closing.
    pub(crate) speed_bounds: Vec<f64>,
}

/// Joint values from which fingers close.
#[derive(Debug, Clone, PartialEq)]
pub struct Preshape {
    /// Its name.
    pub name: String,
    /// One value a driven joint.
    pub joints: Vec<f64>,
}

/// A hand model with its fingers, pre-shapes, collision shapes and tested pairs.
#[derive(Debug, Clone)]
pub struct Hand {
    pub(crate) name: String,
    pub(crate) model: HandModel,
    pub(crate) fingers: Vec<Finger>,
    pub(crate) preshapes: Vec<Preshape>,
    pub(crate) shapes: Vec<LinkShape>,
    pub(crate) tested_pairs: Vec<(usize, usize)>,
    pub(crate) approach_axis: UnitVector3<f64>,
    pub(crate) approach_point: Point3<f64>,
    pub(crate) standoff: (f64, f64),
}

/// Why a spec does not fit its hand.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum HandError {
    /// The palm is not the root link.
    #[error("the palm is '{palm}', but the root link of the URDF is '{root}'")]
    Palm {
        /// Named palm.
        palm: String,
        /// Root link.
        root: String,
    },
    /// A link that does not exist.
    #[error("{place} names the link '{link}', which does not exist")]
    UnknownLink {
        /// Where it is named.
        place: String,
        /// The name.
        link: String,
    },
    /// A joint that does not exist or is not driven.
    #[error("{place} names '{joint}', which is no driven joint of the hand")]
    UnknownJoint {
        /// Where it is named.
        place: String,
        /// The name.
        joint: String,
    },
    /// Nothing listed where something is needed.
    #[error("{place}: at least {least} {what} needed")]
    TooFew {
        /// Where.
        place: String,
        /// Of what.
        what: &'static str,
        /// How many are needed.
        least: usize,
    },
    /// A number is not finite or out of its range.
    #[error("{place}: {value} is not {wanted}")]
    Number {
        /// Where.
        place: String,
        /// The value.
        value: f64,
        /// What it should be.
        wanted: &'static str,
    },
    /// A tip link has nothing to touch with.
    #[error("finger '{finger}': tip link '{link}' has no collision geometry")]
    BareTip {
        /// The finger.
        finger: String,
        /// The link.
        link: String,
    },
    /// A closing joint does not move the tip.
    #[error("finger '{finger}': no closing joint moves the tip link '{link}'")]
    IdleTip {
        /// The finger.
        finger: String,
        /// The link.
        link: String,
    },
    /// Two fingers move the same link.
    #[error("fingers '{first}' and '{second}' both move the link '{link}'")]
    SharedLink {
        /// A finger.
        first: String,
        /// Another.
        second: String,
        /// The link.
        link: String,
    },
    /// A name is used twice.
    #[error("two {what} are named '{name}'")]
    Duplicate {
        /// Of what.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A pre-shape is outside the limits.
    #[error("pre-shape '{preshape}': '{joint}' = {value} is outside {lower} .. {upper}")]
    OutsideLimits {
        /// The pre-shape.
        preshape: String,
        /// The joint.
        joint: String,
        /// Its value.
        value: f64,
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// Collision geometry that cannot be used.
    #[error("link '{link}': {source}")]
    Geometry {
        /// The link.
        link: String,
        /// What is wrong.
        source: GeometryError,
    },
    /// Joint values that give no poses.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
}

impl Hand {
    /// Resolves a spec against a model. Errors name what does not fit.
    pub fn new(model: HandModel, spec: &HandSpec) -> Result<Self, HandError> {
        let root = &model.links[0].name;
        if *root != spec.palm {
            return Err(HandError::Palm {
                palm: spec.palm.clone(),
                root: root.clone(),
            });
        }
        let shapes = link_shapes(&model)?;
        let fingers = fingers(&model, &shapes, &spec.finger)?;
        let preshapes = preshapes(&model, &spec.preshape)?;
        let axis = Vector3::from(spec.approach_axis);
        let approach_axis =
            UnitVector3::try_new(axis, 1e-9).filter(|a| a.iter().all(|c| c.is_finite()));
        let approach_axis = approach_axis
            .ok_or_else(|| bad_number("approach_axis", axis.norm(), "a direction"))?;
        for value in spec.approach_point {
            if !value.is_finite() {
                return Err(bad_number("approach_point", value, "finite"));
            }
        }
        Ok(Hand {
            name: spec.name.clone(),
            tested_pairs: tested_pairs(&model, &shapes, spec)?,
            fingers,
            preshapes,
            shapes,
            approach_axis,
            approach_point: Point3::from(spec.approach_point),
            standoff: standoff(spec.standoff_m)?,
            model,
        })
    }

    /// The short name of the spec.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The kinematic model.
    pub fn model(&self) -> &HandModel {
        &self.model
    }

    /// The fingers, in the order of the spec (and of the contacts of a grasp).
    pub fn fingers(&self) -> &[Finger] {
        &self.fingers
    }

    /// The pre-shapes.
    pub fn preshapes(&self) -> &[Preshape] {
        &self.preshapes
    }

    /// Index of a pre-shape by name.
    pub fn preshape_index(&self, name: &str) -> Option<usize> {
        self.preshapes.iter().position(|p| p.name == name)
    }

    /// Direction of approach in the palm frame.
    pub fn approach_axis(&self) -> UnitVector3<f64> {
        self.approach_axis
    }

    /// A point of the line of approach, in the palm frame.
    pub fn approach_point(&self) -> Point3<f64> {
        self.approach_point
    }

    /// The spec's range of distances from the surface to the approach point, in metres.
    pub fn standoff(&self) -> (f64, f64) {
        self.standoff
    }

    /// Pairs of links that must keep a distance from each other.
    pub fn tested_pairs(&self) -> &[(usize, usize)] {
        &self.tested_pairs
    }
}

fn bad_number(place: &str, value: f64, wanted: &'static str) -> HandError {
    HandError::Number {
        place: place.to_string(),
        value,
        wanted,
    }
}

fn standoff([least, greatest]: [f64; 2]) -> Result<(f64, f64), HandError> {
    if !(-10.0..=10.0).contains(&least) {
        return Err(bad_number("standoff_m", least, "within 10 m"));
    }
    if !(least..=10.0).contains(&greatest) {
        return Err(bad_number("standoff_m", greatest, "at least the first"));
    }
    Ok((least, greatest))
}

fn link_shapes(model: &HandModel) -> Result<Vec<LinkShape>, HandError> {
    model
        .links
        .iter()
        .map(|link| {
            let pieces = link
                .geometry
                .iter()
                .map(ConvexPiece::new)
                .collect::<Result<Vec<_>, _>>()
                .map_err(|source| HandError::Geometry {
                    link: link.name.clone(),
                    source,
                })?;
            Ok(LinkShape::new(pieces))
        })
        .collect()
}

fn fingers(
    model: &HandModel,
    shapes: &[LinkShape],
    specs: &[FingerSpec],
) -> Result<Vec<Finger>, HandError> {
    at_least("finger", "fingers", specs.len(), 2)?;
    let fingers = specs
        .iter()
        .map(|spec| finger(model, shapes, spec))
        .collect::<Result<Vec<_>, _>>()?;
    for (k, second) in fingers.iter().enumerate() {
        for first in &fingers[..k] {
            if first.name == second.name {
                return Err(HandError::Duplicate {
                    what: "fingers",
                    name: first.name.clone(),
                });
            }
            let shared = first
                .moving_links
                .iter()
                .find(|l| second.moving_links.contains(l));
            if let Some(&link) = shared {
                return Err(HandError::SharedLink {
                    first: first.name.clone(),
                    second: second.name.clone(),
                    link: model.links[link].name.clone(),
                });
            }
        }
    }
    Ok(fingers)
}

fn at_least(place: &str, what: &'static str, count: usize, least: usize) -> Result<(), HandError> {
    if count >= least {
        return Ok(());
    }
    Err(HandError::TooFew {
        place: place.to_string(),
        what,
        least,
    })
}

fn finger(
    model: &HandModel,
    shapes: &[LinkShape],
    spec: &FingerSpec,
) -> Result<Finger, HandError> {
    let place = format!("finger '{}'", spec.name);
    at_least(&place, "tips", spec.tips.len(), 1)?;
    at_least(&place, "closing joints", spec.closing.len(), 1)?;
    let tip_links = spec
        .tips
        .iter()
        .map(|name| find_link(model, &place, name))
        .collect::<Result<Vec<_>, _>>()?;
    let mut closing = Vec::new();
    for (name, &ratio) in &spec.closing {
        let driven = find_driven(model, &place, name)?;
        if !(ratio.is_finite() && ratio != 0.0) {
            return Err(bad_number(&place, ratio, "a closing ratio other than 0"));
        }
        closing.push((driven, ratio));
    }
    let (moving_links, speed_bounds) = moving_links(model, shapes, &closing);
    for (&link, name) in tip_links.iter().zip(&spec.tips) {
        let (finger, link_name) = (spec.name.clone(), name.clone());
        if shapes[link].is_empty() {
            return Err(HandError::BareTip {
                finger,
                link: link_name,
            });
        }
        if !moving_links.contains(&link) {
            return Err(HandError::IdleTip {
                finger,
                link: link_name,
            });
        }
    }
    Ok(Finger {
        name: spec.name.clone(),
        tip_links,
        closing,
        moving_links,
        speed_bounds,
    })
}

fn find_link(model: &HandModel, place: &str, name: &str) -> Result<usize, HandError> {
    model
        .link_index(name)
        .ok_or_else(|| HandError::UnknownLink {
            place: place.to_string(),
            link: name.to_string(),
        })
}

fn find_driven(model: &HandModel, place: &str, name: &str) -> Result<usize, HandError> {
    model
        .driven_index(name)
        .ok_or_else(|| HandError::UnknownJoint {
            place: place.to_string(),
            joint: name.to_string(),
        })
}

/// Links that closing moves, and bounds on the speed of their points.
///
/// A point of link L moves at most Σ_J |rate_J| · reach(J, L), reach being the length of
/// the chain from the axis of J to the farthest point of L (1 for a sliding joint).
fn moving_links(
    model: &HandModel,
    shapes: &[LinkShape],
    closing: &[(usize, f64)],
) -> (Vec<usize>, Vec<f64>) {
    let rate_of = |joint: usize| match model.joints[joint].drive {
        Drive::Fixed => 0.0,
        Drive::Driven(index) => rate(closing, index),
        Drive::Mimic {
            driven, multiplier, ..
        } => multiplier * rate(closing, driven),
    };
    let mut links = Vec::new();
    let mut speeds = Vec::new();
    for link in 0..model.links.len() {
        let mut reach = shapes[link].reach();
        let mut speed = 0.0;
        let mut moves = false;
        for joint in model.path_to_root(link) {
            let rate: f64 = rate_of(joint);
            let joint = &model.joints[joint];
            if rate != 0.0 {
                moves = true;
                speed += rate.abs() * if joint.kind == JointKind::Prismatic { 1.0 } else { reach };
            }
            if joint.kind == JointKind::Prismatic {
                reach += joint.limits.0.abs().max(joint.limits.1.abs());
            }
            reach += joint.parent_from_joint.translation.vector.norm();
        }
        if moves {
            links.push(link);
            speeds.push(speed);
        }
    }
    (links, speeds)
}

fn rate(closing: &[(usize, f64)], driven: usize) -> f64 {
    closing
        .iter()
        .find(|(index, _)| *index == driven)
        .map_or(0.0, |(_, ratio)| *ratio)
}

fn preshapes(model: &HandModel, specs: &[PreshapeSpec]) -> Result<Vec<Preshape>, HandError> {
    at_least("preshape", "pre-shapes", specs.len(), 1)?;
    let mut done: Vec<Preshape> = Vec::new();
    for spec in specs {
        if done.iter().any(|p| p.name == spec.name) {
            return Err(HandError::Duplicate {
                what: "pre-shapes",
                name: spec.name.clone(),
            });
        }
        let place = format!("pre-shape '{}'", spec.name);
        let mut joints = vec![0.0; model.driven_count()];
        model.clamp_to_limits(&mut joints);
        for (name, &value) in &spec.joints {
            let index = find_driven(model, &place, name)?;
            let (lower, upper) = model.joints[model.driven[index]].limits;
            if !(lower..=upper).contains(&value) {
                return Err(HandError::OutsideLimits {
                    preshape: spec.name.clone(),
                    joint: name.clone(),
                    value,
                    lower,
                    upper,
                });
            }
            joints[index] = value;
        }
        done.push(Preshape {
            name: spec.name.clone(),
            joints,
        });
    }
    Ok(done)
}

/// All pairs of links with geometry that are neither neighbours nor exempt by name.
fn tested_pairs(
    model: &HandModel,
    shapes: &[LinkShape],
    spec: &HandSpec,
) -> Result<Vec<(usize, usize)>, HandError> {
    let mut exempt = Vec::new();
    for [a, b] in &spec.self_distance.exempt_pairs {
        let a = find_link(model, "exempt_pairs", a)?;
        let b = find_link(model, "exempt_pairs", b)?;
        exempt.push((a.min(b), a.max(b)));
    }
    let solid: Vec<usize> = (0..shapes.len()).filter(|&l| !shapes[l].is_empty()).collect();
    let mut pairs = Vec::new();
    for (k, &a) in solid.iter().enumerate() {
        for &b in &solid[k + 1..] {
            let near = model.joints_between(a, b) <= spec.self_distance.exempt_within_joints;
            if !near && !exempt.contains(&(a, b)) {
                pairs.push((a, b));
            }
        }
    }
    Ok(pairs)
}
