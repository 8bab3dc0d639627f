//! Results as files: written to a temporary name, then renamed.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::error::ExperimentError;
use crate::table::Table;

/// What a section found.
#[derive(Clone, Debug)]
pub struct Findings {
    /// Which objects it ran on, and which were refused.
    pub objects: Value,
    /// What the paper says.
    pub paper: Value,
    /// What came out here.
    pub ours: Value,
    /// The main numbers for people.
    pub table: Table,
    /// Pictures.
    pub figures: Vec<report::Section>,
}

/// Writes bytes to `folder/name` by way of a temporary name, making the folder where needed.
///
/// Readers see the old file or the whole new one.
pub fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, ExperimentError> {
    let target = folder.join(name);
    let unfinished = folder.join(format!(".{name}.{}", std::process::id()));
    let failed = |path: &Path, reason| ExperimentError::Output {
        path: path.to_owned(),
        reason,
    };
    std::fs::create_dir_all(folder).map_err(|e| failed(folder, e))?;
    let written = std::fs::write(&unfinished, bytes)
        .map_err(|e| failed(&unfinished, e))
        .and_then(|()| std::fs::rename(&unfinished, &target).map_err(|e| failed(&target, e)));
    if written.is_err() {
        // The first failure is the one to tell; a file that never came to be cannot be removed.
        let _ = std::fs::remove_file(&unfinished);
    }
    written.map(|()| target)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_but_the_result_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("new/deep");
        write(&out, "a.json", b"first").unwrap();
        let path = write(&out, "a.json", b"second").unwrap();
        assert_eq!(std::fs::read(path).unwrap(), b"second");
        assert_eq!(std::fs::read_dir(&out).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_that_is_a_file_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        let error = write(&file, "a.json", b"").unwrap_err();
        assert!(error.to_string().contains("file"));
        assert_eq!(error.exit_code(), 1);
    }
}
