//! The tests of `hand` that use it from outside, as one program.

mod above_support;
mod any_surface;
mod check;
mod closing;
mod common;
mod generated;
mod grippers;
mod hostile_urdf;
mod init;
mod kinematics;
mod reach;
mod real_tips;
mod shipped_specs;
mod surroundings;
mod synthesis;
mod urdf_files;
