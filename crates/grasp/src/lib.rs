//! Grasps as contacts, wrenches and quality: from contact points and normals to a number.
//!
//! The crate knows no surface, file or thread. A [`Grasp`] is a list of [`Contact`]s and a centre;
//! a [`Convention`] says how they become [`Wrench`]es; [`epsilon`] and [`volume`] measure the hull
//! of those.

mod closure;
mod cone;
mod contact;
mod contact_model;
mod convention;
mod distance;
mod friction;
mod gradient;
mod grasp_model;
pub mod hull;
mod linear;
mod quality;
mod resistance;
mod wrench;
mod wrenches;

pub use closure::{force_closed, wrenches_force_closed};
pub use contact::{Contact, ContactError, Grasp};
pub use contact_model::{ContactModel, ContactModelError};
pub use convention::{
    CentreRule, Convention, ConventionError, EdgeNorm, Edges, TangentRule, TorqueLength,
    UnknownConvention,
};
pub use distance::{ContactCounts, distance};
pub use friction::{cone_edges, cone_edges_from, tangent};
pub use gradient::{FrameRule, Gradient, facet_gradient};
pub use grasp_model::GraspModel;
pub use quality::{
    ActiveFacet, Carrier, Certificate, CertificateCap, CertificateFacet, Epsilon, FrictionNeeded,
    Margin, QualityError, Uncertainty, Workspace, closed_radius, epsilon, epsilon_linf,
    epsilon_of_wrenches, epsilon_with_certificate, friction_needed, lipschitz_constant, margin,
    min_weight, near_active_facets, robust_quality, smallest_singular_value, volume,
};
pub use resistance::{Resistance, resist};
pub use wrench::{Wrench, WrenchError, wrench};
pub use wrenches::{wrenches, wrenches_with_tangents};
