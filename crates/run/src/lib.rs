//! What the programs of moduli share: whole-file writes, resumable work, and `.npy` tables.
//!
//! - [`write()`] puts a result into a file. A reader sees the old file or the whole new one; a
//!   device, a pipe or the target of a symbolic link is written to and not replaced; an input is
//!   never overwritten.
//! - [`ledger`] keeps the results of a long computation, so that an interrupted run goes on where
//!   it was. A result is used again only if it depends on the same inputs and the same program, and
//!   has not been changed since.
//! - [`npy`] reads and writes tables of doubles as NumPy does.
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
pub mod write;

pub use digest::Digest;
pub use ledger::{Key, Ledger};
pub use write::{WriteError, check_results, write};
