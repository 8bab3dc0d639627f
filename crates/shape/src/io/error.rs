//! The formats that are read, and why bytes are refused.

use std::fmt;

use super::ply_error::PlyError;

/// A file format for clouds or meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Polygon file format: ASCII, little and big endian.
    Ply,
    /// Point Cloud Library: ASCII, binary and compressed.
    Pcd,
    /// Three numbers a line, separated by blanks, commas or semicolons.
    Xyz,
    /// Wavefront.
    Obj,
    /// Stereolithography: ASCII and binary.
    Stl,
    /// Object file format of Geomview.
    Off,
}

impl Format {
    /// The format that a file-name extension stands for, with or without the dot, in any case.
    pub fn from_extension(extension: &str) -> Option<Self> {
        let extension = extension.trim_start_matches('.').to_ascii_lowercase();
        Some(match extension.as_str() {
            "ply" => Self::Ply,
            "pcd" => Self::Pcd,
            "xyz" | "csv" | "txt" | "asc" | "pts" => Self::Xyz,
            "obj" => Self::Obj,
            "stl" => Self::Stl,
            "off" => Self::Off,
            _ => return None,
        })
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ply => "PLY",
            Self::Pcd => "PCD",
            Self::Xyz => "XYZ",
            Self::Obj => "OBJ",
            Self::Stl => "STL",
            Self::Off => "OFF",
        })
    }
}

/// Why bytes are neither a cloud nor a mesh. Lines and bytes count from 1 and from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoadError {
    /// Neither the extension nor the first bytes belong to a format that is read.
    #[error(
        "files of type `{extension}` are not supported; expected ply, pcd, xyz, csv, txt, obj, stl or off"
    )]
    Unsupported {
        /// The extension given.
        extension: String,
    },
    /// The bytes are of a kind that is known and not read.
    #[error("this is {kind}, which is not read; {advice}")]
    Foreign {
        /// What the file is.
        kind: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// The file has no bytes.
    #[error("byte 0: the file is empty; expected {format} data")]
    Empty {
        /// The format looked for.
        format: Format,
    },
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
    /// A PLY file is damaged.
    #[error(transparent)]
    Ply(#[from] PlyError),
    /// Nothing finite is left.
    #[error("the {format} file has no finite point ({dropped} rows with NaN or infinite numbers)")]
    NoPoints {
        /// The format.
        format: Format,
        /// Rows dropped.
        dropped: usize,
    },
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

    /// Bytes that are not what they should be.
    pub(super) fn byte(format: Format, byte: usize, expected: String, found: String) -> Self {
        Self::Byte {
            format,
            byte,
            expected,
            found,
        }
    }
}

/// Foreign text in one short line, between back quotes.
pub(super) fn quoted(text: &str) -> String {
    const LONGEST: usize = 60;
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
