//! Which format bytes have: what they begin with counts more than the name of their file.

use super::error::{Format, LoadError};

/// Bytes among which the kind of a file shows.
const HEAD: usize = 1024;

/// The format of a file by its first bytes; by its extension where they leave it open.
///
/// # Errors
/// The file is of a kind that is not read, such as a Git LFS pointer or a web page, or of none that is
/// known.
pub(super) fn recognised(bytes: &[u8], extension: &str) -> Result<Format, LoadError> {
    let extension = extension.trim_start_matches('.');
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD)]).to_ascii_lowercase();
    let head = head.trim_start_matches('\u{feff}').trim_start();
    if is_binary_stl(bytes) {
        return Ok(Format::Stl);
    }
    refuse_foreign(head, extension)?;
    let by_name = Format::from_extension(extension);
    let begins = [
        ("ply\n", Format::Ply),
        ("ply\r", Format::Ply),
        ("# .pcd", Format::Pcd),
        ("solid", Format::Stl),
    ];
    let by_content = begins.iter().find(|(start, _)| head.starts_with(start));
    if let Some((_, format)) = by_content {
        return Ok(*format);
    }
    // These words may begin lines of plain text, so a name that says text counts more.
    if !matches!(by_name, Some(Format::Xyz | Format::Obj)) {
        let lines = || bytes.split(|byte| *byte == b'\n');
        if head.starts_with("off") {
            return Ok(Format::Off);
        }
        if by_name != Some(Format::Pcd) && lines().any(|line| line.starts_with(b"v ")) {
            return Ok(Format::Obj);
        }
        if by_name.is_none() && head.starts_with("version") {
            return Ok(Format::Pcd);
        }
    }
    by_name.ok_or_else(|| LoadError::Unsupported {
        extension: extension.to_owned(),
    })
}

/// Kinds of files that are known and not read, with their true names.
fn refuse_foreign(head: &str, extension: &str) -> Result<(), LoadError> {
    let foreign = |kind, advice| Err(LoadError::Foreign { kind, advice });
    if head.starts_with("version https://git-lfs") {
        return foreign(
            "a Git LFS pointer",
            "fetch the file itself with `git lfs pull`",
        );
    }
    if head.starts_with("<!doctype html") || head.starts_with("<html") {
        return foreign("a web page (HTML)", "download the file itself");
    }
    let convert = "convert it to PLY, OBJ, STL or OFF";
    if head.contains("<collada") {
        return foreign("a Collada (DAE) file", convert);
    }
    if head.starts_with("gltf") {
        return foreign("a binary glTF (GLB) file", convert);
    }
    let vrml = ["wrl", "vrml", "wrz"];
    if head.starts_with("#vrml") || vrml.iter().any(|v| extension.eq_ignore_ascii_case(v)) {
        return foreign("a VRML file", convert);
    }
    Ok(())
}

/// Whether the length fits the number of triangles after the header of a binary STL.
fn is_binary_stl(bytes: &[u8]) -> bool {
    const HEADER: usize = 84;
    const TRIANGLE: u64 = 50;
    let Some(&[a, b, c, d]) = bytes.get(HEADER - 4..HEADER).and_then(<[u8]>::first_chunk) else {
        return false;
    };
    let triangles = u64::from(u32::from_le_bytes([a, b, c, d]));
    HEADER as u64 + TRIANGLE * triangles == bytes.len() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_content_counts_more_than_the_name() {
        let cases: [(&[u8], &str, Format); 8] = [
            (b"ply\nformat ascii 1.0\n", "stl", Format::Ply),
            (b"# .PCD v0.7\n", "xyz", Format::Pcd),
            (b"solid x\nfacet", "obj", Format::Stl),
            (b"OFF\n3 1 0\n", "stl", Format::Off),
            (b"# a\nv 0 0 0\n", "stl", Format::Obj),
            (b"v 0 0 0\n", "", Format::Obj),
            (b"offset x y\n1 2 3\n", "txt", Format::Xyz),
            (b"1 2 3\n", ".CSV", Format::Xyz),
        ];
        for (bytes, extension, format) in cases {
            assert_eq!(recognised(bytes, extension), Ok(format), "{extension}");
        }
        let mut binary = vec![0u8; 84 + 50];
        binary[..5].copy_from_slice(b"solid");
        binary[80] = 1;
        assert_eq!(recognised(&binary, "obj"), Ok(Format::Stl));
    }

    #[test]
    fn what_is_not_read_has_its_true_name() {
        let said = |text: &str, extension| {
            recognised(text.as_bytes(), extension)
                .unwrap_err()
                .to_string()
        };
        let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n";
        assert!(said(pointer, "stl").contains("git lfs pull"));
        assert!(said("\n<!DOCTYPE html>\n<html>", "ply").contains("web page"));
        assert!(said("<?xml version=\"1.0\"?>\n<COLLADA>", "dae").contains("DAE"));
        assert!(said("#VRML V2.0 utf8", "ply").contains("VRML"));
        assert!(said("1 2 3", "las").contains("`las`"));
    }
}
