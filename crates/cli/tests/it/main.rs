//! The tests of `cli` that use it from outside, as one program.

mod ascend_transfer;
mod certificates;
mod commands;
mod common;
mod evidence;
mod export;
mod formats;
mod grippers;
mod hand_init;
mod hands;
mod library;
mod metrics;
mod quality;
mod results;
mod spherical;
