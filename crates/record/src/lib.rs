//! What is written down: the only serialised types, each with a version.
//!
//! Binary records (shapes, the library) go through [`envelope`]: a header that names the kind and
//! the version, a checksum, and a bincode body. `grasps.json` is [`grasps::GraspsFile`], and
//! [`isaac`] writes its grasps as YAML. No type
//! of a foreign crate appears in a stored type.

pub mod envelope;
pub mod grasps;
pub mod isaac;
pub mod library;
pub mod shape_record;

pub use envelope::{EnvelopeError, Kind};
pub use grasps::{GraspRecord, GraspsFile, GraspsFileError};
pub use isaac::isaac_grasps;
pub use library::{LibraryEntry, LibraryGrasp, LibraryRecord};
pub use shape_record::{ShapeRecord, ShapeRecordError};
