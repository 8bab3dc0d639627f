//! The formats that are read.

use std::fmt;

/// A file format for clouds or meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Polygon file format: text, little and big endian.
    Ply,
    /// Point Cloud Library: text, binary and compressed.
    Pcd,
    /// One point per line, in columns.
    Xyz,
    /// Wavefront.
    Obj,
    /// Stereolithography: text and binary.
    Stl,
    /// Object file format of Geomview.
    Off,
    /// glTF 2.0, as text or as one binary file (GLB).
    Gltf,
    /// An array of NumPy.
    Npy,
    /// An archive of NumPy arrays.
    Npz,
}

impl Format {
    /// Every file-name extension that names a format.
    pub const EXTENSIONS: &'static str =
        "ply, pcd, xyz, xyzn, xyzrgb, pts, csv, txt, asc, obj, stl, off, glb, gltf, npy or npz";

    /// The format that a file-name extension stands for, with or without the dot, in any case.
    pub fn from_extension(extension: &str) -> Option<Self> {
        let extension = extension.trim_start_matches('.').to_ascii_lowercase();
        Some(match extension.as_str() {
            "ply" => Self::Ply,
            "pcd" => Self::Pcd,
            "xyz" | "xyzn" | "xyzrgb" | "pts" | "csv" | "tsv" | "txt" | "asc" => Self::Xyz,
            "obj" => Self::Obj,
            "stl" => Self::Stl,
            "off" => Self::Off,
            "glb" | "gltf" => Self::Gltf,
            "npy" => Self::Npy,
            "npz" => Self::Npz,
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
            Self::Gltf => "glTF",
            Self::Npy => "NPY",
            Self::Npz => "NPZ",
        })
    }
}
