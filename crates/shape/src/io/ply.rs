//! PLY: text and both binary orders, with any further elements and properties.
//!
//! The parser is our own, because the available crates refuse names, types and layouts that occur
//! in files.

use nalgebra::Point3;

use super::error::{LoadError, quoted};
use super::format::Format;
use super::geometry::Raw;
use super::ply_body::Body;
use super::ply_header::{self, Element, Encoding, Property};
use super::table_header;

/// Vertices of a PLY file; rows with NaN or infinite coordinates are dropped and counted.
#[derive(Clone, Debug, PartialEq)]
pub struct PlyPoints {
    /// Finite vertices, in the file's unit and order.
    pub points: Vec<Point3<f64>>,
    /// How many rows were dropped.
    pub dropped: usize,
}

/// Reads the vertices of a PLY file.
///
/// # Errors
/// The bytes are not such a file; see [`LoadError`].
pub fn read_ply(bytes: &[u8]) -> Result<PlyPoints, LoadError> {
    let mut points = read(bytes)?.vertices;
    let count = points.len();
    points.retain(|p| p.iter().all(|x| x.is_finite()));
    Ok(PlyPoints {
        dropped: count - points.len(),
        points,
    })
}

/// What the rows of an element are.
enum Role {
    /// Points; where x, y and z stand among the properties.
    Vertices([usize; 3]),
    /// Polygons, by the list of vertex numbers.
    Polygons(usize),
    /// Strips of triangles; −1 begins another one.
    Strips(usize),
    Other,
}

/// Vertices, finite or not, and polygons and strips as triangles.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let header = ply_header::read(bytes)?;
    let points = vertex_element(&header.elements)?;
    let mut body = Body::new(bytes, &header);
    let mut raw = Raw::default();
    let mut aligned = true;
    let mut runs: Vec<Runs> = Vec::new();
    for (index, element) in header.elements.iter().enumerate() {
        let role = if index == points.0 {
            Role::Vertices(points.1)
        } else {
            role(element)?
        };
        check_size(&body, element, header.encoding)?;
        match role {
            Role::Vertices(_) => raw.vertices.reserve_exact(element.count),
            Role::Polygons(_) | Role::Strips(_) => runs.push(Runs::new(&role)),
            Role::Other => {}
        }
        for _ in 0..element.count {
            match (&role, runs.last_mut()) {
                (Role::Vertices(columns), _) => {
                    raw.vertices.push(vertex(&mut body, element, *columns)?);
                }
                (Role::Polygons(list) | Role::Strips(list), Some(runs)) => {
                    runs.read(&mut body, element, *list)?;
                }
                _ => other(&mut body, element)?,
            }
            aligned = aligned && body.at_line_end();
        }
    }
    // Rows may be broken anywhere, but then nothing may be missing or left.
    if header.encoding == Encoding::Text && !aligned && body.word().is_some() {
        return Err(body.refuse("the end of the file after the last row", "more numbers"));
    }
    for runs in runs {
        runs.into_triangles(&mut raw)?;
    }
    Ok(raw)
}

fn has_name(element: &Element, names: &[&str]) -> bool {
    names.iter().any(|n| element.name.eq_ignore_ascii_case(n))
}

/// The element with the points, and where its coordinates stand.
fn vertex_element(elements: &[Element]) -> Result<(usize, [usize; 3]), LoadError> {
    let named = |names: &[&str]| elements.iter().position(|e| has_name(e, names));
    let found = named(&["vertex"]).or_else(|| named(&["vertices", "point", "points"]));
    let Some(index) = found else {
        let names: Vec<&str> = elements.iter().map(|e| e.name.as_str()).collect();
        let what = format!("the elements {}", quoted(&names.join("`, `")));
        return Err(LoadError::content(Format::Ply, what, "an element `vertex`"));
    };
    let element = &elements[index];
    let names: Vec<&str> = element.properties.iter().map(|p| p.name.as_str()).collect();
    let exact = ["x", "y", "z"].map(|axis| names.iter().position(|n| *n == axis));
    let columns = match exact {
        [Some(x), Some(y), Some(z)] => Some([x, y, z]),
        _ => table_header::columns(&names).ok(),
    };
    let scalar = |c: &[usize; 3]| c.iter().all(|&i| element.properties[i].list.is_none());
    columns.filter(scalar).map(|c| (index, c)).ok_or_else(|| {
        let expected = "properties x, y and z";
        LoadError::line(Format::Ply, element.line, expected, &names.join(", "))
    })
}

/// Names of lists with the corners of a face.
const CORNERS: [&str; 4] = [
    "vertex_indices",
    "vertex_index",
    "vertex_indexes",
    "vertex_ids",
];
/// Names that mean the same in an element of faces.
const MORE_CORNERS: [&str; 3] = ["vertices", "vertex", "indices"];
const FACES: [&str; 6] = [
    "face",
    "faces",
    "polygon",
    "polygons",
    "triangle",
    "triangles",
];
const STRIPS: [&str; 4] = ["tristrips", "tristrip", "tri_strips", "strips"];
/// Elements with vertex numbers that bound no face.
const NO_FACES: [&str; 5] = ["edge", "edges", "line", "lines", "polyline"];

fn role(element: &Element) -> Result<Role, LoadError> {
    let (faces, strips) = (has_name(element, &FACES), has_name(element, &STRIPS));
    let list = |names: &[&str]| {
        let named = |p: &Property| names.iter().any(|n| p.name.eq_ignore_ascii_case(n));
        let mut properties = element.properties.iter();
        properties.position(|p| p.list.is_some() && named(p))
    };
    // The only list of whole numbers is that of the corners, whatever its name.
    let only = || {
        let properties = element.properties.iter().enumerate();
        let mut whole = properties.filter(|(_, p)| p.list.is_some() && p.scalar.is_whole());
        let found = whole.next().map(|(i, _)| i);
        found.filter(|_| whole.next().is_none())
    };
    match list(&CORNERS) {
        Some(corners) if strips => return Ok(Role::Strips(corners)),
        Some(corners) if !has_name(element, &NO_FACES) => return Ok(Role::Polygons(corners)),
        _ => {}
    }
    if !(faces || strips) {
        return Ok(Role::Other);
    }
    match list(&MORE_CORNERS).or_else(only) {
        Some(corners) if strips => Ok(Role::Strips(corners)),
        Some(corners) => Ok(Role::Polygons(corners)),
        None if element.count == 0 => Ok(Role::Other),
        None => {
            let names: Vec<&str> = element.properties.iter().map(|p| p.name.as_str()).collect();
            let expected = "a list `vertex_indices` of the corners of each face";
            let found = names.join(", ");
            let line = element.line;
            Err(LoadError::line(Format::Ply, line, expected, &found))
        }
    }
}

/// Refuses a count of rows that the rest of the file cannot hold.
fn check_size(body: &Body, element: &Element, encoding: Encoding) -> Result<(), LoadError> {
    let row = element.least_row(encoding).max(1);
    // The last number of a text needs no blank behind it.
    let rest = body.rest().saturating_add(1);
    if element
        .count
        .checked_mul(row)
        .is_some_and(|needed| needed <= rest)
    {
        return Ok(());
    }
    let (count, name) = (element.count, &element.name);
    let expected = format!("{count} rows of `{name}`");
    let found = format!("{} bytes for them", body.rest());
    Err(LoadError::line(
        Format::Ply,
        element.line,
        &expected,
        &found,
    ))
}

fn vertex(
    body: &mut Body,
    element: &Element,
    columns: [usize; 3],
) -> Result<Point3<f64>, LoadError> {
    let mut point = Point3::origin();
    for (i, property) in element.properties.iter().enumerate() {
        match columns.iter().position(|c| *c == i) {
            Some(axis) => point[axis] = body.number(property.scalar, "a coordinate")?,
            None => pass_over(body, property)?,
        }
    }
    Ok(point)
}

fn pass_over(body: &mut Body, property: &Property) -> Result<(), LoadError> {
    let expected = "a number for each property";
    match property.list {
        None => body.skip(property.scalar, expected),
        Some(kind) => {
            let count = body.whole(kind, "the length of a list")?;
            body.skip_list(count, property.scalar, expected)
        }
    }
}

/// Skips a row.
fn other(body: &mut Body, element: &Element) -> Result<(), LoadError> {
    let mut properties = element.properties.iter();
    properties.try_for_each(|property| pass_over(body, property))
}

/// Polygons or strips as they stand in the file: faces may come before their vertices.
struct Runs {
    strips: bool,
    corners: Vec<u32>,
    /// Corners of each polygon or strip.
    lengths: Vec<u32>,
}

impl Runs {
    fn new(role: &Role) -> Self {
        Self {
            strips: matches!(role, Role::Strips(_)),
            corners: Vec::new(),
            lengths: Vec::new(),
        }
    }

    fn read(&mut self, body: &mut Body, element: &Element, list: usize) -> Result<(), LoadError> {
        let expected = "the number of a vertex";
        for (i, property) in element.properties.iter().enumerate() {
            let (true, Some(kind)) = (i == list, property.list) else {
                pass_over(body, property)?;
                continue;
            };
            let count = body.whole(kind, "the number of corners")?;
            let count = body.count(count, property.scalar, expected)?;
            let mut length = 0;
            for _ in 0..count {
                let corner = body.whole(property.scalar, expected)?;
                match u32::try_from(corner) {
                    Ok(corner) => {
                        self.corners.push(corner);
                        length += 1;
                    }
                    Err(_) if self.strips && corner == -1 => {
                        self.lengths.push(std::mem::take(&mut length));
                    }
                    Err(_) => return Err(body.refuse(expected, &corner.to_string())),
                }
            }
            self.lengths.push(length);
        }
        Ok(())
    }

    fn into_triangles(self, raw: &mut Raw) -> Result<(), LoadError> {
        let vertices = raw.vertices.len();
        let mut rest = &self.corners[..];
        for (row, length) in self.lengths.iter().enumerate() {
            let (corners, tail) = rest.split_at(*length as usize);
            rest = tail;
            if let Some(corner) = corners.iter().find(|c| **c as usize >= vertices) {
                let what = match self.strips {
                    true => format!("corner {corner} in a strip"),
                    false => format!("corner {corner} in face {row}"),
                };
                let expected = format!("numbers of vertices below {vertices}");
                return Err(LoadError::content(Format::Ply, what, &expected));
            }
            if self.strips {
                raw.strip(corners);
            } else {
                raw.polygon(Format::Ply, corners)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(header: &str, body: &str) -> Vec<u8> {
        format!("ply\nformat ascii 1.0\n{header}end_header\n{body}").into_bytes()
    }

    const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

    #[test]
    fn rows_may_be_written_in_many_ways() {
        let header = format!("element vertex 2\n{XYZ}property uchar red\n");
        for body in [
            "1. .5 -3 9\n4 5 6 255.0\n",
            "1. .5 -3 9\n\n  \n4 5 6 256",
            "\n1\n.5 -3\n9 4 5\r\n6 0",
            "1 .5 -3 -1\n4 5 6 x\ntrailing words\n",
        ] {
            let read = read_ply(&text(&header, body)).unwrap();
            assert_eq!(read.points[0], Point3::new(1.0, 0.5, -3.0), "{body}");
            assert_eq!(read.points[1], Point3::new(4.0, 5.0, 6.0), "{body}");
        }
        let nan = read_ply(&text(&header, "1.#QNAN 0 0 9\n4 5 6 9\n")).unwrap();
        assert_eq!((nan.dropped, nan.points.len()), (1, 1));
        for body in [
            "1 2 3 4\n5 6 7\n",
            "1 2 3 4 5\n6 7 8 9\n",
            "1 2 3 4\n5 y 7 8\n",
        ] {
            assert!(read_ply(&text(&header, body)).is_err(), "{body}");
        }
    }

    #[test]
    fn headers_of_many_programs() {
        for (from, to) in [
            ("property float x", "property float32 X"),
            (
                "property float x",
                "property float scalar_C2C_absolute_distances[<0.1]\nproperty float x",
            ),
            (
                "property float x",
                "comment caf\u{e9}\nproperty int64 label (#1)\nproperty float x",
            ),
            ("ply\n", "\u{feff}ply\n"),
        ] {
            let plain = text(&format!("element vertex 1\n{XYZ}"), "7 7 7\n");
            let changed = String::from_utf8(plain).unwrap().replacen(from, to, 1);
            let changed = match to.contains("\nproperty float x") {
                true => changed.replace("7 7 7", "7 7 7 7"),
                false => changed,
            };
            let read = read_ply(changed.as_bytes());
            assert_eq!(read.unwrap().points, [Point3::new(7.0, 7.0, 7.0)], "{to}");
        }
        let carriage = text(&format!("element vertex 1\n{XYZ}"), "7 7 7\n");
        let carriage = String::from_utf8(carriage).unwrap().replace('\n', "\r");
        assert_eq!(read_ply(carriage.as_bytes()).unwrap().points.len(), 1);
    }

    #[test]
    fn binary_data_are_never_edited() {
        let mut bytes = format!(
            "ply\nformat binary_little_endian 1.0\ncomment format ascii\nelement vertex 1\n{}end_header\n",
            XYZ.replace("float", "short")
        )
        .into_bytes();
        bytes.extend([9, 9, 9, 32, 10, 13]);
        let read = read_ply(&bytes).unwrap();
        let expected = [0x0909, 0x2009, 0x0d0a].map(f64::from);
        assert_eq!(read.points, [Point3::from(expected)]);
    }

    #[test]
    fn strips_and_lists_of_other_names_are_faces() {
        let vertices = format!("element vertex 4\n{XYZ}");
        let rows = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
        let strips =
            format!("{vertices}element tristrips 1\nproperty list int int vertex_indices\n");
        let raw = read(&text(&strips, &format!("{rows}8 0 1 2 3 -1 0 1 2"))).unwrap();
        assert_eq!(raw.triangles, [[0, 1, 2], [2, 1, 3], [0, 1, 2]]);
        let named = format!("{vertices}element face 1\nproperty list uchar int vertices\n");
        let raw = read(&text(&named, &format!("{rows}3 0.0 1.0 2\n"))).unwrap();
        assert_eq!(raw.triangles, [[0, 1, 2]]);
        let none = format!("{vertices}element face 1\nproperty int a\n");
        assert!(read(&text(&none, &format!("{rows}3\n"))).is_err());
    }

    #[test]
    fn damaged_files_are_refused() {
        assert!(read_ply(b"").is_err());
        assert!(read_ply(b"solid stl").is_err());
        let cut = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n{XYZ}end_header\n\0\0"
        );
        assert!(read_ply(cut.as_bytes()).is_err());
        let no_z = text(
            "element vertex 1\nproperty float x\nproperty float y\n",
            "1 2\n",
        );
        let error = read_ply(&no_z).unwrap_err();
        assert!(matches!(error, LoadError::Line { line: 3, .. }), "{error}");
    }
}
