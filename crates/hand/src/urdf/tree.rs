//! The kinematic tree of a URDF: links in order, limits and mimic joints.

use std::collections::HashMap;

use nalgebra::{UnitVector3, Vector3};
use urdf_rs::JointType;

use super::{UrdfError, isometry, number, vector};
use crate::model::{Drive, HandModel, Joint, JointKind, Link, LinkGeometry};

/// Range of a joint without limits, in both directions: one turn (radians) or one metre.
pub(crate) const UNLIMITED: [(JointKind, f64); 2] = [
    (JointKind::Revolute, std::f64::consts::TAU),
    (JointKind::Prismatic, 1.0),
];
/// Larger bounds mean that there is no limit: some files have 1e16 or infinity.
const NO_BOUND: f64 = 1e3;

/// Builds the model from a URDF and the geometry of its links (in the file's order).
pub(super) fn build(
    robot: &urdf_rs::Robot,
    geometry: Vec<Vec<LinkGeometry>>,
) -> Result<HandModel, UrdfError> {
    let link_of = unique_links(robot)?;
    let parent_joint = parents(robot, &link_of)?;
    let order = parents_first(robot, &link_of, &parent_joint)?;
    let mut new_of = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        new_of[old] = new;
    }
    let drives = drives(robot)?;
    let joints = robot
        .joints
        .iter()
        .zip(&drives)
        .map(|(joint, &drive)| {
            let place = |name: &str| new_of[link_of[name]];
            moving_joint(
                joint,
                place(&joint.parent.link),
                place(&joint.child.link),
                drive,
            )
        })
        .collect::<Result<Vec<_>, _>>()?;
    let mut geometry: Vec<_> = geometry.into_iter().map(Some).collect();
    let links = order
        .iter()
        .map(|&old| Link {
            name: robot.links[old].name.clone(),
            geometry: geometry[old].take().unwrap_or_default(),
            parent_joint: parent_joint[old],
        })
        .collect();
    let driven = (0..joints.len())
        .filter(|&j| matches!(drives[j], Drive::Driven(_)))
        .collect();
    Ok(HandModel {
        name: robot.name.clone(),
        links,
        joints,
        driven,
    })
}

fn unique_links(robot: &urdf_rs::Robot) -> Result<HashMap<&str, usize>, UrdfError> {
    let mut link_of = HashMap::new();
    for (index, link) in robot.links.iter().enumerate() {
        if link_of.insert(link.name.as_str(), index).is_some() {
            return Err(UrdfError::DuplicateLink(link.name.clone()));
        }
    }
    Ok(link_of)
}

/// The parent joint of each link.
fn parents(
    robot: &urdf_rs::Robot,
    link_of: &HashMap<&str, usize>,
) -> Result<Vec<Option<usize>>, UrdfError> {
    let mut parent = vec![None; robot.links.len()];
    for (index, joint) in robot.joints.iter().enumerate() {
        for name in [&joint.parent.link, &joint.child.link] {
            if !link_of.contains_key(name.as_str()) {
                return Err(UrdfError::UnknownLink {
                    joint: joint.name.clone(),
                    link: name.clone(),
                });
            }
        }
        let child = link_of[joint.child.link.as_str()];
        if let Some(first) = parent[child].replace(index) {
            return Err(UrdfError::TwoParents {
                link: joint.child.link.clone(),
                first: robot.joints[first].name.clone(),
                second: joint.name.clone(),
            });
        }
    }
    Ok(parent)
}

/// The links, parents first. All must descend from one root.
fn parents_first(
    robot: &urdf_rs::Robot,
    link_of: &HashMap<&str, usize>,
    parent: &[Option<usize>],
) -> Result<Vec<usize>, UrdfError> {
    let roots: Vec<usize> = (0..parent.len()).filter(|&l| parent[l].is_none()).collect();
    let mut children = vec![Vec::new(); parent.len()];
    for joint in &robot.joints {
        children[link_of[joint.parent.link.as_str()]].push(link_of[joint.child.link.as_str()]);
    }
    let mut order: Vec<usize> = roots.iter().copied().take(1).collect();
    let mut next = 0;
    while next < order.len() {
        order.extend_from_slice(&children[order[next]]);
        next += 1;
    }
    if order.len() < parent.len() {
        let mut reached = vec![false; parent.len()];
        for &link in &order {
            reached[link] = true;
        }
        let missing = reached.iter().position(|&r| !r).unwrap_or(0);
        return Err(UrdfError::NotATree {
            roots: roots.len(),
            link: robot.links[missing].name.clone(),
        });
    }
    Ok(order)
}

/// The source of each joint's value; chains of mimic joints are resolved to a driven joint.
fn drives(robot: &urdf_rs::Robot) -> Result<Vec<Drive>, UrdfError> {
    let mut index_of = HashMap::new();
    for (index, joint) in robot.joints.iter().enumerate() {
        if index_of.insert(joint.name.as_str(), index).is_some() {
            return Err(UrdfError::DuplicateJoint(joint.name.clone()));
        }
    }
    let fixed = |j: usize| robot.joints[j].joint_type == JointType::Fixed;
    let mut number_of = vec![None; robot.joints.len()];
    let mut count = 0;
    for (index, joint) in robot.joints.iter().enumerate() {
        if !fixed(index) && joint.mimic.is_none() {
            number_of[index] = Some(count);
            count += 1;
        }
    }
    (0..robot.joints.len())
        .map(|index| {
            if fixed(index) {
                return Ok(Drive::Fixed);
            }
            match number_of[index] {
                Some(driven) => Ok(Drive::Driven(driven)),
                None => follow_mimic(robot, &index_of, &number_of, index),
            }
        })
        .collect()
}

fn follow_mimic(
    robot: &urdf_rs::Robot,
    index_of: &HashMap<&str, usize>,
    number_of: &[Option<usize>],
    start: usize,
) -> Result<Drive, UrdfError> {
    let (mut multiplier, mut offset, mut at) = (1.0, 0.0, start);
    for _ in 0..=robot.joints.len() {
        let joint = &robot.joints[at];
        let Some(mimic) = &joint.mimic else { break };
        let wrong = |why| UrdfError::Mimic {
            joint: joint.name.clone(),
            of: mimic.joint.clone(),
            why,
        };
        let factor = number(
            &joint.name,
            "mimic multiplier",
            mimic.multiplier.unwrap_or(1.0),
        )?;
        offset += multiplier * number(&joint.name, "mimic offset", mimic.offset.unwrap_or(0.0))?;
        multiplier *= factor;
        at = *index_of
            .get(mimic.joint.as_str())
            .ok_or_else(|| wrong("does not exist"))?;
        if robot.joints[at].joint_type == JointType::Fixed {
            return Err(wrong("is fixed"));
        }
        if let Some(driven) = number_of[at] {
            return Ok(Drive::Mimic {
                driven,
                multiplier,
                offset,
            });
        }
    }
    Err(UrdfError::Mimic {
        joint: robot.joints[start].name.clone(),
        of: robot.joints[at].name.clone(),
        why: "leads back to itself",
    })
}

fn moving_joint(
    joint: &urdf_rs::Joint,
    parent: usize,
    child: usize,
    drive: Drive,
) -> Result<Joint, UrdfError> {
    let (kind, limits) = match joint.joint_type {
        JointType::Fixed => (JointKind::Fixed, (0.0, 0.0)),
        JointType::Revolute => (JointKind::Revolute, limits(joint, JointKind::Revolute)?),
        JointType::Prismatic => (JointKind::Prismatic, limits(joint, JointKind::Prismatic)?),
        JointType::Continuous => (JointKind::Revolute, unlimited(JointKind::Revolute)),
        ref other => {
            return Err(UrdfError::JointKind {
                joint: joint.name.clone(),
                kind: format!("{other:?}").to_lowercase(),
            });
        }
    };
    let axis = if kind == JointKind::Fixed {
        Vector3::x_axis()
    } else {
        let axis = vector(&joint.name, "axis", &joint.axis.xyz.0)?;
        UnitVector3::try_new(axis, 1e-9).ok_or_else(|| UrdfError::ZeroAxis(joint.name.clone()))?
    };
    Ok(Joint {
        name: joint.name.clone(),
        kind,
        parent,
        child,
        parent_from_joint: isometry(&joint.name, &joint.origin)?,
        axis,
        limits,
        drive,
    })
}

fn unlimited(kind: JointKind) -> (f64, f64) {
    let bound = UNLIMITED.iter().find(|(k, _)| *k == kind);
    bound.map_or((0.0, 0.0), |(_, far)| (-far, *far))
}

/// The limits of a joint. Bounds that mean no limit become those of a joint without limits.
fn limits(joint: &urdf_rs::Joint, kind: JointKind) -> Result<(f64, f64), UrdfError> {
    let far = unlimited(kind);
    let (lower, upper) = (joint.limit.lower, joint.limit.upper);
    for (what, value) in [("lower limit", lower), ("upper limit", upper)] {
        if value.is_nan() {
            let item = joint.name.clone();
            return Err(UrdfError::Number { item, what, value });
        }
    }
    if !(lower <= upper) {
        return Err(UrdfError::Limits {
            joint: joint.name.clone(),
            lower,
            upper,
        });
    }
    let bounded = |value: f64, far: f64| if value.abs() < NO_BOUND { value } else { far };
    Ok((bounded(lower, far.0), bounded(upper, far.1)))
}
