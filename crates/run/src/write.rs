//! Writing results to files.

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
    /// The path has no file name, such as `..`.
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
    /// The result would replace an input of the program.
    #[error("`{}` is an input; its result needs another name", path.display())]
    Input {
        /// The path.
        path: PathBuf,
    },
    /// Two results have the same path, so that one would be lost.
    #[error("two results would be written to `{}`; one of them needs another name", path.display())]
    Twice {
        /// The path.
        path: PathBuf,
    },
    /// The file is read-only.
    #[error("`{}` is read-only; it is left as it is", path.display())]
    ReadOnly {
        /// The path.
        path: PathBuf,
    },
    /// The operating system reports an error.
    #[error("cannot write `{}`: {source}", path.display())]
    Io {
        /// The path.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
}

impl WriteError {
    /// Whether the cause is the request (such as a wrong path) and not the operating system.
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
/// - A regular or new file is written under a temporary name in the same folder, flushed to the
///   disk and renamed. A reader sees either the old file or the whole new one. The permissions of
///   an existing file are kept. Missing folders are created.
/// - A symbolic link is kept; its target is written.
/// - A device or a pipe is written to. If it is the standard output of the program, the bytes
///   follow what the program has printed.
/// - After a failed write no temporary file and no new folder remains. On Linux the temporary file
///   has no name while it is written, if the file system supports that, so nothing remains of a
///   program that is killed either.
///
/// `inputs` are the files that the program reads.
///
/// # Errors
/// The path has no file name or is a folder, the file is one of `inputs` (also through a link) or
/// read-only, or the operating system reports an error.
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

/// Checks the paths of results before the computation begins.
///
/// # Errors
/// Two results have the same path, or [`write()`] would refuse one of them.
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
            // Flush what has been printed before.
            io::stdout().lock().flush()?;
            output
        }
        None => OpenOptions::new().write(true).open(path)?,
    };
    file.write_all(bytes)?;
    file.flush()
}

/// Writes a temporary file in the folder of `path` and renames it.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let mut made = MadeFolders::make(folder)?;
    Part::write(folder, bytes, path)?.rename(path)?;
    made.keep();
    // The new name is on the disk only after the folder is flushed. Some file systems cannot flush
    // a folder; the file itself is complete, so that error is ignored.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    Ok(())
}

/// Folders that a write created, the deepest first; they are removed unless the write succeeds.
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
            // A folder that another program has used meanwhile is not empty and is kept.
            let _ = fs::remove_dir(folder);
        }
    }
}
