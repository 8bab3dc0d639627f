//! The integration tests of `run`, as one program.

mod ledger;
mod npy;
mod write;
