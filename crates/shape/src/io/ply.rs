//! PLY: ASCII and both binary orders, any extra properties.

use std::borrow::Cow;

use nalgebra::Point3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyDef,
    PropertyType, ScalarType,
};

use super::geometry::{Raw, fan};
use super::ply_error::PlyError;

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
    let mut points = read(bytes)?.vertices;
    let count = points.len();
    points.retain(|p| p.iter().all(|x| x.is_finite()));
    Ok(PlyPoints {
        dropped: count - points.len(),
        points,
    })
}

/// Vertices, finite or not, and faces as fans of triangles.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, PlyError> {
    let bytes = without_nan_words(bytes);
    let mut reader = Reader::new(bytes.as_ref());
    let header = Parser::<Skipped>::new()
        .read_header(&mut reader)
        .map_err(damage)?;
    let mut rows: Option<Vec<Vertex>> = None;
    let mut faces: Vec<Face> = Vec::new();
    for (name, element) in &header.elements {
        let rest = reader.get_ref().len();
        check_size(element, header.encoding, rest, bytes.len() - rest)?;
        match name.as_str() {
            "vertex" => rows = Some(elements(&mut reader, element, &header, bytes.len())?),
            "face" => faces = elements(&mut reader, element, &header, bytes.len())?,
            _ => {
                elements::<Skipped>(&mut reader, element, &header, bytes.len())?;
            }
        }
    }
    let vertices = rows.ok_or(PlyError::NoVertices)?;
    let vertices: Vec<Point3<f64>> = vertices
        .iter()
        .enumerate()
        .map(|(index, row)| point(index, row))
        .collect::<Result<_, _>>()?;
    Ok(Raw {
        triangles: triangles(&faces, vertices.len())?,
        vertices,
    })
}

fn point(index: usize, row: &Vertex) -> Result<Point3<f64>, PlyError> {
    let [x, y, z] = row.0;
    let named =
        |value: Option<f64>, property| value.ok_or(PlyError::Coordinate { index, property });
    Ok(Point3::new(named(x, "x")?, named(y, "y")?, named(z, "z")?))
}

fn triangles(faces: &[Face], vertices: usize) -> Result<Vec<[u32; 3]>, PlyError> {
    let mut triangles = Vec::with_capacity(faces.len());
    for (index, face) in faces.iter().enumerate() {
        if let Some(&corner) = face.0.iter().find(|c| **c as usize >= vertices) {
            return Err(PlyError::Corner {
                index,
                corner,
                vertices,
            });
        }
        fan(&face.0, &mut triangles);
    }
    Ok(triangles)
}

fn elements<E: PropertyAccess>(
    reader: &mut Reader<&[u8]>,
    element: &ElementDef,
    header: &Header,
    length: usize,
) -> Result<Vec<E>, PlyError> {
    let rows = Parser::<E>::new().read_payload_for_element(reader, element, header);
    rows.map_err(|error| match header.encoding {
        Encoding::Ascii => damage(error),
        // The parser counts rows of binary data as lines; the byte says more.
        _ => {
            let byte = length - reader.get_ref().len();
            let reason = format!("byte {byte}, element `{}`: {}", element.name, brief(error));
            PlyError::Parse { reason }
        }
    })
}

/// Refuses a count of rows that the rest of the file cannot hold.
fn check_size(
    element: &ElementDef,
    encoding: Encoding,
    rest: usize,
    byte: usize,
) -> Result<(), PlyError> {
    let width = |scalar: &ScalarType| match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    let least = |property: &PropertyDef| match (&property.data_type, encoding) {
        (_, Encoding::Ascii) => 1,
        (PropertyType::Scalar(scalar) | PropertyType::List(scalar, _), _) => width(scalar),
    };
    let row: usize = element.properties.values().map(least).sum();
    let needed = element.count.checked_mul(row.max(1));
    if needed.is_some_and(|needed| needed <= rest) {
        return Ok(());
    }
    let (count, name) = (element.count, &element.name);
    let reason = format!(
        "expected {count} rows of `{name}`, at least {row} bytes each, from byte {byte}; found {rest} bytes"
    );
    Err(PlyError::Parse { reason })
}

fn damage(error: ParseError) -> PlyError {
    PlyError::Parse {
        reason: brief(error),
    }
}

/// The parser's message in one line of bearable length.
fn brief(error: ParseError) -> String {
    const LONGEST: usize = 200;
    let text = error.to_string();
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").chars().take(LONGEST).collect()
}

/// x, y and z as far as the row has them.
struct Vertex([Option<f64>; 3]);

/// Corners of a polygon.
struct Face(Vec<u32>);

/// A row that is read over.
struct Skipped;

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self([None; 3])
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        match ["x", "y", "z"].iter().position(|axis| *axis == name) {
            Some(axis) => {
                self.0[axis] = number(&value);
                PropertyAccessResult::Set
            }
            None => PropertyAccessResult::Ignored,
        }
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        // Negative numbers become too large ones, which the check of corners names.
        self.0 = match value {
            Property::ListChar(list) => list.iter().map(|i| *i as u32).collect(),
            Property::ListUChar(list) => list.iter().map(|i| u32::from(*i)).collect(),
            Property::ListShort(list) => list.iter().map(|i| *i as u32).collect(),
            Property::ListUShort(list) => list.iter().map(|i| u32::from(*i)).collect(),
            Property::ListInt(list) => list.iter().map(|i| *i as u32).collect(),
            Property::ListUInt(list) => list,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::write_ply;
    use crate::triangle_mesh::TriangleMesh;

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
