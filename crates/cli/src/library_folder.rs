//! A user's own library: a folder with a file per object, `NAME.object`.
//!
//! A file is written whole or not at all, so two programs may use one folder.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use moduli::{Library, Object};
use rayon::prelude::*;
use record::LibraryObjectRecord;

use crate::failure::Failure;
use crate::input;

/// Ending of the files.
const ENDING: &str = "object";

/// The objects of a folder that can be used, in the order of their names, and a sentence about each
/// file that cannot.
pub(crate) struct LibraryFolder {
    pub(crate) objects: Vec<LibraryObjectRecord>,
    pub(crate) warnings: Vec<String>,
}

/// The file of an object in a folder.
pub(crate) fn file_of(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.{ENDING}"))
}

/// Reads a folder. A file that is damaged is left out, with a warning that names it.
pub(crate) fn read(folder: &Path) -> Result<LibraryFolder, Failure> {
    let listing = std::fs::read_dir(folder).map_err(|e| {
        let why = format!("cannot read the library: {e}; `moduli library add` makes one");
        Failure::input(folder, why)
    })?;
    let mut files = Vec::new();
    for entry in listing {
        let path = entry.map_err(|e| Failure::input(folder, e))?.path();
        if path.extension() == Some(OsStr::new(ENDING)) {
            files.push(path);
        }
    }
    files.sort();
    let read: Vec<Result<LibraryObjectRecord, String>> =
        files.par_iter().map(|file| object(file)).collect();
    let (mut objects, mut warnings) = (Vec::new(), Vec::new());
    for (file, object) in files.iter().zip(read) {
        match object {
            Ok(object) => objects.push(object),
            Err(why) => warnings.push(format!(
                "{}: left out of the library: {why}",
                file.display()
            )),
        }
    }
    Ok(LibraryFolder { objects, warnings })
}

/// A stored object, after its surface is certified again and its grasps are checked; otherwise what
/// is wrong.
fn object(path: &Path) -> Result<LibraryObjectRecord, String> {
    let bytes = input::read(path).map_err(|e| e.message)?;
    let stored = LibraryObjectRecord::from_bytes(&bytes).map_err(|e| e.to_string())?;
    for entry in &stored.library.entries {
        Object::from_record(&entry.shape).map_err(|e| e.to_string())?;
        let bent = entry.grasps.iter().position(|g| g.directions().is_none());
        if let Some(grasp) = bent {
            return Err(format!("grasp {grasp}: a direction is not a unit vector"));
        }
    }
    Ok(stored)
}

/// The built-in library with the objects of a folder, and warnings about damaged files.
pub(crate) fn beside_builtin(folder: Option<&Path>) -> Result<(Library, Vec<String>), Failure> {
    let mut library = Library::builtin().clone();
    let Some(folder) = folder else {
        return Ok((library, Vec::new()));
    };
    let found = read(folder)?;
    let mut warnings = found.warnings;
    if found.objects.is_empty() {
        warnings.push(format!(
            "{}: the library holds no objects; `moduli library add` puts some into it",
            folder.display()
        ));
    }
    for object in found.objects {
        library = library.with(object.library);
    }
    Ok((library, warnings))
}
