//! Wavefront OBJ: vertices and faces; everything else is ignored.
//!
//! The parser is our own, because the available crates report neither lines nor the value found.

use nalgebra::Point3;

use super::error::LoadError;
use super::format::Format;
use super::geometry::Raw;
use super::text::{Line, Lines, number};

const VERTEX: &str = "`v` and three numbers";
const FACE: &str = "`f` and at least three numbers of vertices that the file has";

/// Reads `v` and `f` lines. Faces may be i, i/j, i//k or i/j/k, counted from 1 or back from −1.
///
/// A line that ends in `\` goes on in the next one.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let mut raw = Raw::default();
    let mut faces = Faces::default();
    let mut lines = Lines::new(bytes, &["#"]);
    while let Some(mut line) = lines.next() {
        while let Some(begun) = line.text.strip_suffix('\\') {
            let Some(more) = lines.next() else { break };
            line.text = format!("{begun} {}", more.text).into();
        }
        let mut words = line.text.split_whitespace();
        match words.next() {
            Some("v" | "V") => raw.vertices.push(vertex(&line, words)?),
            Some("f" | "F") => faces.read(&line, words, raw.vertices.len())?,
            _ => {}
        }
    }
    faces.into_triangles(&mut raw)?;
    if raw.vertices.is_empty() {
        let expected = "a line of `v` and three numbers";
        return Err(LoadError::line(
            Format::Obj,
            last_line(bytes),
            expected,
            "the end of the file",
        ));
    }
    Ok(raw)
}

/// The corners of all faces: faces may precede their vertices.
#[derive(Default)]
struct Faces {
    corners: Vec<u32>,
    ends: Vec<usize>,
    /// Largest vertex number used by a face, and where.
    furthest: (u32, usize),
}

impl Faces {
    fn read<'a>(
        &mut self,
        line: &Line,
        words: impl Iterator<Item = &'a str>,
        vertices: usize,
    ) -> Result<(), LoadError> {
        let start = self.corners.len();
        for word in words {
            let corner = corner(word, vertices)
                .ok_or_else(|| LoadError::line(Format::Obj, line.number, FACE, word))?;
            if corner >= self.furthest.0 {
                self.furthest = (corner, line.number);
            }
            self.corners.push(corner);
        }
        if self.corners.len() < start + 3 {
            return Err(LoadError::line(Format::Obj, line.number, FACE, &line.text));
        }
        self.ends.push(self.corners.len());
        Ok(())
    }

    fn into_triangles(self, raw: &mut Raw) -> Result<(), LoadError> {
        let vertices = raw.vertices.len();
        if !self.ends.is_empty() && self.furthest.0 as usize >= vertices {
            let found = format!("vertex {} of {vertices}", u64::from(self.furthest.0) + 1);
            return Err(LoadError::line(Format::Obj, self.furthest.1, FACE, &found));
        }
        let mut start = 0;
        for end in self.ends {
            raw.polygon(Format::Obj, &self.corners[start..end])?;
            start = end;
        }
        Ok(())
    }
}

fn last_line(bytes: &[u8]) -> usize {
    let mut lines = Lines::new(bytes, &[]);
    lines.by_ref().for_each(drop);
    lines.next_number().saturating_sub(1)
}

fn vertex<'a>(
    line: &Line,
    mut words: impl Iterator<Item = &'a str>,
) -> Result<Point3<f64>, LoadError> {
    let mut coordinate = || {
        words
            .next()
            .and_then(number)
            .ok_or_else(|| LoadError::line(Format::Obj, line.number, VERTEX, &line.text))
    };
    Ok(Point3::new(coordinate()?, coordinate()?, coordinate()?))
}

/// Index from 0 of `i`, `i/j`, `i//k` or `i/j/k`.
fn corner(word: &str, vertices: usize) -> Option<u32> {
    let index: i64 = word.split('/').next()?.parse().ok()?;
    let zero_based = match index {
        1.. => index - 1,
        0 => return None,
        _ => i64::try_from(vertices).ok()?.checked_add(index)?,
    };
    u32::try_from(zero_based).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_of_every_notation() {
        let text = b"mtllib x.mtl\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nvn 0 0 1\nv 0 1 0\nf 1//1 2//1 3//1 4//1\nf -4/1 -3/2/1 -2\n";
        let raw = read(text).unwrap();
        assert_eq!(raw.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
    }

    #[test]
    fn a_line_may_go_on_in_the_next() {
        let text = b"v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\r\n 3\n";
        assert_eq!(read(text).unwrap().triangles, [[0, 1, 2]]);
    }

    #[test]
    fn the_bad_line_is_named() {
        for (text, bad) in [
            ("v 0 0 0\nv 1 x 0\n", 2),
            ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", 4),
            ("v 0 0 0\nf 1 2\n", 2),
            ("v 0 0 0\nf 0 1 1\n", 2),
            ("v 0 0 0\nf -2 1 1\n", 2),
            ("o empty\n", 1),
        ] {
            let error = read(text.as_bytes()).err().unwrap();
            assert!(
                matches!(error, LoadError::Line { line, .. } if line == bad),
                "{error}"
            );
        }
    }
}
