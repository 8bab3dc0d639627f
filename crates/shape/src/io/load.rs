//! One door for every format.

use super::error::{Format, LoadError};
use super::geometry::{Loaded, Raw};
use super::{obj, off, pcd, ply, stl, xyz};

/// Reads a cloud or mesh. Units and frame are those of the file.
///
/// The extension names the format; when it names none, the first bytes may. Rows with NaN or
/// infinite numbers are dropped and counted; an implausible extent is a warning
/// ([`Loaded::warnings`]). Anything else that is not as its format wants it is an error with its
/// line or byte. Memory stays within a small multiple of `bytes`, whatever they claim.
pub fn read_cloud(bytes: &[u8], extension: &str) -> Result<Loaded, LoadError> {
    let extension = extension.trim_start_matches('.');
    let vrml = ["wrl", "vrml", "wrz"];
    let is_vrml = vrml.iter().any(|v| extension.eq_ignore_ascii_case(v));
    if is_vrml || bytes.starts_with(b"#VRML") {
        return Err(LoadError::Vrml);
    }
    let unsupported = || LoadError::Unsupported {
        extension: extension.to_owned(),
    };
    let format = Format::from_extension(extension)
        .or_else(|| sniff(bytes))
        .ok_or_else(unsupported)?;
    if bytes.is_empty() {
        return Err(LoadError::Empty { format });
    }
    let raw: Raw = match format {
        Format::Ply => ply::read(bytes)?,
        Format::Pcd => pcd::read(bytes)?,
        Format::Xyz => xyz::read(bytes)?,
        Format::Obj => obj::read(bytes)?,
        Format::Stl => stl::read(bytes)?,
        Format::Off => off::read(bytes)?,
    };
    Loaded::new(format, raw)
}

fn sniff(bytes: &[u8]) -> Option<Format> {
    let starts: [(&[u8], Format); 5] = [
        (b"ply", Format::Ply),
        (b"# .PCD", Format::Pcd),
        (b"VERSION", Format::Pcd),
        (b"solid", Format::Stl),
        (b"OFF", Format::Off),
    ];
    let found = starts.iter().find(|(start, _)| bytes.starts_with(start))?;
    Some(found.1)
}
