//! Output of the program: lines of text and files.

use std::io::{ErrorKind, IsTerminal, Write};
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use run::WriteError;
use run::npy::Table;
use serde::Serialize;

use crate::failure::Failure;
use crate::files;

/// A line of the result.
///
/// A closed pipe (`moduli … | head`) is no error, because files are still to be written. If the
/// line cannot be written for another reason, the program ends.
pub(crate) fn say(line: impl AsRef<str>) {
    match writeln!(std::io::stdout().lock(), "{}", line.as_ref()) {
        Ok(()) => {}
        Err(e) if e.kind() == ErrorKind::BrokenPipe => {}
        Err(e) => {
            tell(&format!("error: cannot write the result: {e}"));
            std::process::exit(1);
        }
    }
}

/// A line on standard error, which may be closed.
fn tell(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// A result as one line of JSON.
pub(crate) fn say_json(value: &impl Serialize) -> Result<(), Failure> {
    let line = serde_json::to_string(value)
        .map_err(|e| Failure::other(format!("cannot write the result as JSON: {e}")))?;
    say(line);
    Ok(())
}

/// The text of a JSON file.
pub(crate) fn encode(value: &impl Serialize) -> Result<Vec<u8>, Failure> {
    serde_json::to_vec_pretty(value)
        .map_err(|e| Failure::other(format!("cannot encode the result as JSON: {e}")))
}

/// The bytes of a `.npy` file of whole rows.
pub(crate) fn npy(columns: usize, values: Vec<f64>) -> Result<Vec<u8>, Failure> {
    let count = values.len();
    Table::new(columns, values)
        .map(|table| table.to_npy())
        .ok_or_else(|| Failure::other(format!("{count} numbers do not fill rows of {columns}")))
}

/// A warning on standard error.
pub(crate) fn warn(line: impl AsRef<str>) {
    tell(&format!("warning: {}", line.as_ref()));
}

/// The message of a program that failed.
pub(crate) fn report_failure(failure: &Failure) {
    tell(&format!("error: {}", failure.message));
}

/// A progress bar on a terminal, nothing elsewhere.
pub(crate) fn progress(quiet: bool, total: usize, what: &str) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(total as u64);
    if let Ok(style) = ProgressStyle::with_template("{msg:24} {wide_bar} {pos}/{len}, {eta} left") {
        bar.set_style(style);
    }
    bar.set_message(what.to_owned());
    bar
}

/// Writes a whole result. A file that the program has read is never overwritten.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    Ok(run::write(path, bytes, &files::read_so_far())?)
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        if error.is_usage() {
            Self::usage(error.to_string())
        } else {
            Self::other(error.to_string())
        }
    }
}
