//! The tests of `record` that use it from outside, as one program.

mod envelope;
mod grasps;
mod isaac;
mod shapes;
