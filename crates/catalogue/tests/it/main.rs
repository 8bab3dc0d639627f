//! The integration tests of `catalogue`, as one program.

mod common;
mod geometry;
mod sampling;
mod shape_space;
