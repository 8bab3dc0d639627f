//! The integration tests of `record`, as one program.

mod envelope;
mod grasps;
mod isaac;
mod shapes;
