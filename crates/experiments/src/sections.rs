//! The sections of the paper.
//!
//! Every section has three parts: findings (the data), a measurement that computes them, and
//! figures that show them. Its `run` calls the measurement and the figures and assembles the
//! results.

pub mod eigenfunctions;
pub mod gradient_ascent;
pub mod initial_grasps;
pub mod reconstruction;
pub mod sampling;
pub mod scattered_starts;
pub mod shape_space;
pub mod transfer;
