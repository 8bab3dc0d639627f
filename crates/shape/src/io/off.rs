//! OFF: counts, vertices, polygons.

use nalgebra::Point3;

use super::error::LoadError;
use super::format::Format;
use super::geometry::Raw;
use super::text::{Line, Lines, Words, number};

/// Reads text OFF, with or without its keyword, colours and normals (COFF, NOFF, CNOFF, STOFF).
///
/// Rows stand on lines of their own, and more numbers on a line are colours or normals. A file
/// that cannot be read so is read as one sequence of numbers, wherever its lines break.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let mut words = Words::new(bytes);
    let head = header(&mut words)?;
    by_lines(bytes, &head).or_else(|error| {
        // The number of edges may stand on a line of its own.
        let mut later = words.clone();
        later.next();
        let read = by_words(words, &head).or_else(|| by_words(later, &head));
        read.ok_or(error)?
    })
}

struct Head {
    vertices: usize,
    faces: usize,
    /// The line of the last of its words.
    line: usize,
}

/// The keyword, which may be missing or stand without a blank, and the numbers of rows.
fn header(words: &mut Words) -> Result<Head, LoadError> {
    const EXPECTED: &str = "`OFF` and the numbers of vertices and faces";
    let Some(first) = words.next() else {
        return Err(LoadError::end_of_text(Format::Off, 1, EXPECTED));
    };
    let digits = first.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let keyword = first[..first.len() - digits.len()].to_ascii_uppercase();
    let known = ["", "OFF", "COFF", "NOFF", "CNOFF", "NCOFF", "STOFF"];
    if !known.contains(&keyword.as_str()) {
        return Err(LoadError::line(Format::Off, words.line(), EXPECTED, first));
    }
    let count = |word: &str, line: usize| {
        let refuse = |_| LoadError::line(Format::Off, line, EXPECTED, word);
        word.parse::<usize>().map_err(refuse)
    };
    let mut next = || {
        let word = words.next().unwrap_or_default();
        count(word, words.line())
    };
    let vertices = match digits {
        "" => next()?,
        digits => count(digits, 1)?,
    };
    let faces = next()?;
    let line = words.line();
    // The number of edges is often left out.
    let mut ahead = words.clone();
    if ahead.next().is_some() && ahead.line() == line {
        *words = ahead;
    }
    Ok(Head {
        vertices,
        faces,
        line,
    })
}

fn by_lines(bytes: &[u8], head: &Head) -> Result<Raw, LoadError> {
    let mut rows = Lines::new(bytes, &["#"]).skip_while(|l| l.number <= head.line);
    let mut last = head.line;
    let mut next = |expected: &str| {
        let line = rows.next();
        last = line.as_ref().map_or(last, |l| l.number);
        line.ok_or_else(|| LoadError::end_of_text(Format::Off, last + 1, expected))
    };
    let mut raw = Raw::default();
    for _ in 0..head.vertices {
        raw.vertices
            .push(vertex(&next("a vertex: three numbers")?)?);
    }
    for _ in 0..head.faces {
        let line = next("a face: a count and as many vertex numbers")?;
        let corners = face(&line, head.vertices)?;
        raw.polygon(Format::Off, &corners)?;
    }
    Ok(raw)
}

/// All numbers in one sequence; nothing if they are not exactly those of the rows.
fn by_words(mut words: Words, head: &Head) -> Option<Result<Raw, LoadError>> {
    let mut raw = Raw::default();
    for _ in 0..head.vertices {
        let mut coordinate = || number(words.next()?);
        raw.vertices
            .push(Point3::new(coordinate()?, coordinate()?, coordinate()?));
    }
    let mut corners = Vec::new();
    for _ in 0..head.faces {
        let count: usize = words.next()?.parse().ok()?;
        corners.clear();
        for _ in 0..count {
            let corner: u32 = words.next()?.parse().ok()?;
            ((corner as usize) < head.vertices).then_some(())?;
            corners.push(corner);
        }
        if let Err(error) = raw.polygon(Format::Off, &corners) {
            return Some(Err(error));
        }
    }
    words.next().is_none().then_some(Ok(raw))
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

fn face(line: &Line, vertices: usize) -> Result<Vec<u32>, LoadError> {
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
    corners.filter(|c| c.len() == count).ok_or_else(refuse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_on_either_line_and_colours() {
        for text in [
            "OFF\n# three\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n",
            "OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
            "off 3 1 0\n0 0 0 1 0 0\n0 1 0\n3 0 1\n2\n",
            "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
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
