//! What the programs of moduli share: whole-file writes, resumable computations, and `.npy` tables.
//!
//! - [`write()`] writes a result to a file. A reader sees either the old file or the whole new one.
//!   A device, a pipe or the target of a symbolic link is written to and not replaced. An input is
//!   never overwritten.
//! - [`ledger`] stores the results of a long computation, so that an interrupted run can continue.
//!   A result is used again only if its inputs and the program are the same and it has not been
//!   changed.
//! - [`npy`] reads and writes tables of doubles in NumPy's format.
//!
//! ```
//! let folder = tempfile::tempdir()?;
//! let (scan, shape) = (folder.path().join("can.ply"), folder.path().join("can.shape"));
//! std::fs::write(&scan, "ply")?;
//!
//! run::write(&shape, b"fitted", &[&scan])?;
//! assert_eq!(std::fs::read(&shape)?, b"fitted");
//!
//! let refused = run::write(&scan, b"fitted", &[&scan]).unwrap_err();
//! assert!(refused.is_usage());
//! assert_eq!(std::fs::read(&scan)?, b"ply");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod digest;
pub mod ledger;
pub mod npy;
pub mod npz;
pub mod write;

pub use digest::Digest;
pub use ledger::{Key, Ledger};
pub use write::{WriteError, check_results, write};
