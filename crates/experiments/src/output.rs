//! The results of a section, and the writing of its files.

use std::path::{Path, PathBuf};

use run::WriteError;
use serde_json::Value;

use crate::table::Table;

/// The results of a section, for its files and its printed table.
#[derive(Clone, Debug)]
pub struct Results {
    /// The objects used, and those that were refused.
    pub objects: Value,
    /// The numbers of the paper.
    pub paper: Value,
    /// Our numbers.
    pub ours: Value,
    /// The main numbers, as a table.
    pub table: Table,
    /// The figures.
    pub figures: Vec<report::Section>,
}

/// Writes a result to `folder/name` and creates the folder if needed.
///
/// # Errors
/// As [`run::write()`].
pub fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, WriteError> {
    let path = folder.join(name);
    let no_inputs: [&Path; 0] = [];
    run::write(&path, bytes, &no_inputs)?;
    Ok(path)
}
