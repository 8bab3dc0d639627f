//! The reader of all formats.

use super::content::{Content, recognise};
use super::error::LoadError;
use super::format::Format;
use super::geometry::{Loaded, Raw};
use super::{array, gltf, obj, off, pcd, ply, stl, xyz, zip};

/// Reads a cloud or mesh. Units and frame are those of the file.
///
/// The format is that of the content where it has a distinctive mark, otherwise that of the
/// extension. If the two differ, a warning says so. Rows with NaN or infinite numbers are dropped
/// and counted; an implausible extent is a warning ([`Loaded::warnings`]). Memory stays within a
/// small multiple of the size of `bytes`, regardless of the counts that they claim.
///
/// # Errors
/// A violation of the format, with its line or byte; a format that is not supported, by its name.
pub fn read_cloud(bytes: &[u8], extension: &str) -> Result<Loaded, LoadError> {
    if bytes.is_empty() {
        return Err(LoadError::Empty);
    }
    let extension = extension.trim_start_matches('.');
    let named = Format::from_extension(extension);
    let format = match (recognise(bytes), named) {
        (Content::Foreign(kind, advice), _) => return Err(LoadError::Foreign { kind, advice }),
        (Content::Known(format), _) | (Content::Unknown, Some(format)) => Some(format),
        // Columns of numbers are also the body of an OFF without its keyword.
        (Content::Likely(Format::Xyz), Some(Format::Off)) => named,
        (Content::Likely(format), _) => Some(format),
        (Content::Unknown, None) => foreign_by_name(extension)?,
    };
    let format = format.ok_or_else(|| LoadError::Unsupported {
        extension: extension.to_owned(),
    })?;
    let raw: Raw = match format {
        Format::Ply => ply::read(bytes)?,
        Format::Pcd => pcd::read(bytes)?,
        Format::Xyz => xyz::read(bytes)?,
        Format::Obj => obj::read(bytes)?,
        Format::Stl => stl::read(bytes)?,
        Format::Off => off::read(bytes)?,
        Format::Gltf => gltf::read(bytes)?,
        Format::Npy => array::read(bytes)?,
        Format::Npz => zip::read(bytes)?,
    };
    Ok(Loaded::new(format, raw)?.named(named))
}

/// A description of bytes of a known kind that is not supported: a Git LFS pointer, a web page, a
/// format of another kind of program.
///
/// Readers of other files use it to name the cause of an error.
pub fn foreign_kind(bytes: &[u8]) -> Option<&'static str> {
    match recognise(bytes) {
        Content::Foreign(kind, _) => Some(kind),
        _ => None,
    }
}

/// Extensions of formats whose content has no mark.
fn foreign_by_name(extension: &str) -> Result<Option<Format>, LoadError> {
    let (kind, advice) = match extension.to_ascii_lowercase().as_str() {
        "wrl" | "vrml" | "wrz" => ("a VRML file", "save it as STL, OBJ, PLY, OFF or GLB"),
        "dae" => (
            "a Collada (DAE) file",
            "save it as STL, OBJ, PLY, OFF or GLB",
        ),
        "ptx" => ("a PTX scan", "save it as PLY, PCD or XYZ"),
        _ => return Ok(None),
    };
    Err(LoadError::Foreign { kind, advice })
}
