//! The experiments of the paper, one function a section and one binary around each.
//!
//! Every binary writes `OUT/<binary>.json` with the paper's numbers beside ours, and prints a short
//! table. The constants of the paper are in [`paper`] alone.

pub mod args;
pub mod drawing;
pub mod error;
pub mod ledger;
pub mod library;
pub mod objects;
pub mod output;
pub mod paper;
pub mod pipeline;
pub mod program;
pub mod run;
pub mod sections;
pub mod statistics;
pub mod table;

pub use error::ExperimentError;
pub use output::Results;
pub use run::{Run, Scale};
