//! One door for every format.

use super::content::{Content, recognise};
use super::error::LoadError;
use super::format::Format;
use super::geometry::{Loaded, Raw};
use super::{array, gltf, obj, off, pcd, ply, stl, xyz, zip};

/// Reads a cloud or mesh. Units and frame are those of the file.
///
/// The content decides on the format where it has a mark of its own, else the extension does. A
/// name that says another format is a warning. Rows with NaN or infinite numbers are dropped and
/// counted; an implausible extent is a warning ([`Loaded::warnings`]). Memory stays within a small
/// multiple of `bytes`, whatever they claim.
///
/// # Errors
/// Anything that is not as its format wants it, with its line or byte; a format that is not read,
/// by its name.
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

/// What the bytes are, if they are of a kind that is known and not read: a Git LFS pointer, a web page,
/// a format of another kind of program.
///
/// For readers of other files, which can then name the true cause.
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
