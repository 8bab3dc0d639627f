//! A first spec for a hand of which only the URDF is known.
//!
//! Everything comes from the geometry: the fingers are the chains that part from the palm, they close
//! the way that brings their ends together, and the line of approach runs from the palm to the middle
//! of a ball that the ends can hold. What the geometry leaves open (from where the fingers start, how
//! far the palm stands off) is decided by trying the hand on two balls.

mod bodies;
mod exempt;
mod fingers;
mod jaws;
mod opposition;
mod trial;

use std::collections::BTreeMap;

use nalgebra::{Point3, UnitVector3, Vector3};
use rand::Rng;
use thiserror::Error;

use crate::closing::ClosingRules;
use crate::hand::{Hand, HandError, link_shapes};
use crate::hand_spec::{FingerSpec, HandSpec, PreshapeSpec, SelfDistance};
use crate::model::{HandModel, Link};
use crate::synthesis::SynthesisError;
use bodies::Bodies;
use fingers::{Finger, Resting};
use opposition::{Start, fixed_links};

/// A direction this near to an axis of the palm frame is taken for that axis, as a cosine (35°).
const SNAP: f64 = 0.82;
/// An axis this near is tried too.
const NEAR_AXIS: f64 = 0.6;
/// Ways to start that are tried on balls.
const TRIED: usize = 8;
/// Ranges of the distance from the surface to the middle of a ball that fits, metres.
const STANDOFFS: [[f64; 2]; 2] = [[-0.06, -0.02], [-0.035, 0.0]];
/// The surface stays at least this far from the palm, metres.
const LEAST_STANDOFF: f64 = 0.008;
/// Steps from the middle of a ball back to the palm, metres.
const STEP: f64 = 2e-3;
/// A second pre-shape is kept where it gives this share of the grasps of the best.
const WORTH_KEEPING: f64 = 0.5;
/// Of more fingers than three, three are enough for a grasp.
const ENOUGH_FINGERS: usize = 3;
/// A finger has at most so many joints of its own, else it is an arm.
const MOST_JOINTS: usize = 6;
/// A finger is at most this long, else it is an arm; metres.
const LONGEST_FINGER: f64 = 0.4;

/// A spec that a hand can be used with, and what was decided on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// The spec; [`HandSpec::to_toml`] is its file.
    pub spec: HandSpec,
    /// A sentence for each thing that a user should look at.
    pub notes: Vec<String>,
}

/// Why no spec could be proposed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum InitError {
    /// The palm that was asked for does not exist.
    #[error("no link is named '{palm}'; the links are {links}")]
    UnknownPalm {
        /// The name asked for.
        palm: String,
        /// The names of all links.
        links: String,
    },
    /// Nothing that could touch.
    #[error(
        "no link has collision geometry, so nothing can touch an object; add <collision> elements to the URDF"
    )]
    NoGeometry,
    /// No two fingers hang on the palm.
    #[error(
        "{found} moving finger(s) hang on '{palm}', and two are needed; name the link on which the fingers hang with --palm"
    )]
    TooFewFingers {
        /// The palm.
        palm: String,
        /// How many were found.
        found: usize,
    },
    /// What hangs on the palm is longer than fingers are.
    #[error(
        "what hangs on '{palm}' looks like arms, not fingers ({joints} joints lead to '{tip}'); name the palm of one hand with --palm"
    )]
    Arms {
        /// The palm.
        palm: String,
        /// The link at the end.
        tip: String,
        /// Joints between the two.
        joints: usize,
    },
    /// The ends of the fingers never surround anything.
    #[error(
        "no joint values bring the tips of {fingers} about a ball in front of '{palm}'; write the TOML by hand (docs/bring-your-own-hand.md)"
    )]
    NoOpposition {
        /// The palm.
        palm: String,
        /// Names of the tips.
        fingers: String,
    },
    /// The proposal does not fit its own hand.
    #[error(transparent)]
    Hand(#[from] HandError),
    /// The hand cannot be tried.
    #[error(transparent)]
    Trial(#[from] SynthesisError),
}

/// Proposes how a hand is used.
///
/// `palm` names the link on which the fingers hang; by default the one from which the ways to the
/// fingers part. The same model and the same state of the generator give the same spec. Cost: about a
/// thousand hand poses on balls, so seconds.
///
/// # Errors
/// Fewer than two fingers, no collision geometry, or fingers that cannot oppose each other.
pub fn propose<R: Rng + Clone>(
    model: &HandModel,
    palm: Option<&str>,
    rng: &R,
) -> Result<Proposal, InitError> {
    let whole = Bodies::new(model);
    let palm = match palm {
        Some(name) => model
            .link_index(name)
            .ok_or_else(|| InitError::UnknownPalm {
                palm: name.to_owned(),
                links: names(model.links()),
            })?,
        None => whole.palm(),
    };
    let part = model.below(palm);
    let shapes = link_shapes(&part)?;
    if shapes.iter().all(|s| s.is_empty()) {
        return Err(InitError::NoGeometry);
    }
    let hand = Resting::new(&part, &shapes);
    let bodies = Bodies::new(&part);
    let mut fingers = hand.fingers(&bodies);
    hand.separate(&mut fingers);
    check_fingers(&hand, &fingers)?;
    let draft = Draft {
        hand: &hand,
        fingers: &fingers,
        name: model.name(),
    };
    let mut proposal = if let [first, second] = &fingers[..] {
        draft.jaws(first, second, rng)?
    } else {
        draft.around(rng)?
    };
    if palm != 0 {
        proposal.notes.insert(
            0,
            format!(
                "the palm is '{}': what is above it in the URDF, '{}' and so on, is left out (--palm names another link)",
                part.links()[0].name,
                model.links()[0].name
            ),
        );
    }
    Ok(proposal)
}

fn names(links: &[Link]) -> String {
    let names: Vec<&str> = links.iter().map(|l| l.name.as_str()).collect();
    names.join(", ")
}

fn check_fingers(hand: &Resting<'_>, fingers: &[Finger]) -> Result<(), InitError> {
    let model = hand.model;
    let palm = model.links()[0].name.clone();
    if fingers.len() < 2 {
        let found = fingers.len();
        return Err(InitError::TooFewFingers { palm, found });
    }
    let is_arm = |f: &&Finger| {
        f.path.len() > MOST_JOINTS || hand.length(f.path[0], &f.tips) > LONGEST_FINGER
    };
    match fingers.iter().find(is_arm) {
        Some(arm) => Err(InitError::Arms {
            palm,
            tip: model.links()[arm.tips[0]].name.clone(),
            joints: arm.path.len(),
        }),
        None => Ok(()),
    }
}

/// What is known before the hand is tried.
struct Draft<'a> {
    hand: &'a Resting<'a>,
    fingers: &'a [Finger],
    name: &'a str,
}

/// The line of approach and where the hand stands on it.
struct Approach {
    axis: UnitVector3<f64>,
    point: Point3<f64>,
    standoff: [f64; 2],
}

impl Draft<'_> {
    /// A hand of three fingers or more: of the promising starts the best on balls.
    fn around<R: Rng + Clone>(&self, rng: &R) -> Result<Proposal, InitError> {
        let starts = opposition::starts(self.hand, self.fingers);
        let mut tried: Vec<(f64, HandSpec)> = Vec::new();
        for start in starts.iter().take(TRIED) {
            for axis in self.axes(&start.joints, &start.centre) {
                for standoff in STANDOFFS {
                    let approach = self.approach(start, axis, standoff);
                    let spec = self.spec(&approach, &[start]);
                    let hand = Hand::new(self.hand.model.clone(), &spec)?;
                    tried.push((start.score + trial::score(&hand, rng)?, spec));
                }
            }
        }
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        let Some((best, spec)) = tried.first() else {
            let tips = self.fingers.iter().map(|f| self.link(f.tips[0]));
            return Err(InitError::NoOpposition {
                palm: self.link(0),
                fingers: tips.collect::<Vec<_>>().join(", "),
            });
        };
        let mut spec = spec.clone();
        let second = tried.iter().find(|(score, other)| {
            let alike = other.approach_axis == spec.approach_axis
                && other.approach_point == spec.approach_point;
            alike && other.preshape != spec.preshape && *score >= WORTH_KEEPING * best
        });
        if let Some((_, other)) = second {
            spec.preshape.extend(other.preshape.iter().cloned());
            for pair in &other.self_distance.exempt_pairs {
                if !spec.self_distance.exempt_pairs.contains(pair) {
                    spec.self_distance.exempt_pairs.push(pair.clone());
                }
            }
        }
        let mut notes = Vec::new();
        if spec.least_fingers.is_some() {
            notes.push(format!(
                "{ENOUGH_FINGERS} of the {} fingers are enough for a grasp (least_fingers)",
                self.fingers.len()
            ));
        }
        Ok(Proposal { spec, notes })
    }

    fn link(&self, link: usize) -> String {
        self.hand.model.links()[link].name.clone()
    }

    /// The line along an axis to the middle of the ball that a start holds.
    fn approach(
        &self,
        start: &Start,
        axis: UnitVector3<f64>,
        [least, greatest]: [f64; 2],
    ) -> Approach {
        let height = self.height(&start.joints, &start.centre, &axis);
        let point = start.centre - axis.into_inner() * height;
        let least = (height + least).max(LEAST_STANDOFF);
        Approach {
            axis,
            point,
            standoff: [least, (height + greatest).max(least + 0.01)],
        }
    }

    /// The direction from the nearest point of the palm to a point, and the axis of the palm frame near
    /// it; that axis alone where it is very near.
    fn axes(&self, joints: &[f64], to: &Point3<f64>) -> Vec<UnitVector3<f64>> {
        let poses = self.hand.poses_at(joints);
        let palm = fixed_links(self.hand, self.fingers);
        let offsets = palm
            .iter()
            .map(|&l| self.hand.shapes[l].offset_to(&poses[l], to));
        let nearest = offsets.min_by(|a, b| a.norm().total_cmp(&b.norm()));
        let away = nearest.unwrap_or(to.coords);
        let direction = UnitVector3::try_new(away, 1e-9).unwrap_or(Vector3::z_axis());
        let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
        let signed = axes.into_iter().flat_map(|a| [a, -a]);
        let near = signed.max_by(|a, b| a.dot(&direction).total_cmp(&b.dot(&direction)));
        match near {
            Some(axis) if axis.dot(&direction) > SNAP => vec![axis],
            Some(axis) if axis.dot(&direction) > NEAR_AXIS => vec![direction, axis],
            _ => vec![direction],
        }
    }

    /// How far a point is in front of the palm, along the approach.
    fn height(&self, joints: &[f64], from: &Point3<f64>, axis: &UnitVector3<f64>) -> f64 {
        let poses = self.hand.poses_at(joints);
        let palm = fixed_links(self.hand, self.fingers);
        let gap = |back: f64| {
            let p = from - axis.into_inner() * back;
            let gaps = palm
                .iter()
                .map(|&l| self.hand.shapes[l].offset_to(&poses[l], &p).norm());
            gaps.fold(f64::INFINITY, f64::min)
        };
        let steps = (0..150).map(|k| STEP * k as f64);
        let met = steps.clone().find(|&back| gap(back) < STEP);
        // Where the line passes the palm by, the place where it is nearest.
        let nearest = steps.min_by(|a, b| gap(*a).total_cmp(&gap(*b)));
        met.or(nearest).unwrap_or(0.0)
    }

    fn spec(&self, approach: &Approach, starts: &[&Start]) -> HandSpec {
        let clearance = ClosingRules::default().self_clearance;
        let joints: Vec<Vec<f64>> = starts.iter().map(|s| s.joints.clone()).collect();
        let many = self.fingers.len() > ENOUGH_FINGERS;
        let axis = approach.axis.into_inner();
        HandSpec {
            name: self.name.to_owned(),
            palm: self.link(0),
            approach_axis: [round(axis.x), round(axis.y), round(axis.z)],
            approach_point: [approach.point.x, approach.point.y, approach.point.z].map(round),
            standoff_m: approach.standoff.map(round),
            compliant: None,
            pad_radius_m: None,
            least_fingers: many.then_some(ENOUGH_FINGERS),
            self_distance: SelfDistance {
                exempt_within_joints: exempt::WITHIN_JOINTS,
                exempt_pairs: exempt::pairs(self.hand, self.fingers, &joints, clearance),
            },
            finger: self.fingers.iter().map(|f| self.finger_spec(f)).collect(),
            preshape: starts.iter().map(|s| self.preshape_spec(s)).collect(),
        }
    }

    /// A finger under the name of its tip.
    fn finger_spec(&self, finger: &Finger) -> FingerSpec {
        let names = self.hand.model.driven_names();
        let share = |&(driven, share): &(usize, f64)| (names[driven].to_owned(), share);
        FingerSpec {
            name: self.link(finger.tips[0]),
            tips: finger.tips.iter().map(|&l| self.link(l)).collect(),
            closing: finger.closing.iter().map(share).collect(),
        }
    }

    fn preshape_spec(&self, start: &Start) -> PreshapeSpec {
        let values = self.hand.model.driven_joints().zip(&start.joints);
        let joints: BTreeMap<String, f64> = values
            .map(|(joint, &value)| {
                let within = round(value).clamp(joint.limits.0, joint.limits.1);
                (joint.name.clone(), within)
            })
            .collect();
        PreshapeSpec {
            name: start.name.clone(),
            joints,
        }
    }
}

/// A tenth of a millimetre or of a milliradian is enough.
fn round(value: f64) -> f64 {
    (value * 1e4).round() / 1e4 + 0.0
}
