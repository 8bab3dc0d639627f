//! The source files of the workspace, as text and as modules.

use std::fs;
use std::path::{Path, PathBuf};

/// The root folder of the workspace.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Folders of all crates that ship, and their names.
pub(crate) fn crate_folders() -> Vec<(String, PathBuf)> {
    let mut folders: Vec<(String, PathBuf)> = entries(&root().join("crates"))
        .into_iter()
        .filter(|path| path.join("Cargo.toml").is_file())
        .map(|path| (file_name(&path), path))
        .collect();
    folders.push(("fixtures".to_owned(), root().join("fixtures")));
    folders
}

/// One Rust file of a crate's `src`.
pub(crate) struct Source {
    /// The file, for messages.
    pub(crate) path: PathBuf,
    /// The module path from the crate's root, empty for the root.
    pub(crate) module: Vec<String>,
    /// The text before the first `#[cfg(test)]` at the left margin.
    pub(crate) shipped: String,
}

/// All modules of a crate's library or program; programs under `src/bin` are left out.
pub(crate) fn sources(folder: &Path) -> Vec<Source> {
    let src = folder.join("src");
    rust_files(&src)
        .into_iter()
        .filter(|path| !path.starts_with(src.join("bin")))
        .map(|path| {
            let inside = path.strip_prefix(&src).unwrap_or(&path).with_extension("");
            let mut module: Vec<String> = inside
                .components()
                .map(|c| c.as_os_str().to_string_lossy().into_owned())
                .collect();
            if module == ["lib"] || module == ["main"] {
                module.clear();
            }
            let text = fs::read_to_string(&path).unwrap();
            let shipped = text.split("\n#[cfg(test)]").next().unwrap_or("").to_owned();
            Source {
                path,
                module,
                shipped,
            }
        })
        .collect()
}

/// All `.rs` files under a folder, in a fixed order.
pub(crate) fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for path in entries(folder) {
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let Ok(read) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = read.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}
