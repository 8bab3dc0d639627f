//! Hands from URDF files and the grasps that they can make on smooth objects.
//!
//! A [`HandModel`] is the kinematic tree, a [`HandSpec`] names fingers, closing joints and
//! pre-shapes, and a [`Hand`] is a checked pair of the two. [`synthesize`] samples poses around a
//! surface, closes the fingers and ranks the grasps (paper, Sec. IV-C). The palm frame is that of
//! the root link. Lengths are in metres, angles in radians.
//!
//! ```
//! use hand::Hand;
//!
//! let hand = Hand::schunk_sdh()?;
//! assert_eq!(hand.fingers().len(), 3);
//! let names: Vec<&str> = hand.preshapes().iter().map(|p| p.name.as_str()).collect();
//! assert_eq!(names, ["parallel", "spread"]);
//!
//! // The collision model with the fingers in the first pre-shape, one mesh per link.
//! let meshes = hand::hand_meshes(&hand, &hand.preshapes()[0].joints)?;
//! assert!(!meshes.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod alignment;
mod built_in;
mod check;
mod closing;
mod collision;
mod contact;
mod hand;
mod hand_spec;
mod init;
mod kinematics;
mod least_squares;
mod mesh_file;
mod model;
mod pose_sampling;
mod reach;
mod support;
mod synthesis;
mod tip_model;
mod urdf;
mod xml;

pub use alignment::carried_pose;
pub use built_in::{LoadError, SDH_SPEC, SDH_URDF, schunk_sdh};
pub use check::{Finding, Severity, check_hand, hand_meshes};
pub use closing::{ClosedHand, ClosingRules, Rejection, close_hand, touching_joints};
pub use collision::{
    CollisionObject, Gap, GeometryError, ObjectError, PointTree, Precision, Surroundings,
};
pub use contact::{TipContact, link_contact, tip_contact};
pub use hand::{Finger, FingerGroup, Hand, HandError, Jaws, Preshape};
pub use hand_spec::{
    FingerSpec, HandSpec, PreshapeSpec, SelfDistance, SpecTextError, exempt_pairs_text,
};
pub use init::{InitError, Proposal, propose};
pub use kinematics::KinematicsError;
pub use mesh_file::{MeshFileError, mesh_vertices};
pub use model::{Drive, Geometry, HandModel, Joint, JointKind, Link, LinkGeometry};
pub use pose_sampling::{HandPose, PoseSampling, aimed};
pub use reach::{
    HandState, ImproveParams, Improvement, ReachOutcome, ReachParams, Reached, Reacher,
    reach_contacts,
};
pub use synthesis::{
    HandGrasp, Outcome, OutcomeCounts, Synthesis, SynthesisError, SynthesisParams, collect,
    evaluate_pose, synthesize, synthesize_on, synthesize_watched,
};
pub use tip_model::TipModel;
pub use urdf::{
    MAX_LENGTH_M, MAX_LINKS, MAX_PIECES, MAX_URDF_BYTES, MAX_URDF_DEPTH, MAX_URDF_ELEMENTS,
    UrdfError, load_urdf, load_urdf_with_meshes, urdf_text,
};
pub use xml::XmlError;
