//! PLY: ASCII and both binary orders, any extra properties.

use std::borrow::Cow;
use std::io::Write;

use nalgebra::Point3;
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};

use crate::triangle_mesh::TriangleMesh;

/// Why bytes are not a usable PLY file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlyError {
    /// The file is not PLY, or is damaged.
    #[error("not a readable PLY file: {reason}")]
    Parse {
        /// What the parser found.
        reason: String,
    },
    /// There is no vertex element.
    #[error("the PLY file has no element `vertex`")]
    NoVertices,
    /// A vertex lacks a coordinate.
    #[error("vertex {index} of the PLY file has no number `{property}`")]
    Coordinate {
        /// Which vertex.
        index: usize,
        /// x, y or z.
        property: &'static str,
    },
}

/// Vertices of a PLY file; rows with NaN or infinite coordinates are dropped and counted.
#[derive(Clone, Debug, PartialEq)]
pub struct PlyPoints {
    /// Finite vertices, in the file's unit and order.
    pub points: Vec<Point3<f64>>,
    /// How many rows were dropped.
    pub dropped: usize,
}

/// Reads the vertices of a PLY file.
pub fn read_ply(bytes: &[u8]) -> Result<PlyPoints, PlyError> {
    let parser = Parser::<DefaultElement>::new();
    let bytes = without_nan_words(bytes);
    let mut reader = bytes.as_ref();
    let ply = parser
        .read_ply(&mut reader)
        .map_err(|error| PlyError::Parse {
            reason: error.to_string(),
        })?;
    let vertices = ply.payload.get("vertex").ok_or(PlyError::NoVertices)?;
    let mut points = Vec::with_capacity(vertices.len());
    for (index, vertex) in vertices.iter().enumerate() {
        let coordinate = |property: &'static str| {
            vertex
                .get(property)
                .and_then(number)
                .ok_or(PlyError::Coordinate { index, property })
        };
        points.push(Point3::new(
            coordinate("x")?,
            coordinate("y")?,
            coordinate("z")?,
        ));
    }
    let read = points.len();
    points.retain(|p| p.iter().all(|x| x.is_finite()));
    Ok(PlyPoints {
        dropped: read - points.len(),
        points,
    })
}

/// ASCII bodies with `nan` and `inf` rewritten as numbers that overflow to infinity.
///
/// Scanners write such rows, but the parser's grammar has only digits.
fn without_nan_words(bytes: &[u8]) -> Cow<'_, [u8]> {
    const END: &[u8] = b"end_header";
    let header = &bytes[..bytes.len().min(64 * 1024)];
    let ascii = header.windows(12).any(|w| w == b"format ascii");
    let body = header.windows(END.len()).position(|w| w == END);
    let (true, Some(body)) = (ascii, body) else {
        return Cow::Borrowed(bytes);
    };
    let (header, body) = bytes.split_at(body + END.len());
    let mut out = header.to_vec();
    for (i, word) in body.split(|b| *b == b' ' || *b == b'\t').enumerate() {
        if i > 0 {
            out.push(b' ');
        }
        // The last word of a line takes the line's end and the next line's first word with it.
        for (j, part) in word.split(|b| *b == b'\n').enumerate() {
            if j > 0 {
                out.push(b'\n');
            }
            out.extend_from_slice(overflowing(part));
        }
    }
    Cow::Owned(out)
}

fn overflowing(word: &[u8]) -> &[u8] {
    let bare = word.strip_suffix(b"\r").unwrap_or(word);
    let bare = bare.strip_prefix(b"-").unwrap_or(bare);
    let odd = ["nan", "nan(ind)", "inf", "infinity"];
    match std::str::from_utf8(bare) {
        Ok(text) if odd.iter().any(|o| text.eq_ignore_ascii_case(o)) => b"1e999",
        _ => word,
    }
}

fn number(property: &Property) -> Option<f64> {
    match *property {
        Property::Char(v) => Some(f64::from(v)),
        Property::UChar(v) => Some(f64::from(v)),
        Property::Short(v) => Some(f64::from(v)),
        Property::UShort(v) => Some(f64::from(v)),
        Property::Int(v) => Some(f64::from(v)),
        Property::UInt(v) => Some(f64::from(v)),
        Property::Float(v) => Some(f64::from(v)),
        Property::Double(v) => Some(v),
        _ => None,
    }
}

/// Writes a mesh as binary little-endian PLY with double coordinates.
pub fn write_ply(mesh: &TriangleMesh, out: &mut impl Write) -> std::io::Result<()> {
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.vertices.len(),
        mesh.triangles.len()
    )?;
    for p in &mesh.vertices {
        for x in p.iter() {
            out.write_all(&x.to_le_bytes())?;
        }
    }
    for triangle in &mesh.triangles {
        out.write_all(&[3])?;
        for corner in triangle {
            out.write_all(&corner.to_le_bytes())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ascii_with_extra_properties_and_a_nan_row() {
        let text = b"ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nproperty uchar red\r\nend_header\r\n1 2 3 9\r\nnan 0 0 9\r\n4 5 6 9\r\n";
        let read = read_ply(text).unwrap();
        assert_eq!(read.dropped, 1);
        assert_eq!(read.points[1], Point3::new(4.0, 5.0, 6.0));
    }

    #[test]
    fn a_written_mesh_is_read_back() {
        let mesh = TriangleMesh {
            vertices: vec![Point3::new(0.1, -0.2, 0.3); 3],
            triangles: vec![[0, 1, 2]],
        };
        let mut bytes = Vec::new();
        write_ply(&mesh, &mut bytes).unwrap();
        assert_eq!(read_ply(&bytes).unwrap().points, mesh.vertices);
    }

    #[test]
    fn damaged_files_are_refused() {
        assert!(read_ply(b"").is_err());
        assert!(read_ply(b"solid stl").is_err());
        let cut = b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n\0\0";
        assert!(read_ply(cut).is_err());
        let no_z = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n";
        assert!(matches!(
            read_ply(no_z),
            Err(PlyError::Coordinate {
                index: 0,
                property: "z"
            })
        ));
    }
}
