//! A hand ready for use: the model with its spec resolved and checked.

mod groups;
mod jaws;
mod problems;
mod resolve;

use nalgebra::{Point3, UnitVector3};
use thiserror::Error;

use crate::collision::{GeometryError, LinkShape};
use crate::hand_spec::HandSpec;
use crate::kinematics::KinematicsError;
use crate::model::HandModel;
use crate::tip_model::TipModel;
pub use groups::FingerGroup;
pub use jaws::Jaws;
pub(crate) use resolve::{TIP_EXCESS, link_shapes};
use resolve::{
    approach, fingers, least_fingers, pad_radius, palm, preshapes, separate, standoff,
    tested_pairs, tighten_tips,
};

/// Fingers are opened in steps of this, up to the most, units of closing.
const OPENING_STEP: f64 = 2e-3;
const MOST_OPENING: f64 = 0.6;

/// A finger of a [`Hand`].
#[derive(Debug, Clone)]
pub struct Finger {
    /// Its name.
    pub name: String,
    /// Links that make the tip.
    pub tip_links: Vec<usize>,
    /// Driven joints that close it with their share of the motion.
    pub closing: Vec<(usize, f64)>,
    /// Links that move when it closes, parents first; of fingers that close together each link belongs
    /// to one.
    pub moving_links: Vec<usize>,
}

/// Joint values from which fingers close.
#[derive(Debug, Clone, PartialEq)]
pub struct Preshape {
    /// Its name.
    pub name: String,
    /// One value per driven joint.
    pub joints: Vec<f64>,
}

/// A hand model with its fingers, pre-shapes, collision shapes and tested pairs.
#[derive(Debug, Clone)]
pub struct Hand {
    pub(crate) name: String,
    pub(crate) model: HandModel,
    pub(crate) fingers: Vec<Finger>,
    pub(crate) groups: Vec<FingerGroup>,
    pub(crate) least_fingers: usize,
    pad_radius: Option<f64>,
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
    /// The palm does not exist, or fingers of the spec do not hang on it.
    #[error(
        "the palm is '{palm}', on which the fingers do not hang; the root link of the URDF is '{root}'"
    )]
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
    /// Fingers share a closing joint but do not close alike.
    #[error(
        "fingers '{first}' and '{second}' share a closing joint; give both the same closing joints and shares"
    )]
    UnlikeClosing {
        /// A finger.
        first: String,
        /// Another.
        second: String,
    },
    /// The palm is to give way, but no two fingers close together.
    #[error(
        "compliant: no two fingers are closed by the same joints, so the palm has no reason to give way"
    )]
    NotCompliant,
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
    /// The joint values give no poses.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
}

impl Hand {
    /// Resolves a spec against a model. Errors name what does not fit.
    ///
    /// Where the palm of the spec is not the root link of the model, the hand is the part of the model
    /// below it, and the palm frame is the frame of that link.
    pub fn new(model: HandModel, spec: &HandSpec) -> Result<Self, HandError> {
        let model = palm(&model, spec)?;
        let mut shapes = link_shapes(&model)?;
        let mut fingers = fingers(&model, &shapes, &spec.finger)?;
        tighten_tips(&model, &mut shapes, &fingers)?;
        let groups = groups::groups(&model, &shapes, spec, &mut fingers)?;
        separate(&model, &fingers)?;
        let preshapes = preshapes(&model, &spec.preshape)?;
        let (approach_axis, approach_point) = approach(spec)?;
        Ok(Hand {
            name: spec.name.clone(),
            tested_pairs: tested_pairs(&model, &shapes, spec)?,
            least_fingers: least_fingers(spec)?,
            pad_radius: pad_radius(spec)?,
            fingers,
            groups,
            preshapes,
            shapes,
            approach_axis,
            approach_point,
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

    /// The fingers by the joints that close them, in the order of their first fingers.
    pub fn groups(&self) -> &[FingerGroup] {
        &self.groups
    }

    /// How many fingers must touch for a grasp.
    pub fn least_fingers(&self) -> usize {
        self.least_fingers
    }

    /// What the contacts of the tips transmit unless a user says otherwise: soft fingers of the spec's
    /// pad radius for a hand of two fingers, points for others.
    pub fn tip_model(&self) -> TipModel {
        match self.fingers.len() {
            2 => TipModel::Soft {
                radius: self.pad_radius.unwrap_or(Self::USUAL_PAD_RADIUS),
            },
            _ => TipModel::Point,
        }
    }

    /// Whether the spec says how large the tips' pads are.
    pub fn has_pad_radius(&self) -> bool {
        self.pad_radius.is_some()
    }

    /// The radius of a pad where the spec has none, metres.
    pub const USUAL_PAD_RADIUS: f64 = 5e-3;

    /// The joints with every finger opened by `opening` units of closing, within the limits.
    pub fn opened(&self, joints: &[f64], opening: f64) -> Vec<f64> {
        let mut open = joints.to_vec();
        for &(driven, ratio) in self.groups.iter().flat_map(|g| &g.closing) {
            open[driven] -= opening * ratio;
        }
        self.model.clamp_to_limits(&mut open);
        open
    }

    /// The joints of `start` with the fingers opened until each tip is `least` (metres) from where it is
    /// at `closed`, as far as the limits allow. Fingers that are that far already stay as they are.
    pub fn opened_by(&self, start: &[f64], closed: &[f64], least: f64) -> Vec<f64> {
        let mut open = start.to_vec();
        let tips = |joints: &[f64], group: &FingerGroup| -> Vec<Point3<f64>> {
            let poses = self.model.root_from_links(joints).unwrap_or_default();
            let links = group.fingers.iter().map(|&f| self.fingers[f].tip_links[0]);
            let middle = |l: usize| Some(poses.get(l)? * self.shapes[l].centre);
            links.filter_map(middle).collect()
        };
        for group in &self.groups {
            let touching = tips(closed, group);
            let apart = |joints: &[f64]| {
                let moved = tips(joints, group);
                let gaps = moved.iter().zip(&touching).map(|(a, b)| (a - b).norm());
                gaps.fold(f64::INFINITY, f64::min)
            };
            // A unit of closing is a radian or a metre.
            let mut opening = OPENING_STEP;
            while apart(&open) < least && opening < MOST_OPENING {
                let mut wider = open.clone();
                for &(driven, ratio) in &group.closing {
                    wider[driven] = start[driven] - opening * ratio;
                }
                self.model.clamp_to_limits(&mut wider);
                open = wider;
                opening += OPENING_STEP;
            }
        }
        open
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
