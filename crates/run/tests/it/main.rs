//! The tests of `run` that use it from outside, as one program.

mod ledger;
mod npy;
mod write;
