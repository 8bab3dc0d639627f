//! Wraps and maps of shapes whose topology is known.

mod clouds;
mod properties;
mod shapes;
