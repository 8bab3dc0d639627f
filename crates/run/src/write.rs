//! Results as files.

mod part;
mod target;

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use part::Part;
use target::{Identity, Target};

/// Why a result is not written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The path ends in no name, such as `..`.
    #[error("`{}` names no file", path.display())]
    NoName {
        /// The path.
        path: PathBuf,
    },
    /// The path is that of a folder.
    #[error("`{}` is a folder; expected the name of a file", path.display())]
    Folder {
        /// The path.
        path: PathBuf,
    },
    /// The result would replace a file that the program reads.
    #[error("`{}` is an input; its result needs another name", path.display())]
    Input {
        /// The path.
        path: PathBuf,
    },
    /// Two results would have one name, so that one of them would be lost.
    #[error("two results would be written to `{}`; one of them needs another name", path.display())]
    Twice {
        /// The path.
        path: PathBuf,
    },
    /// The file may not be written.
    #[error("`{}` is read-only; it is left as it is", path.display())]
    ReadOnly {
        /// The path.
        path: PathBuf,
    },
    /// The system refuses.
    #[error("cannot write `{}`: {source}", path.display())]
    Io {
        /// The path.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

impl WriteError {
    /// Whether the user asked for something that cannot be, as opposed to a refusal by the system.
    pub fn is_usage(&self) -> bool {
        match self {
            Self::NoName { .. } | Self::Folder { .. } | Self::Input { .. } | Self::Twice { .. } => {
                true
            }
            Self::ReadOnly { .. } | Self::Io { .. } => false,
        }
    }
}

/// Writes a whole result.
///
/// - A regular file, or a new one, is written under a temporary name in the same folder, flushed to
///   the disk and renamed. A reader sees the old file or the whole new one. Permissions of an
///   existing file are kept. Missing folders are made.
/// - A symbolic link stays; its target is written.
/// - A device or a pipe is written to. Where it is the standard output of the program, the bytes
///   take their place among what the program prints.
/// - A failed write leaves nothing behind: no temporary file, and no folder that it made. On Linux
///   the temporary file has no name while it is written, where the file system allows it, so a
///   program that is killed leaves nothing behind either.
///
/// `inputs` are the files that the program reads.
///
/// # Errors
/// The path names no file or a folder, is one of `inputs` (also through a link), is read-only, or
/// the system refuses.
pub fn write<P: AsRef<Path>>(path: &Path, bytes: &[u8], inputs: &[P]) -> Result<(), WriteError> {
    let target = Target::of(path)?;
    refuse_input(path, &target, inputs)?;
    let io_error = |source| WriteError::Io {
        path: path.to_owned(),
        source,
    };
    match target {
        Target::Stream => write_through(path, bytes).map_err(io_error),
        Target::File { path: place, .. } => replace(&place, bytes).map_err(io_error),
    }
}

/// Checks the names of results before the work begins.
///
/// # Errors
/// Two results have one name, or one of them could not be written by [`write()`].
pub fn check_results<P: AsRef<Path>, Q: AsRef<Path>>(
    results: &[P],
    inputs: &[Q],
) -> Result<(), WriteError> {
    let mut places: Vec<PathBuf> = Vec::with_capacity(results.len());
    for path in results.iter().map(AsRef::as_ref) {
        let target = Target::of(path)?;
        refuse_input(path, &target, inputs)?;
        if let Target::File { path: place, .. } = target {
            places.push(place);
        }
    }
    places.sort();
    match places.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(WriteError::Twice {
            path: pair[0].clone(),
        }),
        None => Ok(()),
    }
}

fn refuse_input<P: AsRef<Path>>(
    path: &Path,
    target: &Target,
    inputs: &[P],
) -> Result<(), WriteError> {
    let Target::File {
        identity: Some(identity),
        ..
    } = target
    else {
        return Ok(());
    };
    let is_same = |input: &P| Identity::of(input.as_ref()).is_ok_and(|of| of == *identity);
    if inputs.iter().any(is_same) {
        return Err(WriteError::Input {
            path: path.to_owned(),
        });
    }
    Ok(())
}

/// Writes to a device or pipe.
fn write_through(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = match target::standard_output(path) {
        Some(output) => {
            // What has been printed comes first.
            io::stdout().lock().flush()?;
            output
        }
        None => OpenOptions::new().write(true).open(path)?,
    };
    file.write_all(bytes)?;
    file.flush()
}

/// Writes a file beside `path` and renames it.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let mut made = MadeFolders::make(folder)?;
    Part::write(folder, bytes, path)?.rename(path)?;
    made.keep();
    // The name is on the disk when its folder is. Some file systems cannot flush a folder, and the
    // file itself is complete, so a refusal is no failure.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    Ok(())
}

/// Folders that a write made, the deepest first, which are removed unless the write succeeds.
struct MadeFolders(Vec<PathBuf>);

impl MadeFolders {
    fn make(folder: &Path) -> io::Result<Self> {
        let missing = folder
            .ancestors()
            .filter(|a| !a.as_os_str().is_empty())
            .take_while(|a| !a.exists());
        let made = Self(missing.map(Path::to_owned).collect());
        fs::create_dir_all(folder)?;
        Ok(made)
    }

    fn keep(&mut self) {
        self.0.clear();
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for folder in &self.0 {
            // A folder that another program has used in the meantime is not empty and stays.
            let _ = fs::remove_dir(folder);
        }
    }
}
