//! OFF: counts, vertices, polygons.

use nalgebra::Point3;

use super::error::{Format, LoadError};
use super::geometry::{Raw, fan};
use super::text::{Line, Lines, number};

/// Reads text OFF, with or without colours and normals (COFF, NOFF, CNOFF, STOFF).
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let mut lines = Lines::new(bytes, &["#"]);
    let (vertices, faces) = header(&mut lines)?;
    let mut raw = Raw::default();
    for _ in 0..vertices {
        let line = next(&mut lines, "a vertex: three numbers")?;
        raw.vertices.push(vertex(&line)?);
    }
    for _ in 0..faces {
        let line = next(&mut lines, "a face: a count and as many vertex numbers")?;
        face(&line, vertices, &mut raw.triangles)?;
    }
    Ok(raw)
}

/// The keyword and the numbers of vertices and faces, on one line or two.
fn header(lines: &mut Lines) -> Result<(usize, usize), LoadError> {
    const EXPECTED: &str = "`OFF` and the numbers of vertices and faces";
    let first = next(lines, EXPECTED)?;
    let refuse = |line: &Line| LoadError::line(Format::Off, line.number, EXPECTED, &line.text);
    let mut words = first.text.split_whitespace();
    let keyword = words.next().unwrap_or_default();
    if !["OFF", "COFF", "NOFF", "CNOFF", "STOFF"].contains(&keyword) {
        return Err(refuse(&first));
    }
    let on_first: Vec<&str> = words.collect();
    let counts = |words: &[&str]| match words {
        [v, f] | [v, f, _] => Some((v.parse().ok()?, f.parse().ok()?)),
        _ => None,
    };
    if !on_first.is_empty() {
        return counts(&on_first).ok_or_else(|| refuse(&first));
    }
    let second = next(lines, "the numbers of vertices and faces")?;
    let words: Vec<&str> = second.text.split_whitespace().collect();
    counts(&words).ok_or_else(|| refuse(&second))
}

fn next<'a>(lines: &mut Lines<'a>, expected: &str) -> Result<Line<'a>, LoadError> {
    let number = lines.next_number();
    lines
        .next()
        .ok_or_else(|| LoadError::line(Format::Off, number, expected, "the end of the file"))
}

fn vertex(line: &Line) -> Result<Point3<f64>, LoadError> {
    let mut words = line.text.split_whitespace();
    let mut coordinate = || {
        let expected = "a vertex: three numbers";
        words
            .next()
            .and_then(number)
            .ok_or_else(|| LoadError::line(Format::Off, line.number, expected, &line.text))
    };
    Ok(Point3::new(coordinate()?, coordinate()?, coordinate()?))
}

fn face(line: &Line, vertices: usize, triangles: &mut Vec<[u32; 3]>) -> Result<(), LoadError> {
    let refuse = || {
        let expected = format!("a face: a count and as many vertex numbers below {vertices}");
        LoadError::line(Format::Off, line.number, &expected, &line.text)
    };
    let mut words = line.text.split_whitespace();
    let count: usize = words
        .next()
        .and_then(|w| w.parse().ok())
        .ok_or_else(refuse)?;
    let index = |word: &str| {
        let index: u32 = word.parse().ok()?;
        ((index as usize) < vertices).then_some(index)
    };
    let corners: Option<Vec<u32>> = words.take(count).map(index).collect();
    match corners {
        Some(corners) if corners.len() == count => {
            fan(&corners, triangles);
            Ok(())
        }
        _ => Err(refuse()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_on_either_line_and_colours() {
        for text in [
            "OFF\n# three\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n",
            "COFF 3 1\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n",
        ] {
            assert_eq!(read(text.as_bytes()).unwrap().triangles, [[0, 1, 2]]);
        }
    }

    #[test]
    fn the_bad_line_is_named() {
        for (text, bad) in [
            ("PLY\n", 1),
            ("OFF\n3 x 0\n", 2),
            ("OFF\n99999999999 1 0\n0 0 0\n", 4),
            ("OFF\n1 1 0\n0 0 0\n3 0 0 1\n", 4),
            ("OFF\n1 1 0\n0 0 0\n99999999999 0 0 1\n", 4),
        ] {
            let error = read(text.as_bytes()).err().unwrap();
            assert!(
                matches!(error, LoadError::Line { line, .. } if line == bad),
                "{error}"
            );
        }
    }
}
