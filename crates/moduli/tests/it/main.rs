//! The tests of `moduli` that use it from outside, as one program.

mod common;
mod examples;
mod measures;
mod spherical;
