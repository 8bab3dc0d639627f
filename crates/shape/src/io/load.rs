//! One door for every format.

use super::content::recognised;
use super::error::{Format, LoadError};
use super::geometry::{Loaded, Raw};
use super::{obj, off, pcd, ply, stl, xyz};

/// Reads a cloud or mesh. Units and frame are those of the file.
///
/// The first bytes decide the format, and the extension where they leave it open. Rows with NaN or
/// infinite numbers are dropped and counted; an implausible extent is a warning
/// ([`Loaded::warnings`]). Anything else that is not as its format wants it is an error with its
/// line or byte. Memory stays within a small multiple of `bytes`, whatever they claim.
pub fn read_cloud(bytes: &[u8], extension: &str) -> Result<Loaded, LoadError> {
    let format = recognised(bytes, extension)?;
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
