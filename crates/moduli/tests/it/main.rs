//! The integration tests of `moduli`, as one program.

mod common;
mod examples;
mod measures;
mod spherical;
