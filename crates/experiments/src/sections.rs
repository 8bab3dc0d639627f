//! One file a section of the paper; each computes, and says what the paper found.

pub mod eigenfunctions;
pub mod gradient_ascent;
pub mod initial_grasps;
pub mod reconstruction;
pub mod sampling;
pub mod scattered_starts;
pub mod shape_space;
pub mod transfer;
