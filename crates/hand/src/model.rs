//! The hand as a tree of links: joints, limits and collision geometry.

mod subtree;

use nalgebra::{Isometry3, Point3, UnitVector3, Vector3};

/// One piece of collision geometry in its own frame, lengths in metres.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// An axis-aligned box, centred.
    Box {
        /// Half of each edge.
        half_extents: Vector3<f64>,
    },
    /// A cylinder along z, centred.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Half of the length along z.
        half_length: f64,
    },
    /// A cylinder along z with half-spheres at both ends, centred.
    Capsule {
        /// Radius.
        radius: f64,
        /// Half of the length of the cylindrical part along z.
        half_length: f64,
    },
    /// A sphere, centred.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// The convex hull of a mesh's vertices (simplified to about 100 vertices and enlarged to
    /// hold them all where it takes part in collision tests).
    Hull {
        /// The name of the mesh file.
        file: String,
        /// The vertices of the mesh, already scaled.
        points: Vec<Point3<f64>>,
    },
}

/// Collision geometry fixed to a link.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkGeometry {
    /// Pose of the geometry in the frame of its link.
    pub link_from_geometry: Isometry3<f64>,
    /// The geometry.
    pub geometry: Geometry,
}

/// One rigid part of the hand.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Its name, unique in the hand.
    pub name: String,
    /// Collision geometry; empty for a mere frame.
    pub geometry: Vec<LinkGeometry>,
    /// Index of the joint that carries it; none for the root.
    pub parent_joint: Option<usize>,
}

/// How a joint moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// Not at all.
    Fixed,
    /// Turns about its axis; values in radians.
    Revolute,
    /// Slides along its axis; values in metres.
    Prismatic,
}

/// Where the value of a joint comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// It has none.
    Fixed,
    /// Driven value of this index.
    Driven(usize),
    /// `multiplier · value + offset` of the driven value of this index (mimic joints,
    /// chains of them already multiplied out).
    Mimic {
        /// Index of the driven value.
        driven: usize,
        /// Factor.
        multiplier: f64,
        /// Offset, in the unit of the joint.
        offset: f64,
    },
}

/// A joint between a parent and a child link.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Its name, unique in the hand.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// Index of the parent link.
    pub parent: usize,
    /// Index of the child link.
    pub child: usize,
    /// Pose of the joint frame (and of the child at value 0) in the parent link.
    pub parent_from_joint: Isometry3<f64>,
    /// Axis in the joint frame.
    pub axis: UnitVector3<f64>,
    /// Least and greatest value.
    pub limits: (f64, f64),
    /// Where its value comes from.
    pub drive: Drive,
}

/// A hand: links in an order in which parents come first, link 0 the root.
///
/// Driven joints are numbered in the order of the file; a vector of joint values has
/// one entry a driven joint in that order.
#[derive(Debug, Clone, PartialEq)]
pub struct HandModel {
    pub(crate) name: String,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) driven: Vec<usize>,
}

impl HandModel {
    /// The name in the file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// All links, parents before children, the root first.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// All joints.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Number of independent joint values.
    pub fn driven_count(&self) -> usize {
        self.driven.len()
    }

    /// The driven joints, in the order of the values.
    pub fn driven_joints(&self) -> impl ExactSizeIterator<Item = &Joint> {
        self.driven.iter().map(|&j| &self.joints[j])
    }

    /// Names of the driven joints, in the order of the values.
    pub fn driven_names(&self) -> Vec<&str> {
        self.driven_joints().map(|j| j.name.as_str()).collect()
    }

    /// Index of a link by name.
    pub fn link_index(&self, name: &str) -> Option<usize> {
        self.links.iter().position(|l| l.name == name)
    }

    /// Index among the driven values of a joint by name.
    pub fn driven_index(&self, name: &str) -> Option<usize> {
        self.driven_joints().position(|j| j.name == name)
    }

    /// Number of joints on the way from one link to another.
    pub fn joints_between(&self, a: usize, b: usize) -> usize {
        let (up_a, up_b) = (self.path_to_root(a), self.path_to_root(b));
        let shared = up_a
            .iter()
            .rev()
            .zip(up_b.iter().rev())
            .take_while(|(x, y)| x == y)
            .count();
        up_a.len() + up_b.len() - 2 * shared
    }

    /// The joints from a link up to the root.
    pub fn path_to_root(&self, link: usize) -> Vec<usize> {
        let mut path = Vec::new();
        let mut at = link;
        while let Some(joint) = self.links[at].parent_joint {
            path.push(joint);
            at = self.joints[joint].parent;
        }
        path
    }
}
