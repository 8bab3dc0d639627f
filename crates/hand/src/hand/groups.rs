//! Fingers that the same joints close, and the links that each finger moves.

use super::resolve::Motion;
use super::{Finger, HandError};
use crate::collision::LinkShape;
use crate::hand_spec::HandSpec;
use crate::model::HandModel;

/// Fingers that close together, because the same driven joints close them; most groups have one.
#[derive(Debug, Clone)]
pub struct FingerGroup {
    /// The fingers, by index.
    pub fingers: Vec<usize>,
    /// Driven joints that close them, with their rates.
    pub closing: Vec<(usize, f64)>,
    /// Whether the palm moves along the line between the two tips until both touch.
    pub compliant: bool,
    /// Links that move when it closes, parents first.
    pub(crate) moving_links: Vec<usize>,
    /// For each moving link, a bound on the speed of its points, in metres per unit of closing.
    pub(crate) speed_bounds: Vec<f64>,
    /// The share of each closing joint in these bounds.
    pub(crate) joint_speeds: Vec<Vec<f64>>,
}

impl FingerGroup {
    /// A bound on the speed of all points that move, in metres per unit of closing.
    pub fn largest_speed(&self) -> f64 {
        self.speed_bounds.iter().copied().fold(0.0, f64::max)
    }
}

/// Puts fingers that share a closing joint into one group, and assigns each moving link to one
/// finger of its group.
pub(super) fn groups(
    model: &HandModel,
    shapes: &[LinkShape],
    spec: &HandSpec,
    fingers: &mut [Finger],
) -> Result<Vec<FingerGroup>, HandError> {
    let mut groups: Vec<FingerGroup> = Vec::new();
    for index in 0..fingers.len() {
        let shares = |g: &FingerGroup| {
            let closes = |joint: usize| g.closing.iter().any(|c| c.0 == joint);
            fingers[index].closing.iter().any(|c| closes(c.0))
        };
        match groups.iter_mut().find(|g| shares(g)) {
            Some(group) if group.closing == fingers[index].closing => group.fingers.push(index),
            Some(group) => {
                return Err(HandError::UnlikeClosing {
                    first: fingers[group.fingers[0]].name.clone(),
                    second: fingers[index].name.clone(),
                });
            }
            None => groups.push(group(model, shapes, index, &fingers[index])),
        }
    }
    for group in &mut groups {
        let pair = group.fingers.len() == 2;
        group.compliant = pair && spec.compliant.unwrap_or(true);
        divide_links(model, group, fingers);
    }
    if spec.compliant == Some(true) && !groups.iter().any(|g| g.compliant) {
        return Err(HandError::NotCompliant);
    }
    Ok(groups)
}

fn group(model: &HandModel, shapes: &[LinkShape], index: usize, finger: &Finger) -> FingerGroup {
    let Motion {
        links,
        speeds,
        by_joint,
    } = Motion::of(model, shapes, &finger.closing);
    FingerGroup {
        fingers: vec![index],
        closing: finger.closing.clone(),
        compliant: false,
        moving_links: links,
        speed_bounds: speeds,
        joint_speeds: by_joint,
    }
}

/// Assigns each link that the group moves to the finger with whose tip it shares most joints.
fn divide_links(model: &HandModel, group: &FingerGroup, fingers: &mut [Finger]) {
    if group.fingers.len() < 2 {
        return;
    }
    let shared = |link: usize, finger: &Finger| {
        let path = model.path_to_root(link);
        let common = |tip: &usize| {
            let of_tip = model.path_to_root(*tip);
            path.iter().filter(|j| of_tip.contains(j)).count()
        };
        finger.tip_links.iter().map(common).max().unwrap_or(0)
    };
    let owner = |link: usize| {
        let mut best = group.fingers[0];
        for &other in &group.fingers[1..] {
            if shared(link, &fingers[other]) > shared(link, &fingers[best]) {
                best = other;
            }
        }
        best
    };
    let owners: Vec<usize> = group.moving_links.iter().map(|&l| owner(l)).collect();
    for &finger in &group.fingers {
        let links = group.moving_links.iter().zip(&owners);
        fingers[finger].moving_links = links
            .filter(|(_, owner)| **owner == finger)
            .map(|(link, _)| *link)
            .collect();
    }
}
