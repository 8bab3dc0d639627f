//! Convex hulls of points in R⁶, and nothing else.

pub(crate) mod cap;
mod full;
pub(crate) mod min_norm;
pub(crate) mod plane;
pub(crate) mod polytope;
pub(crate) mod search;
pub(crate) mod simplex;
pub(crate) mod support;

pub use full::{ConvexHull, Facet, HullError};
