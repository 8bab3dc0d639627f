//! The tests of `catalogue` that use it from outside, as one program.

mod common;
mod geometry;
mod sampling;
mod shape_space;
