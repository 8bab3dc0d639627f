//! The integration tests of `sph`, as one program.

mod accuracy;
mod properties;
mod reference;
mod regression;
mod scans;
mod threads;
