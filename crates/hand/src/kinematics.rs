//! Forward kinematics: the poses of the links for given joint values.

use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use thiserror::Error;

use crate::model::{Drive, HandModel, Joint, JointKind};

/// Why link poses could not be computed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum KinematicsError {
    /// The number of values is not the number of driven joints.
    #[error("{given} joint values for {expected} driven joints")]
    Count {
        /// Values given.
        given: usize,
        /// Driven joints.
        expected: usize,
    },
    /// A joint value is not finite.
    #[error("the value of joint '{joint}' is {value}")]
    NotFinite {
        /// The joint.
        joint: String,
        /// Its value.
        value: f64,
    },
}

impl Joint {
    /// The value of this joint among the driven values, in radians or metres.
    pub fn value(&self, driven: &[f64]) -> f64 {
        match self.drive {
            Drive::Fixed => 0.0,
            Drive::Driven(index) => driven[index],
            Drive::Mimic {
                driven: index,
                multiplier,
                offset,
            } => multiplier * driven[index] + offset,
        }
    }

    /// Pose of the child link in the parent link at a joint value.
    pub fn parent_from_child(&self, value: f64) -> Isometry3<f64> {
        match self.kind {
            JointKind::Fixed => self.parent_from_joint,
            JointKind::Revolute => {
                self.parent_from_joint * UnitQuaternion::from_axis_angle(&self.axis, value)
            }
            JointKind::Prismatic => {
                self.parent_from_joint * Translation3::from(self.axis.into_inner() * value)
            }
        }
    }
}

impl HandModel {
    /// Pose of every link in the frame of the root link, in the order of the links.
    ///
    ///
    /// `driven` has one value per driven joint, radians or metres. Limits are not applied.
    ///
    /// # Errors
    ///
    /// The number of values is wrong, or a value is not finite.
    pub fn root_from_links(&self, driven: &[f64]) -> Result<Vec<Isometry3<f64>>, KinematicsError> {
        if driven.len() != self.driven.len() {
            return Err(KinematicsError::Count {
                given: driven.len(),
                expected: self.driven.len(),
            });
        }
        if let Some(bad) = driven.iter().position(|v| !v.is_finite()) {
            return Err(KinematicsError::NotFinite {
                joint: self.joints[self.driven[bad]].name.clone(),
                value: driven[bad],
            });
        }
        let mut poses = vec![Isometry3::identity(); self.links.len()];
        self.update_links(driven, 0..self.links.len(), &mut poses);
        Ok(poses)
    }

    /// Recomputes the poses of some links, parents before children, from those of their parents.
    pub(crate) fn update_links(
        &self,
        driven: &[f64],
        links: impl IntoIterator<Item = usize>,
        poses: &mut [Isometry3<f64>],
    ) {
        for link in links {
            if let Some(joint) = self.links[link].parent_joint {
                let joint = &self.joints[joint];
                poses[link] = poses[joint.parent] * joint.parent_from_child(joint.value(driven));
            }
        }
    }

    /// The nearest joint values within the limits of the driven joints.
    pub fn clamp_to_limits(&self, driven: &mut [f64]) {
        for (value, joint) in driven.iter_mut().zip(self.driven_joints()) {
            *value = value.clamp(joint.limits.0, joint.limits.1);
        }
    }
}
