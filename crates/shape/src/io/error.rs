//! Why bytes are refused.

use super::format::Format;

/// Why bytes are neither a cloud nor a mesh. Lines are counted from 1, bytes from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoadError {
    /// Neither the extension nor the content belongs to a format that is read.
    #[error("{}; expected {}", unsupported(.extension), Format::EXTENSIONS)]
    Unsupported {
        /// The extension given.
        extension: String,
    },
    /// The content is recognised and belongs to a format that is not read.
    #[error("this is {kind}, which is not read; {advice}")]
    Foreign {
        /// What the file is.
        kind: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// The file has no bytes.
    #[error("byte 0: the file is empty; expected a cloud or a mesh")]
    Empty,
    /// A line of a text format cannot be understood.
    #[error("{format} line {line}: expected {expected}, found {found}")]
    Line {
        /// The format.
        format: Format,
        /// Line number, from 1.
        line: usize,
        /// What the line should hold.
        expected: String,
        /// What it holds.
        found: String,
    },
    /// Bytes of a binary format cannot be understood.
    #[error("{format} byte {byte}: expected {expected}, found {found}")]
    Byte {
        /// The format.
        format: Format,
        /// Offset, from 0.
        byte: usize,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The file is well formed and holds something that is not read.
    #[error("the {format} file has {what}; expected {expected}")]
    Content {
        /// The format.
        format: Format,
        /// What was found.
        what: String,
        /// What is read.
        expected: String,
    },
    /// Nothing finite is left.
    #[error("the {format} file has no finite point ({dropped} rows with NaN or infinite numbers)")]
    NoPoints {
        /// The format.
        format: Format,
        /// Rows dropped.
        dropped: usize,
    },
}

fn unsupported(extension: &str) -> String {
    if extension.is_empty() {
        return "the content is of no format that is read".to_owned();
    }
    format!("files of type `{extension}` are not supported")
}

impl LoadError {
    /// A line that is not what it should be; `found` is shortened.
    pub(super) fn line(format: Format, line: usize, expected: &str, found: &str) -> Self {
        Self::Line {
            format,
            line,
            expected: expected.to_owned(),
            found: quoted(found),
        }
    }

    /// A text that ends too early, at its last line.
    pub(super) fn end_of_text(format: Format, line: usize, expected: &str) -> Self {
        Self::Line {
            format,
            line,
            expected: expected.to_owned(),
            found: "the end of the file".to_owned(),
        }
    }

    /// Bytes that are not what they should be.
    pub(super) fn byte(format: Format, byte: usize, expected: String, found: String) -> Self {
        Self::Byte {
            format,
            byte,
            expected,
            found,
        }
    }

    /// Something that is well formed and not read.
    pub(super) fn content(format: Format, what: impl Into<String>, expected: &str) -> Self {
        Self::Content {
            format,
            what: what.into(),
            expected: expected.to_owned(),
        }
    }
}

/// Foreign text in one short line, between back quotes.
pub(super) fn quoted(text: &str) -> String {
    const LONGEST: usize = 80;
    if text.is_empty() {
        return "nothing".to_owned();
    }
    let clean = text.chars().map(|c| if c.is_control() { '?' } else { c });
    let short: String = clean.take(LONGEST).collect();
    let more = if text.chars().nth(LONGEST).is_some() {
        "…"
    } else {
        ""
    };
    format!("`{short}{more}`")
}
