//! Failures and their exit codes.

use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;

use crate::files;

/// A failure with its message and its exit code (2 usage, 3 input, 4 numbers, 1 anything else).
#[derive(Debug)]
pub(crate) struct Failure {
    code: u8,
    /// One sentence: what, where, what was expected.
    pub(crate) message: String,
}

impl Failure {
    /// The command line is invalid.
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self::new(2, message)
    }

    /// A file is invalid.
    pub(crate) fn input(path: &Path, reason: impl Display) -> Self {
        if files::is_standard_input(path) {
            return Self::new(3, format!("standard input: {reason}"));
        }
        Self::new(3, format!("{}: {reason}", path.display()))
    }

    /// Refused on numerical grounds: no valid surface, no closed grasp.
    pub(crate) fn refused(message: impl Into<String>) -> Self {
        Self::new(4, message)
    }

    /// The library inside the program is damaged.
    pub(crate) fn library(error: impl Display) -> Self {
        Self::other(format!("the built-in library: {error}"))
    }

    /// Anything else, such as a full disk.
    pub(crate) fn other(message: impl Into<String>) -> Self {
        Self::new(1, message)
    }

    fn new(code: u8, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
        }
    }

    /// The summary when some of several inputs failed, with the exit code of the first.
    pub(crate) fn all(failures: Vec<Self>) -> Result<(), Self> {
        let Some(code) = failures.first().map(|f| f.code) else {
            return Ok(());
        };
        let messages: Vec<String> = failures.into_iter().map(|f| f.message).collect();
        Err(Self::new(code, messages.join("\nerror: ")))
    }

    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(self.code)
    }
}
