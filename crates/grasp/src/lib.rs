//! Grasps as contacts, wrenches and quality: from contact points and normals to a proved number.
//!
//! The crate knows no surface, file or thread. A [`Grasp`] is a list of [`Contact`]s and a centre. A
//! [`Convention`] says how they become [`Wrench`]es: with which friction, torque length and representation
//! of the friction cone. [`Grasp::under`] joins the two to a [`GraspModel`], which every measure takes,
//! with a [`Workspace`] where it needs scratch:
//!
//! ```
//! use grasp::{Contact, ContactModel, Convention, Grasp, GraspModel, Workspace, epsilon, margin};
//! use nalgebra::{Point3, Unit, Vector3};
//!
//! // Two fingers on opposite sides of a box of six centimetres.
//! let contacts = [-1.0, 1.0].map(|side| Contact {
//!     position: Point3::new(0.03 * side, 0.0, 0.0),
//!     inward_normal: Unit::new_normalize(Vector3::new(-side, 0.0, 0.0)),
//! });
//! let grasp = Grasp::new(contacts.to_vec(), Point3::origin())?;
//! let convention = Convention::paper();
//! let mut workspace = Workspace::new();
//!
//! // Two points cannot resist a torque about the line through them; two soft fingers can.
//! let points = grasp.under(&convention);
//! assert!(!epsilon(&points, &mut workspace)?.closed);
//! let soft = [ContactModel::soft_disc(convention.friction, 0.01); 2];
//! let found = epsilon(&points.with_contact_models(&soft), &mut workspace)?;
//! assert!(found.closed && found.lower <= found.quality && found.quality <= found.upper);
//!
//! // An optimiser can start from the open grasp: its margin is minus the distance from closure.
//! assert!(margin(&points, &mut workspace)?.value <= 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! How sure a number is that was measured on a scan is answered by [`robust_quality`]:
//!
//! ```
//! use grasp::{Contact, Convention, Grasp, Uncertainty, Workspace, robust_quality};
//! use nalgebra::{Point3, Unit, Vector3};
//!
//! let contacts = (0..4).map(|i| {
//!     let (sin, cos) = (f64::from(i) * std::f64::consts::FRAC_PI_2).sin_cos();
//!     Contact {
//!         position: Point3::new(0.04 * cos, 0.04 * sin, 0.01 * f64::from(i % 2)),
//!         inward_normal: Unit::new_normalize(Vector3::new(-cos, -sin, 0.0)),
//!     }
//! });
//! let grasp = Grasp::new(contacts.collect(), Point3::origin())?;
//! let convention = Convention::paper();
//! // Contacts known to half a millimetre and normals to three degrees.
//! let known = [Uncertainty { position: 5e-4, normal: 3.0_f64.to_radians() }; 4];
//! let sure = robust_quality(&grasp.under(&convention), &known, &mut Workspace::new())?;
//! assert!(sure > 0.1);
//! // On an edge, where normals are known to 50 degrees, nothing is certain.
//! let edge = [Uncertainty { position: 5e-4, normal: 50.0_f64.to_radians() }; 4];
//! assert_eq!(robust_quality(&grasp.under(&convention), &edge, &mut Workspace::new())?, 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Intervals are proved from both ends: see [`Certificate`].

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

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
    ActiveFacet, Carrier, Certificate, CertificateCap, CertificateFacet, Epsilon, FrictionBound,
    FrictionNeeded, Margin, QualityError, Uncertainty, Workspace, closed_radius, epsilon,
    epsilon_linf, epsilon_of_wrenches, epsilon_with_certificate, friction_needed,
    lipschitz_constant, margin, min_weight, near_active_facets, robust_quality,
    smallest_singular_value, volume,
};
pub use resistance::{Resistance, resist};
pub use wrench::{Wrench, WrenchError, wrench};
pub use wrenches::{wrenches, wrenches_with_tangents};
