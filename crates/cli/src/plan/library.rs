//! The library of known objects that the program carries.

use record::LibraryRecord;

use crate::failure::Failure;

/// Built by `build_library` from the catalogue; see fixtures/PROVENANCE.md.
const BYTES: &[u8] = fixtures::LIBRARY;

/// The library inside the program.
pub(crate) fn built_in() -> Result<LibraryRecord, Failure> {
    LibraryRecord::from_bytes(BYTES)
        .map_err(|e| Failure::other(format!("the built-in library is unusable: {e}")))
}
