//! The files that a run has read, so that none of them is overwritten.

use std::collections::BTreeSet;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

static READ: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Whether a name stands for standard input.
pub(crate) fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The bytes of a file; of standard input, up to its end, for `-`.
pub(crate) fn bytes(path: &Path) -> std::io::Result<Vec<u8>> {
    if is_standard_input(path) {
        let mut bytes = Vec::new();
        std::io::stdin().lock().read_to_end(&mut bytes)?;
        return Ok(bytes);
    }
    let bytes = std::fs::read(path)?;
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    read.insert(path.to_owned());
    Ok(bytes)
}

/// The files that have been read so far.
pub(crate) fn read_so_far() -> Vec<PathBuf> {
    let read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    read.iter().cloned().collect()
}
