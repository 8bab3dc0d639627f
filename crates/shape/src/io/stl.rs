//! STL, text and binary, with equal corners welded together.

use std::collections::HashMap;

use nalgebra::Point3;

use super::error::LoadError;
use super::format::Format;
use super::geometry::Raw;
use super::text::{Lines, number};

const HEADER: usize = 80;
const FACET: usize = 50;

/// Reads binary STL if the length is that of its facets, or if the beginning is no text.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let facets = bytes
        .get(HEADER..HEADER + 4)
        .and_then(|b| b.try_into().ok())
        .map(u32::from_le_bytes);
    let promised = facets.map(|n| HEADER as u64 + 4 + FACET as u64 * u64::from(n));
    if promised != Some(bytes.len() as u64) && is_text(bytes) {
        return read_text(bytes);
    }
    match (facets, promised) {
        (Some(facets), Some(promised)) if promised <= bytes.len() as u64 => {
            Ok(read_binary(bytes, facets as usize))
        }
        (Some(facets), Some(promised)) => Err(LoadError::byte(
            Format::Stl,
            bytes.len(),
            format!("{facets} facets of {FACET} bytes, up to byte {promised}"),
            "the end of the file".to_owned(),
        )),
        _ => Err(LoadError::byte(
            Format::Stl,
            bytes.len(),
            "`solid`, or a header of 80 bytes and a count of facets".to_owned(),
            "the end of the file".to_owned(),
        )),
    }
}

/// Whether the length of the file is that of as many facets as a binary STL says.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes.get(HEADER..HEADER + 4);
    let facets = count
        .and_then(|b| b.try_into().ok())
        .map(u32::from_le_bytes);
    facets.is_some_and(|n| HEADER as u64 + 4 + FACET as u64 * u64::from(n) == bytes.len() as u64)
}

/// Whether the file begins with `solid`, in any case, and no byte near its beginning is binary.
fn is_text(bytes: &[u8]) -> bool {
    const LOOK: usize = HEADER + 4 + 4 * FACET;
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let start = bytes.trim_ascii_start();
    let solid = start
        .get(..5)
        .is_some_and(|w| w.eq_ignore_ascii_case(b"solid"));
    let binary = |b: &u8| b.is_ascii_control() && !b.is_ascii_whitespace();
    solid && !bytes[..bytes.len().min(LOOK)].iter().any(binary)
}

fn read_binary(bytes: &[u8], facets: usize) -> Raw {
    let mut weld = Weld::default();
    for facet in bytes[HEADER + 4..].chunks_exact(FACET).take(facets) {
        // Twelve bytes of normal, three corners, two bytes of attributes.
        let number = |at: usize| {
            let [a, b, c, d] = [facet[at], facet[at + 1], facet[at + 2], facet[at + 3]];
            f64::from(f32::from_le_bytes([a, b, c, d]))
        };
        let corner = |k: usize| {
            let at = 12 * (k + 1);
            Point3::new(number(at), number(at + 4), number(at + 8))
        };
        weld.triangle([corner(0), corner(1), corner(2)]);
    }
    weld.raw
}

fn read_text(bytes: &[u8]) -> Result<Raw, LoadError> {
    let mut weld = Weld::default();
    let mut corners: Vec<Point3<f64>> = Vec::with_capacity(3);
    let mut lines = Lines::new(bytes, &["#", "//"]);
    let mut closed = true;
    for line in lines.by_ref() {
        let refuse =
            |expected: &str| LoadError::line(Format::Stl, line.number, expected, &line.text);
        let mut words = line.text.split_whitespace();
        let mut key = words.next().unwrap_or_default().to_ascii_lowercase();
        if key == "end" {
            key.push_str(&words.next().unwrap_or_default().to_ascii_lowercase());
        }
        match key.as_str() {
            "vertex" => {
                let numbers: Option<Vec<f64>> = words.map(number).collect();
                match numbers.as_deref() {
                    Some(&[x, y, z]) if corners.len() < 3 => corners.push(Point3::new(x, y, z)),
                    Some([_, _, _]) => return Err(refuse("`endloop` after three corners")),
                    _ => return Err(refuse("`vertex` and three numbers")),
                }
            }
            "endloop" => match corners[..] {
                [a, b, c] => {
                    weld.triangle([a, b, c]);
                    corners.clear();
                }
                _ => return Err(refuse("three `vertex` lines before")),
            },
            "solid" => closed = false,
            "endsolid" => closed = true,
            "facet" | "outer" | "endfacet" => {}
            _ => {
                return Err(refuse(
                    "one of facet, outer, vertex, endloop, endfacet, endsolid",
                ));
            }
        }
    }
    if closed {
        Ok(weld.raw)
    } else {
        let line = lines.next_number();
        Err(LoadError::line(
            Format::Stl,
            line,
            "`endsolid`",
            "the end of the file",
        ))
    }
}

/// Triangles whose equal corners share one vertex.
#[derive(Default)]
struct Weld {
    raw: Raw,
    index: HashMap<[u64; 3], u32>,
}

impl Weld {
    fn triangle(&mut self, corners: [Point3<f64>; 3]) {
        let triangle = corners.map(|p| {
            // Adding zero makes −0 and 0 one key.
            let key = [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits());
            let next = self.raw.vertices.len() as u32;
            let index = *self.index.entry(key).or_insert(next);
            if index == next {
                self.raw.vertices.push(p);
            }
            index
        });
        self.raw.triangles.push(triangle);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid two\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1e0 0\nvertex -0 1 0\nendloop\nendfacet\nendsolid two\n";

    fn binary(corners: &[[f32; 9]]) -> Vec<u8> {
        let mut bytes = b"solid looks like text".to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend((corners.len() as u32).to_le_bytes());
        for facet in corners {
            bytes.extend([0; 12]);
            bytes.extend(facet.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn text_and_binary_agree() {
        let text = read(TEXT.as_bytes()).unwrap();
        let bytes = binary(&[
            [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            [1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0],
        ]);
        let same = read(&bytes).unwrap();
        assert_eq!(text.vertices.len(), 4);
        assert_eq!(text.vertices, same.vertices);
        assert_eq!(text.triangles, same.triangles);
    }

    #[test]
    fn text_of_other_programs() {
        let expected = read(TEXT.as_bytes()).unwrap().triangles;
        let two_words = TEXT
            .replace("endloop", "end loop")
            .replace("endsolid", "end solid");
        let comments = TEXT.replace("outer loop", "// by hand\nouter loop # here");
        for text in [
            TEXT.to_ascii_uppercase(),
            format!("\u{feff}{TEXT}"),
            TEXT.replacen("solid", "Solid", 1),
            two_words,
            comments,
        ] {
            assert_eq!(read(text.as_bytes()).unwrap().triangles, expected, "{text}");
        }
        let mut trailing = binary(&[[0., 0., 0., 1., 0., 0., 0., 1., 0.]]);
        trailing.extend([0, 0]);
        assert_eq!(read(&trailing).unwrap().triangles.len(), 1);
    }

    #[test]
    fn damage_is_named() {
        let cut = &TEXT[..TEXT.len() - 14];
        assert!(matches!(
            read(cut.as_bytes()),
            Err(LoadError::Line { line: 16, .. })
        ));
        let odd = TEXT.replace("1e0", "one");
        assert!(matches!(
            read(odd.as_bytes()),
            Err(LoadError::Line { line: 12, .. })
        ));
        let mut bytes = binary(&[[0.0; 9]]);
        bytes.pop();
        bytes[0] = b'S';
        assert!(matches!(
            read(&bytes),
            Err(LoadError::Byte { byte: 133, .. })
        ));
    }
}
