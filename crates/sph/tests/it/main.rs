//! The tests of `sph` that use it from outside, as one program.

mod accuracy;
mod properties;
mod reference;
mod regression;
mod scans;
mod threads;
