//! The experiments of the paper "Grasp Moduli Spaces and Spherical Harmonics" (ICRA 2014), and the
//! program of each.
//!
//! Every section of the paper is a module of [`sections`] with three parts: findings (the data), a
//! measurement that computes them, and figures that show them. Its program writes
//! `OUT/<program>.json`, which has the paper's numbers beside ours, and `OUT/<program>.html` with
//! the figures. It prints a short table. The constants of the paper are in [`paper`].
//!
//! A measurement can also be called from other code:
//!
//! ```
//! use experiments::sections::eigenfunctions::{Settings, measure};
//!
//! // Sec. II-C: all Y_{l,m} up to degree 6, at 20 directions and the poles.
//! let found = measure(&Settings { degree: 6, directions: 20 });
//! assert_eq!(found.functions, 49);
//! assert!(found.orthonormality_error < 1e-13);
//! assert!(found.laplacian_error < 1e-13);
//! ```

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
