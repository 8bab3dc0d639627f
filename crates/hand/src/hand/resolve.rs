//! Resolves the names of a spec to indices of a model and checks them.

use nalgebra::{Point3, UnitVector3, Vector3};

use super::{Finger, HandError, Preshape};
use crate::collision::{ConvexPiece, LinkShape};
use crate::hand_spec::{FingerSpec, HandSpec, PreshapeSpec};
use crate::model::{Drive, HandModel, JointKind};

/// The hull of a tip's mesh may extend beyond the mesh by this, metres.
pub(crate) const TIP_EXCESS: f64 = 2e-4;

pub(super) fn bad_number(place: &str, value: f64, wanted: &'static str) -> HandError {
    HandError::Number {
        place: place.to_string(),
        value,
        wanted,
    }
}

/// The model below the palm, whose frame is the palm frame.
pub(super) fn palm(model: &HandModel, spec: &HandSpec) -> Result<HandModel, HandError> {
    let wrong = || HandError::Palm {
        palm: spec.palm.clone(),
        root: model.links[0].name.clone(),
    };
    let palm = model.link_index(&spec.palm).ok_or_else(wrong)?;
    let part = model.below(palm);
    let lost = |name: &String| model.link_index(name).is_some() && part.link_index(name).is_none();
    if spec.finger.iter().flat_map(|f| &f.tips).any(lost) {
        return Err(wrong());
    }
    Ok(part)
}

/// Direction and point of the line of approach.
pub(super) fn approach(spec: &HandSpec) -> Result<(UnitVector3<f64>, Point3<f64>), HandError> {
    let axis = Vector3::from(spec.approach_axis);
    let direction = UnitVector3::try_new(axis, 1e-9)
        .filter(|a| a.iter().all(|c| c.is_finite()))
        .ok_or_else(|| bad_number("approach_axis", axis.norm(), "a direction"))?;
    for value in spec.approach_point {
        if !value.is_finite() {
            return Err(bad_number("approach_point", value, "finite"));
        }
    }
    Ok((direction, Point3::from(spec.approach_point)))
}

pub(super) fn standoff([least, greatest]: [f64; 2]) -> Result<(f64, f64), HandError> {
    if !(-10.0..=10.0).contains(&least) {
        return Err(bad_number("standoff_m", least, "within 10 m"));
    }
    if !(least..=10.0).contains(&greatest) {
        return Err(bad_number("standoff_m", greatest, "at least the first"));
    }
    Ok((least, greatest))
}

pub(crate) fn link_shapes(model: &HandModel) -> Result<Vec<LinkShape>, HandError> {
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

/// Makes the hulls of tips tight: what touches is to be where the real tip is.
pub(super) fn tighten_tips(
    model: &HandModel,
    shapes: &mut [LinkShape],
    fingers: &[Finger],
) -> Result<(), HandError> {
    for &link in fingers.iter().flat_map(|f| &f.tip_links) {
        let pieces = model.links[link].geometry.iter();
        let tight = pieces.map(|placed| ConvexPiece::within(placed, TIP_EXCESS));
        let tight = tight.collect::<Result<Vec<_>, _>>();
        shapes[link] = LinkShape::new(tight.map_err(|source| HandError::Geometry {
            link: model.links[link].name.clone(),
            source,
        })?);
    }
    Ok(())
}

pub(super) fn fingers(
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
        if let Some(first) = fingers[..k].iter().find(|f| f.name == second.name) {
            return Err(HandError::Duplicate {
                what: "fingers",
                name: first.name.clone(),
            });
        }
    }
    Ok(fingers)
}

/// Checks that no link moves with two fingers, after the links of fingers that close together are
/// divided among them.
pub(super) fn separate(model: &HandModel, fingers: &[Finger]) -> Result<(), HandError> {
    for (k, second) in fingers.iter().enumerate() {
        for first in &fingers[..k] {
            let both = |l: &&usize| second.moving_links.contains(l);
            if let Some(&link) = first.moving_links.iter().find(both) {
                return Err(HandError::SharedLink {
                    first: first.name.clone(),
                    second: second.name.clone(),
                    link: model.links[link].name.clone(),
                });
            }
        }
    }
    for finger in fingers {
        for link in &finger.tip_links {
            if !finger.moving_links.contains(link) {
                return Err(HandError::IdleTip {
                    finger: finger.name.clone(),
                    link: model.links[*link].name.clone(),
                });
            }
        }
    }
    Ok(())
}

pub(super) fn least_fingers(spec: &HandSpec) -> Result<usize, HandError> {
    let all = spec.finger.len();
    let least = spec.least_fingers.unwrap_or(all);
    if (2..=all).contains(&least) {
        return Ok(least);
    }
    let wanted = "between 2 and the number of fingers";
    Err(bad_number("least_fingers", least as f64, wanted))
}

pub(super) fn pad_radius(spec: &HandSpec) -> Result<Option<f64>, HandError> {
    match spec.pad_radius_m {
        Some(radius) if !(radius > 0.0 && radius <= 0.1) => {
            let wanted = "a radius in metres, more than 0 and at most 0.1";
            Err(bad_number("pad_radius_m", radius, wanted))
        }
        radius => Ok(radius),
    }
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

pub(super) fn finger(
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
    let moving_links = Motion::of(model, shapes, &closing).links;
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
    })
}

pub(super) fn find_link(model: &HandModel, place: &str, name: &str) -> Result<usize, HandError> {
    model
        .link_index(name)
        .ok_or_else(|| HandError::UnknownLink {
            place: place.to_string(),
            link: name.to_string(),
        })
}

pub(super) fn find_driven(model: &HandModel, place: &str, name: &str) -> Result<usize, HandError> {
    model
        .driven_index(name)
        .ok_or_else(|| HandError::UnknownJoint {
            place: place.to_string(),
            joint: name.to_string(),
        })
}

/// Links that closing moves, and bounds on the speed of their points: in total and per closing
/// joint.
pub(super) struct Motion {
    /// The links, parents first.
    pub(super) links: Vec<usize>,
    /// Metres per unit of closing, of each link.
    pub(super) speeds: Vec<f64>,
    /// The share of each closing joint.
    pub(super) by_joint: Vec<Vec<f64>>,
}

impl Motion {
    /// A point of link L moves at most Σ_J |rate_J| · reach(J, L), reach being the length of
    /// the chain from the axis of J to the farthest point of L (1 for a sliding joint).
    pub(super) fn of(model: &HandModel, shapes: &[LinkShape], closing: &[(usize, f64)]) -> Self {
        // The closing joint that moves each joint, with its rate.
        let part_of = |joint: usize| {
            let (driven, factor) = match model.joints[joint].drive {
                Drive::Fixed => return None,
                Drive::Driven(driven) => (driven, 1.0),
                Drive::Mimic {
                    driven, multiplier, ..
                } => (driven, multiplier),
            };
            let part = closing.iter().position(|c| c.0 == driven)?;
            Some((part, factor * closing[part].1)).filter(|(_, rate)| *rate != 0.0)
        };
        let mut links = Vec::new();
        let mut speeds = Vec::new();
        let mut by_joint = Vec::new();
        for (link, shape) in shapes.iter().enumerate() {
            let mut reach = shape.reach();
            let mut parts = vec![0.0; closing.len()];
            // A frame on the axis rotates although its origin does not move, and its children move.
            let mut moves = false;
            for joint in model.path_to_root(link) {
                if let Some((part, rate)) = part_of(joint) {
                    moves = true;
                    let slides = model.joints[joint].kind == JointKind::Prismatic;
                    parts[part] += rate.abs() * if slides { 1.0 } else { reach };
                }
                let joint = &model.joints[joint];
                if joint.kind == JointKind::Prismatic {
                    reach += joint.limits.0.abs().max(joint.limits.1.abs());
                }
                reach += joint.parent_from_joint.translation.vector.norm();
            }
            if moves {
                links.push(link);
                speeds.push(parts.iter().sum());
                by_joint.push(parts);
            }
        }
        Motion {
            links,
            speeds,
            by_joint,
        }
    }
}

pub(super) fn preshapes(
    model: &HandModel,
    specs: &[PreshapeSpec],
) -> Result<Vec<Preshape>, HandError> {
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
pub(super) fn tested_pairs(
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
    let solid: Vec<usize> = (0..shapes.len())
        .filter(|&l| !shapes[l].is_empty())
        .collect();
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
