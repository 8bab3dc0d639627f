//! The part of a robot that hangs on one link: a hand without the arm that carries it.

use super::{Drive, HandModel, Joint, JointKind, Link};

impl HandModel {
    /// The links below a link, with that link as the root; its frame becomes the palm frame.
    ///
    /// Joints of the part that follow a joint outside of it are held where that joint is at the value
    /// within its limits that is nearest to 0. Linear in the links.
    ///
    /// # Panics
    /// The index is out of range.
    pub fn below(&self, root: usize) -> HandModel {
        if root == 0 {
            return self.clone();
        }
        let kept: Vec<usize> = (root..self.links.len())
            .filter(|&link| link == root || self.ancestors(link).any(|a| a == root))
            .collect();
        let place = |link: usize| kept.iter().position(|&k| k == link).unwrap_or(0);
        let of_part = |joint: &usize| kept[1..].contains(&self.joints[*joint].child);
        let joints: Vec<usize> = (0..self.joints.len()).filter(of_part).collect();
        let driven: Vec<usize> = (0..self.driven.len())
            .filter(|&d| joints.contains(&self.driven[d]))
            .collect();
        let joint = |&index: &usize| {
            let joint = &self.joints[index];
            let mut moved = match new_drive(joint.drive, &driven) {
                Some(drive) => Joint {
                    drive,
                    ..joint.clone()
                },
                None => self.held(joint),
            };
            (moved.parent, moved.child) = (place(joint.parent), place(joint.child));
            moved
        };
        let link = |&index: &usize| Link {
            parent_joint: self.links[index]
                .parent_joint
                .filter(|_| index != root)
                .and_then(|j| joints.iter().position(|&k| k == j)),
            ..self.links[index].clone()
        };
        let of_driven = |d: &usize| joints.iter().position(|&j| j == self.driven[*d]);
        HandModel {
            name: self.name.clone(),
            links: kept.iter().map(link).collect(),
            driven: driven.iter().filter_map(of_driven).collect(),
            joints: joints.iter().map(joint).collect(),
        }
    }

    /// The links between a link and the root, the nearest first.
    fn ancestors(&self, link: usize) -> impl Iterator<Item = usize> + '_ {
        let parent = |l: &usize| Some(self.joints[self.links[*l].parent_joint?].parent);
        std::iter::successors(parent(&link), parent)
    }

    /// A joint that keeps the value it has while the driven joints are at rest.
    fn held(&self, joint: &Joint) -> Joint {
        let rest: Vec<f64> = self
            .driven_joints()
            .map(|j| 0.0_f64.clamp(j.limits.0, j.limits.1))
            .collect();
        let value = joint.value(&rest);
        Joint {
            kind: JointKind::Fixed,
            drive: Drive::Fixed,
            parent_from_joint: joint.parent_from_child(value),
            ..joint.clone()
        }
    }
}

/// The drive among the kept driven values; none where it follows a joint that is not kept.
fn new_drive(drive: Drive, driven: &[usize]) -> Option<Drive> {
    let place = |old: usize| driven.iter().position(|&d| d == old);
    Some(match drive {
        Drive::Fixed => Drive::Fixed,
        Drive::Driven(old) => Drive::Driven(place(old)?),
        Drive::Mimic {
            driven: old,
            multiplier,
            offset,
        } => Drive::Mimic {
            driven: place(old)?,
            multiplier,
            offset,
        },
    })
}
