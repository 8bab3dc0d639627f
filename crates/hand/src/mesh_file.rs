//! The vertices of a mesh file (STL or OBJ) given as bytes.

use nalgebra::Point3;
use thiserror::Error;

/// The largest mesh file accepted, in bytes.
pub(crate) const MAX_MESH_BYTES: usize = 64 << 20;
/// The largest number of vertices accepted; those of an STL count once a triangle.
pub(crate) const MAX_MESH_VERTICES: usize = 2_000_000;
const STL_HEADER: usize = 84;
const STL_TRIANGLE: usize = 50;

/// Why a mesh file was refused.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MeshFileError {
    /// Too many bytes.
    #[error("{bytes} bytes, more than {MAX_MESH_BYTES}")]
    TooLarge {
        /// How many.
        bytes: usize,
    },
    /// A binary STL whose length does not fit its triangle count.
    #[error("an STL of {triangles} triangles has {expected} bytes, this one {bytes}")]
    StlLength {
        /// The count in the header.
        triangles: u64,
        /// The length it implies.
        expected: u64,
        /// The length found.
        bytes: usize,
    },
    /// Too many vertices.
    #[error("{vertices} vertices, more than {MAX_MESH_VERTICES}")]
    TooMany {
        /// How many, or at which one reading ended.
        vertices: u64,
    },
    /// A line that cannot be read.
    #[error("line {line}: expected a vertex with three finite coordinates")]
    Line {
        /// Its number, from 1.
        line: usize,
    },
    /// A vertex with a coordinate that is no number.
    #[error("vertex {0} is not finite")]
    NotFinite(usize),
    /// No vertex at all.
    #[error("no vertices: neither STL nor OBJ")]
    Empty,
}

/// Vertices of a binary STL, an ASCII STL or an OBJ, in the file's unit and order
/// (those of an STL once a triangle).
pub fn mesh_vertices(bytes: &[u8]) -> Result<Vec<Point3<f64>>, MeshFileError> {
    if bytes.len() > MAX_MESH_BYTES {
        return Err(MeshFileError::TooLarge { bytes: bytes.len() });
    }
    let text = std::str::from_utf8(bytes).ok();
    let vertices = match text.filter(|t| looks_like_text(t)) {
        Some(text) => text_vertices(text)?,
        None => binary_stl(bytes)?,
    };
    if vertices.is_empty() {
        return Err(MeshFileError::Empty);
    }
    match vertices
        .iter()
        .position(|v| !v.coords.iter().all(|c| c.is_finite()))
    {
        Some(index) => Err(MeshFileError::NotFinite(index)),
        None => Ok(vertices),
    }
}

fn looks_like_text(text: &str) -> bool {
    text.lines().take(100_000).any(|line| {
        let mut words = line.split_ascii_whitespace();
        matches!(words.next(), Some("v" | "vertex")) && words.next().is_some()
    })
}

fn text_vertices(text: &str) -> Result<Vec<Point3<f64>>, MeshFileError> {
    let mut vertices = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let mut words = line.split_ascii_whitespace();
        if !matches!(words.next(), Some("v" | "vertex")) {
            continue;
        }
        if vertices.len() == MAX_MESH_VERTICES {
            return Err(MeshFileError::TooMany {
                vertices: vertices.len() as u64 + 1,
            });
        }
        let mut coordinate = || {
            words
                .next()
                .and_then(|w| w.parse::<f64>().ok())
                .filter(|c| c.is_finite())
                .ok_or(MeshFileError::Line { line: index + 1 })
        };
        vertices.push(Point3::new(coordinate()?, coordinate()?, coordinate()?));
    }
    Ok(vertices)
}

fn binary_stl(bytes: &[u8]) -> Result<Vec<Point3<f64>>, MeshFileError> {
    let Some(count) = bytes.get(80..STL_HEADER) else {
        return Err(MeshFileError::Empty);
    };
    let triangles = u64::from(u32::from_le_bytes([count[0], count[1], count[2], count[3]]));
    let expected = STL_HEADER as u64 + triangles * STL_TRIANGLE as u64;
    if expected != bytes.len() as u64 {
        return Err(MeshFileError::StlLength {
            triangles,
            expected,
            bytes: bytes.len(),
        });
    }
    if 3 * triangles > MAX_MESH_VERTICES as u64 {
        return Err(MeshFileError::TooMany {
            vertices: 3 * triangles,
        });
    }
    let coordinate = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    Ok(bytes[STL_HEADER..]
        .chunks_exact(STL_TRIANGLE)
        .flat_map(|triangle| triangle[12..48].chunks_exact(12))
        .map(|v| {
            Point3::new(
                coordinate(&v[0..]),
                coordinate(&v[4..]),
                coordinate(&v[8..]),
            )
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_three_forms_give_the_same_vertices() {
        let expected = [
            Point3::new(0.0, 0.0, 0.0),
            Point3::new(1.0, 0.0, 0.0),
            Point3::new(0.0, 0.5, 0.25),
        ];
        let obj = "# a\nv 0 0 0\nv 1 0 0\nv 0 0.5 0.25\nf 1 2 3\n";
        let ascii = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0.5 0.25\nendloop\nendfacet\nendsolid";
        let mut binary = vec![0u8; 80];
        binary.extend(1u32.to_le_bytes());
        binary.extend([0u8; 12]);
        for v in &expected {
            for c in v.iter() {
                binary.extend((*c as f32).to_le_bytes());
            }
        }
        binary.extend([0u8; 2]);
        for bytes in [obj.as_bytes(), ascii.as_bytes(), &binary] {
            assert_eq!(mesh_vertices(bytes).unwrap(), expected);
        }
    }

    #[test]
    fn broken_files_are_refused() {
        let mut huge = vec![0u8; 84];
        huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(matches!(
            mesh_vertices(&huge),
            Err(MeshFileError::StlLength { .. })
        ));
        assert_eq!(mesh_vertices(b""), Err(MeshFileError::Empty));
        assert_eq!(
            mesh_vertices(b"v 0 0 0\nv nan 0 0\n"),
            Err(MeshFileError::Line { line: 2 })
        );
        assert_eq!(
            mesh_vertices(b"v 0 0\n"),
            Err(MeshFileError::Line { line: 1 })
        );
    }
}
