//! The format of a file by its first bytes, regardless of its name.

use super::format::Format;
use super::stl;

/// What the content is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content {
    /// A supported format, identified by a mark that no other format has.
    Known(Format),
    /// A supported format, guessed from its lines; the name of the file takes precedence.
    Likely(Format),
    /// A recognised format that is not supported, with advice.
    Foreign(&'static str, &'static str),
    /// Nothing is recognised.
    Unknown,
}

/// Number of bytes examined.
const HEAD: usize = 4096;
const CONVERT_MESH: &str = "save it as STL, OBJ, PLY, OFF or GLB";
const CONVERT_CLOUD: &str = "save it as PLY, PCD or XYZ";
const NO_OBJECT: &str = "expected a cloud or a mesh";
const DOWNLOAD: &str = "download the file itself, not the page that shows it";

/// Marks at the first byte.
const MAGIC: [(&[u8], Content); 25] = [
    (b"\x93NUMPY", Content::Known(Format::Npy)),
    (b"PK\x03\x04", Content::Known(Format::Npz)),
    (b"PK\x05\x06", Content::Known(Format::Npz)),
    (b"glTF", Content::Known(Format::Gltf)),
    (b"# .PCD", Content::Known(Format::Pcd)),
    (
        b"version https://git-lfs.github.com",
        Content::Foreign(
            "a Git LFS pointer",
            "fetch the file itself with `git lfs pull`",
        ),
    ),
    (
        b"LASF",
        Content::Foreign("a LAS or LAZ cloud", CONVERT_CLOUD),
    ),
    (b"ASTM-E57", Content::Foreign("an E57 cloud", CONVERT_CLOUD)),
    (b"#VRML", Content::Foreign("a VRML file", CONVERT_MESH)),
    (b"#X3D", Content::Foreign("an X3D file", CONVERT_MESH)),
    (
        b"ISO-10303-21",
        Content::Foreign("a STEP model", CONVERT_MESH),
    ),
    (
        b"Kaydara FBX",
        Content::Foreign("an FBX scene", CONVERT_MESH),
    ),
    (
        b"BLENDER",
        Content::Foreign("a Blender scene", CONVERT_MESH),
    ),
    (b"DRACO", Content::Foreign("a Draco mesh", CONVERT_MESH)),
    (b"\x89HDF", Content::Foreign("an HDF5 file", CONVERT_CLOUD)),
    (b"\x89PNG", Content::Foreign("a PNG picture", NO_OBJECT)),
    (
        b"\xFF\xD8\xFF",
        Content::Foreign("a JPEG picture", NO_OBJECT),
    ),
    (b"%PDF", Content::Foreign("a PDF document", NO_OBJECT)),
    (
        b"\x1f\x8b",
        Content::Foreign("compressed by gzip", "unpack it first"),
    ),
    (
        b"MATLAB 5.0",
        Content::Foreign("a MATLAB file", CONVERT_CLOUD),
    ),
    (b"#ROSBAG", Content::Foreign("a ROS bag", CONVERT_CLOUD)),
    (
        b"\x80\x04\x95",
        Content::Foreign("a Python pickle", CONVERT_CLOUD),
    ),
    (b"PAR1", Content::Foreign("a Parquet table", CONVERT_CLOUD)),
    (b"PXR-USDC", Content::Foreign("a USD scene", CONVERT_MESH)),
    (b"#usda", Content::Foreign("a USD scene", CONVERT_MESH)),
];

/// Elements of XML, and what a file with such an element is.
const XML: [(&str, &str, &str); 8] = [
    ("<collada", "a Collada (DAE) file", CONVERT_MESH),
    ("<!doctype html", "a web page (HTML)", DOWNLOAD),
    ("<html", "a web page (HTML)", DOWNLOAD),
    ("<robot", "a URDF", NO_OBJECT),
    ("<mujoco", "an MJCF model of MuJoCo", NO_OBJECT),
    ("<sdf", "an SDF model", NO_OBJECT),
    ("<x3d", "an X3D file", CONVERT_MESH),
    ("<vtkfile", "a VTK file", CONVERT_MESH),
];

/// Recognises the content by its first bytes.
pub(super) fn recognise(bytes: &[u8]) -> Content {
    let wide = bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF");
    if wide {
        return Content::Foreign("text in UTF-16", "save it as UTF-8");
    }
    // The words of the header of a binary STL are free.
    if stl::is_binary(bytes) {
        return Content::Known(Format::Stl);
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if let Some((_, content)) = MAGIC.iter().find(|(mark, _)| bytes.starts_with(mark)) {
        return *content;
    }
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD)]);
    let text = head.trim_start();
    let lower = text.to_ascii_lowercase();
    if lower.starts_with('<') {
        let found = XML.iter().find(|(mark, _, _)| lower.contains(mark));
        let (_, what, advice) = found.unwrap_or(&("", "an XML file", NO_OBJECT));
        return Content::Foreign(what, advice);
    }
    if lower.starts_with("# vtk datafile") {
        return Content::Foreign("a VTK file", CONVERT_MESH);
    }
    if lower.starts_with('{') && lower.contains("\"asset\"") {
        return Content::Known(Format::Gltf);
    }
    text_format(text, &lower)
}

fn text_format(text: &str, lower: &str) -> Content {
    let first = text.split(['\n', '\r']).next().unwrap_or_default();
    let first = first.trim_end();
    if first.eq_ignore_ascii_case("ply") {
        return Content::Known(Format::Ply);
    }
    // A binary STL may begin with any words.
    let solid = lower.starts_with("solid") && !has_binary(text);
    if solid && (lower.contains("facet") || lower.contains("endsolid")) {
        return Content::Known(Format::Stl);
    }
    let has_line = |key: &str| text.lines().any(|l| l.starts_with(key));
    let fields = has_line("FIELDS ") || has_line("COLUMNS ");
    if fields && has_line("DATA ") {
        return Content::Known(Format::Pcd);
    }
    if !has_binary(text) && is_off(first) {
        return Content::Known(Format::Off);
    }
    likely(text)
}

fn has_binary(text: &str) -> bool {
    text.chars().any(|c| c.is_control() && !c.is_whitespace())
}

/// Whether a line is the keyword of OFF, with the counts behind it or not.
fn is_off(line: &str) -> bool {
    let letters = line.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let word = line[..line.len() - letters.len()].to_ascii_uppercase();
    let known = [
        "OFF", "COFF", "NOFF", "CNOFF", "STOFF", "NCOFF", "STCOFF", "STNOFF",
    ];
    let counts = |c: char| c.is_ascii_digit() || c.is_whitespace();
    let rest = letters.split('#').next().unwrap_or_default();
    known.contains(&word.as_str()) && rest.chars().all(counts)
}

/// OBJ or columns of numbers, if all of the first lines look like it.
fn likely(text: &str) -> Content {
    let lines = text.lines().map(str::trim);
    let lines = lines.filter(|l| !l.is_empty() && !l.starts_with('#') && !l.starts_with("//"));
    // The last line may be cut off.
    let lines: Vec<&str> = lines.take(20).collect();
    let words = ["v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl", "l"];
    let obj = |l: &&str| words.contains(&l.split_whitespace().next().unwrap_or_default());
    let has_vertex = lines.iter().any(|l| l.starts_with("v "));
    if has_vertex && lines.iter().all(obj) {
        return Content::Likely(Format::Obj);
    }
    let numbers = |l: &&str| {
        let fields: Vec<&str> = l
            .split([',', ';', ' ', '\t'])
            .filter(|w| !w.is_empty())
            .collect();
        fields.len() >= 3 && fields.iter().all(|w| w.parse::<f64>().is_ok())
    };
    let body = lines.get(1..lines.len().saturating_sub(1));
    match body {
        Some(body) if !body.is_empty() && body.iter().all(numbers) => Content::Likely(Format::Xyz),
        _ => Content::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_is_recognised_without_its_name() {
        let cases: [(&[u8], Content); 9] = [
            (b"\xEF\xBB\xBFply\r\nformat", Content::Known(Format::Ply)),
            (b"SOLID a\nFACET", Content::Known(Format::Stl)),
            (b"OFF262 520 0\n0 0 0", Content::Known(Format::Off)),
            (b"off\n3 1 0\n", Content::Known(Format::Off)),
            (
                b"COLUMNS x y z\nPOINTS 1\nDATA ascii\n",
                Content::Known(Format::Pcd),
            ),
            (b"v 0 0 0\nv 1 0 0\nf 1 2 1\n", Content::Likely(Format::Obj)),
            (
                b"x y z\n1 2 3\n4 5 6\n7 8 9\n",
                Content::Likely(Format::Xyz),
            ),
            (b"office hours", Content::Unknown),
            (b"", Content::Unknown),
        ];
        for (bytes, content) in cases {
            assert_eq!(recognise(bytes), content);
        }
    }

    #[test]
    fn foreign_files_are_named() {
        let cases: [(&[u8], &str); 4] = [
            (b"version https://git-lfs.github.com/spec/v1\n", "Git LFS"),
            (b"\n<!DOCTYPE html><html>", "HTML"),
            (b"<?xml version=\"1.0\"?><COLLADA xmlns=\"\">", "Collada"),
            (b"\xFF\xFEa\0", "UTF-16"),
        ];
        for (bytes, name) in cases {
            assert!(matches!(recognise(bytes), Content::Foreign(what, _) if what.contains(name)));
        }
    }
}
