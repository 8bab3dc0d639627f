//! The vertices of a collision mesh given as bytes, by the reader of `shape`.

mod collada;

use nalgebra::Point3;
use shape::io::{Geometry, LoadError, read_cloud};

/// The largest mesh file accepted, in bytes.
pub(crate) const MAX_MESH_BYTES: usize = 64 << 20;
/// The largest number of vertices accepted.
pub(crate) const MAX_MESH_VERTICES: usize = 2_000_000;

/// Why a mesh file was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshFileError {
    /// Too many bytes.
    #[error("{bytes} bytes, more than {MAX_MESH_BYTES}")]
    TooLarge {
        /// How many.
        bytes: usize,
    },
    /// Too many vertices.
    #[error("{vertices} vertices, more than {MAX_MESH_VERTICES}")]
    TooMany {
        /// How many.
        vertices: usize,
    },
    /// Vertices with coordinates that are not finite.
    #[error("{vertices} vertices are not finite")]
    NotFinite {
        /// How many.
        vertices: usize,
    },
    /// A Collada document without usable geometry.
    #[error("{0}")]
    Collada(String),
    /// The file is damaged, has an unsupported format, or is not a mesh.
    #[error(transparent)]
    Load(#[from] LoadError),
}

/// Vertices of a mesh that a face uses, in the file's unit and order; all vertices of a file without
/// faces. A Collada document (DAE) gives the vertices of its scene in metres.
///
/// The format is recognised by the content; where that is ambiguous, by the file name `name`
/// ([`shape::io::read_cloud`]).
///
/// # Errors
/// The bytes are not a mesh, or too large.
pub fn mesh_vertices(bytes: &[u8], name: &str) -> Result<Vec<Point3<f64>>, MeshFileError> {
    if bytes.len() > MAX_MESH_BYTES {
        return Err(MeshFileError::TooLarge { bytes: bytes.len() });
    }
    let vertices = if collada::is_collada(bytes) {
        collada::vertices(bytes).map_err(MeshFileError::Collada)?
    } else {
        of_mesh_format(bytes, name)?
    };
    if vertices.len() > MAX_MESH_VERTICES {
        return Err(MeshFileError::TooMany {
            vertices: vertices.len(),
        });
    }
    Ok(vertices)
}

/// The vertices of a file that the reader of clouds and meshes knows.
fn of_mesh_format(bytes: &[u8], name: &str) -> Result<Vec<Point3<f64>>, MeshFileError> {
    let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
    let loaded = read_cloud(bytes, extension)?;
    if loaded.dropped > 0 {
        return Err(MeshFileError::NotFinite {
            vertices: loaded.dropped,
        });
    }
    Ok(match loaded.geometry {
        Geometry::Points(points) => points,
        Geometry::Mesh(mesh) => mesh.vertices,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXPECTED: [Point3<f64>; 3] = [
        Point3::new(0.0, 0.0, 0.0),
        Point3::new(1.0, 0.0, 0.0),
        Point3::new(0.0, 0.5, 0.25),
    ];

    fn binary_stl() -> Vec<u8> {
        let mut binary = vec![0u8; 80];
        binary.extend(1u32.to_le_bytes());
        binary.extend([0u8; 12]);
        for v in &EXPECTED {
            for c in v.iter() {
                binary.extend((*c as f32).to_le_bytes());
            }
        }
        binary.extend([0u8; 2]);
        binary
    }

    #[test]
    fn an_empty_collada_file_is_named_as_what_it_is() {
        let empty = b"<?xml version=\"1.0\"?><COLLADA version=\"1.4.1\"><asset/></COLLADA>";
        let error = mesh_vertices(empty, "p.dae").unwrap_err();
        assert!(error.to_string().contains("DAE"), "{error}");
    }

    #[test]
    fn the_content_decides_the_format() {
        let obj = "# a\nv 0 0 0\nv 1 0 0\nv 0 0.5 0.25\nf 1 2 3\n";
        let ascii = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0.5 0.25\nendloop\nendfacet\nendsolid";
        let off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 0.5 0.25\n3 0 1 2\n";
        let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 0.5 0.25\n3 0 1 2\n";
        let binary = binary_stl();
        let texts = [obj, ascii, off, ply].map(str::as_bytes);
        for bytes in texts.into_iter().chain([&binary[..]]) {
            for name in ["p.stl", "package://a/b.STL", "c"] {
                assert_eq!(mesh_vertices(bytes, name).unwrap(), EXPECTED);
            }
        }
    }

    #[test]
    fn vertices_that_no_face_uses_do_not_count() {
        let obj = b"v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 0.5 0.25\nf 2 3 4\n";
        assert_eq!(mesh_vertices(obj, "p.obj").unwrap(), EXPECTED);
        assert_eq!(mesh_vertices(b"v 9 9 9\n", "p.obj").unwrap().len(), 1);
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        let refused = |text: &str| mesh_vertices(text.as_bytes(), "p.stl").unwrap_err();
        assert!(matches!(
            refused("v 0 0 0\nv 0 0\n"),
            MeshFileError::Load(_)
        ));
        assert!(matches!(refused(""), MeshFileError::Load(_)));
        let mut huge = vec![0u8; 84];
        huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(mesh_vertices(&huge, "p.stl").is_err());
    }
}
