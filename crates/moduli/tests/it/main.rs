//! The integration tests of `moduli`, as one program.

mod common;
mod evidence;
mod examples;
mod measures;
mod spherical;
