//! A temporary file that becomes the result when it is complete.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::target;

/// A complete file under a temporary name; it is removed on drop unless it was renamed.
pub(super) struct Part {
    path: PathBuf,
    renamed: bool,
}

impl Part {
    /// Writes a file in `folder` and flushes it to the disk. It gets the owner and the permissions
    /// of the file `replaced`, if that exists.
    pub(super) fn write(folder: &Path, bytes: &[u8], replaced: &Path) -> io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!(".moduli-{}-{count}.part", std::process::id());
        let path = folder.join(name);
        if let Some(mut file) = unnamed(folder) {
            fill(&mut file, bytes, replaced)?;
            if link(&file, &path).is_ok() {
                return Ok(Self {
                    path,
                    renamed: false,
                });
            }
        }
        let mut file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&path)?;
        let part = Self {
            path,
            renamed: false,
        };
        fill(&mut file, bytes, replaced)?;
        Ok(part)
    }

    /// Renames the file to `path`.
    pub(super) fn rename(mut self, path: &Path) -> io::Result<()> {
        fs::rename(&self.path, path)?;
        self.renamed = true;
        Ok(())
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        if !self.renamed {
            // Only the first error is reported.
            let _ = fs::remove_file(&self.path);
        }
    }
}

fn fill(file: &mut File, bytes: &[u8], replaced: &Path) -> io::Result<()> {
    file.write_all(bytes)?;
    if let Ok(old) = fs::metadata(replaced) {
        target::keep_owner(file, &old);
        file.set_permissions(old.permissions())?;
    }
    file.sync_all()
}

/// An unnamed file in a folder; `None` if the file system does not support unnamed files.
#[cfg(target_os = "linux")]
fn unnamed(folder: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags, open};
    let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
    open(folder, flags, Mode::from_raw_mode(0o666))
        .ok()
        .map(File::from)
}

/// Gives an unnamed file its first name.
#[cfg(target_os = "linux")]
fn link(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let open_file = format!("/proc/self/fd/{}", file.as_raw_fd());
    linkat(CWD, open_file, CWD, path, AtFlags::SYMLINK_FOLLOW)?;
    Ok(())
}

#[cfg(not(target_os = "linux"))]
fn unnamed(_: &Path) -> Option<File> {
    None
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}
