//! The versioned file formats of moduli.
//!
//! - [`ShapeRecord`], [`SphericalRecord`], [`LibraryRecord`] and [`LibraryObjectRecord`] are binary
//!   files. [`envelope`] gives them a header with the kind, the version and a checksum of the body.
//! - [`GraspsFile`] is `grasps.json`; [`isaac_grasps`] writes its grasps as YAML for Isaac Sim,
//!   and [`IsaacFile`] reads such files.
//!
//! This crate depends on no other crate of the project, so a program that only reads files needs
//! nothing else. The types hold plain numbers whose meaning is not checked. For example, the crate
//! that turns a stored radius function into a shape proves again that it is positive.
//!
//! A library is written and read back:
//!
//! ```
//! use record::{LibraryRecord, ShapeRecord};
//!
//! let library = LibraryRecord {
//!     seed: 1,
//!     convention: "paper".to_owned(),
//!     hand: "sdh".to_owned(),
//!     entries: Vec::new(),
//! };
//! let bytes = library.to_bytes()?;
//! assert_eq!(LibraryRecord::from_bytes(&bytes)?, library);
//! assert!(ShapeRecord::from_bytes(&bytes).is_err());
//! # Ok::<(), record::EnvelopeError>(())
//! ```

pub mod envelope;
pub mod grasps;
pub mod isaac;
pub mod library;
pub mod moveit;
pub mod shape_record;
pub mod spherical_record;

pub use envelope::{EnvelopeError, Kind};
pub use grasps::{GraspRecord, GraspsFile, GraspsFileError};
pub use isaac::{IsaacError, IsaacFile, IsaacGrasp, isaac_grasps};
pub use library::{LibraryEntry, LibraryGrasp, LibraryObjectRecord, LibraryRecord};
pub use moveit::moveit_grasps;
pub use shape_record::{ShapeNotes, ShapeRecord};
pub use spherical_record::{ClosedHoleRecord, SphericalRecord};
