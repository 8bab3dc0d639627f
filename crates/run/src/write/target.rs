//! Resolution of the path of a result.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use super::WriteError;

/// Largest number of symbolic links that are followed, as on Linux; a longer chain counts as a
/// cycle.
const MAX_LINKS: usize = 40;

/// The destination of a write.
pub(super) enum Target {
    /// A regular file, or a name that does not exist yet.
    File {
        /// The path without symbolic links.
        path: PathBuf,
        /// Identity of the existing file; `None` for a new file.
        identity: Option<Identity>,
    },
    /// A device, pipe or socket.
    Stream,
}

impl Target {
    /// Follows links and determines the kind of the destination.
    pub(super) fn of(path: &Path) -> Result<Self, WriteError> {
        let io_error = |source| WriteError::Io {
            path: path.to_owned(),
            source,
        };
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => Err(WriteError::Folder {
                path: path.to_owned(),
            }),
            Ok(found) if found.is_file() && !leads_to_standard_output(path, &found) => {
                let place = fs::canonicalize(path).map_err(io_error)?;
                refuse_read_only(path, &found)?;
                Ok(Self::File {
                    identity: Some(Identity::of(&place).map_err(io_error)?),
                    path: place,
                })
            }
            Ok(_) => Ok(Self::Stream),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let place = follow_links(path).map_err(io_error)?;
                if place.file_name().is_none() || ends_in_separator(path) {
                    return Err(WriteError::NoName {
                        path: path.to_owned(),
                    });
                }
                Ok(Self::File {
                    path: absolute(&place).map_err(io_error)?,
                    identity: None,
                })
            }
            Err(error) => Err(io_error(error)),
        }
    }
}

fn ends_in_separator(path: &Path) -> bool {
    let text = path.as_os_str().as_encoded_bytes();
    text.last()
        .is_some_and(|last| std::path::is_separator(char::from(*last)))
}

/// The absolute path of a new file; links are resolved in the part of it that exists.
fn absolute(path: &Path) -> io::Result<PathBuf> {
    let path = std::path::absolute(path)?;
    for ancestor in path.ancestors().skip(1) {
        if let (Ok(known), Ok(rest)) = (fs::canonicalize(ancestor), path.strip_prefix(ancestor)) {
            return Ok(known.join(rest));
        }
    }
    Ok(path)
}

/// The end of a chain of links whose last target does not exist.
fn follow_links(path: &Path) -> io::Result<PathBuf> {
    let mut place = path.to_owned();
    for _ in 0..MAX_LINKS {
        match fs::read_link(&place) {
            Ok(next) => place = place.parent().unwrap_or(Path::new("")).join(next),
            Err(_) => return Ok(place),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

/// Refuses a file that is marked read-only and one that this user may not write.
fn refuse_read_only(path: &Path, found: &Metadata) -> Result<(), WriteError> {
    let denied = || match OpenOptions::new().write(true).open(path) {
        Ok(_) => false,
        Err(error) => error.kind() == io::ErrorKind::PermissionDenied,
    };
    if found.permissions().readonly() || denied() {
        return Err(WriteError::ReadOnly {
            path: path.to_owned(),
        });
    }
    Ok(())
}

/// The identity of a file, independent of its path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Identity(#[cfg(unix)] (u64, u64), #[cfg(not(unix))] PathBuf);

impl Identity {
    /// The identity of the file at the end of all links.
    #[cfg(unix)]
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        Ok(Self::of_metadata(&fs::metadata(path)?))
    }

    #[cfg(unix)]
    fn of_metadata(found: &Metadata) -> Self {
        use std::os::unix::fs::MetadataExt;
        Self((found.dev(), found.ino()))
    }

    /// The identity of the file at the end of all links.
    #[cfg(not(unix))]
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        fs::canonicalize(path).map(Self)
    }
}

/// Whether a path such as `/dev/stdout` is a link to the file that the standard output is
/// redirected to.
#[cfg(unix)]
fn leads_to_standard_output(path: &Path, found: &Metadata) -> bool {
    let is_link = fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink());
    is_link && output_with(&Identity::of_metadata(found)).is_some()
}

#[cfg(not(unix))]
fn leads_to_standard_output(_: &Path, _: &Metadata) -> bool {
    false
}

/// The standard output if the path leads to it, else `None`.
#[cfg(unix)]
pub(super) fn standard_output(path: &Path) -> Option<File> {
    output_with(&Identity::of(path).ok()?)
}

#[cfg(not(unix))]
pub(super) fn standard_output(_: &Path) -> Option<File> {
    None
}

#[cfg(unix)]
fn output_with(identity: &Identity) -> Option<File> {
    use std::os::fd::AsFd;
    let output = File::from(io::stdout().as_fd().try_clone_to_owned().ok()?);
    let found = output.metadata().ok()?;
    (Identity::of_metadata(&found) == *identity).then_some(output)
}

/// Gives a file the owner and group of another, if permitted.
#[cfg(unix)]
pub(super) fn keep_owner(file: &File, old: &Metadata) {
    use std::os::unix::fs::{MetadataExt, fchown};
    let is_same = |new: &Metadata| (new.uid(), new.gid()) == (old.uid(), old.gid());
    if !file.metadata().is_ok_and(|new| is_same(&new)) {
        // Only a privileged user may change the owner; otherwise the file belongs to the current
        // user.
        let _ = fchown(file, Some(old.uid()), Some(old.gid()));
    }
}

#[cfg(not(unix))]
pub(super) fn keep_owner(_: &File, _: &Metadata) {}
