//! PCD of the Point Cloud Library: ASCII, binary and compressed.
//!
//! The parser is our own, because the available crate allocates the size that the file claims and
//! does not check its layout.

use nalgebra::Point3;

use super::error::LoadError;
use super::format::Format;
use super::geometry::Raw;
use super::lzf;
use super::text::{Lines, number};

/// A field of the header.
#[derive(Clone, Copy)]
struct Field {
    /// Bytes of one number.
    size: usize,
    /// `F`, `I` or `U`.
    kind: u8,
    /// Numbers per point.
    count: usize,
    /// Bytes before it in a point.
    offset: usize,
    /// Numbers before it in a point.
    column: usize,
}

#[derive(Clone, Copy, PartialEq)]
enum Data {
    Ascii,
    Binary,
    Compressed,
}

struct Header {
    fields: [Field; 3],
    /// Bytes of one point.
    stride: usize,
    points: usize,
    data: Data,
    /// Where the data begin: byte from 0, and line from 1.
    start: usize,
    start_line: usize,
}

/// Reads fields x, y and z of every point; other fields are ignored.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let header = header(bytes)?;
    let body = &bytes[header.start..];
    let vertices = match header.data {
        Data::Ascii => ascii(body, &header)?,
        Data::Binary => {
            let needed = header.points.checked_mul(header.stride);
            if needed.is_none_or(|needed| body.len() < needed) {
                let expected = format!("{} points of {} bytes", header.points, header.stride);
                return Err(end(bytes, expected));
            }
            let point = |i: usize, f: &Field| i * header.stride + f.offset;
            binary(body, &header, point)
        }
        Data::Compressed => {
            let unpacked = unpacked(bytes, &header)?;
            let point = |i: usize, f: &Field| f.offset * header.points + i * f.size * f.count;
            binary(&unpacked, &header, point)
        }
    };
    Ok(Raw {
        vertices,
        triangles: Vec::new(),
    })
}

fn end(bytes: &[u8], expected: String) -> LoadError {
    let found = "the end of the file".to_owned();
    LoadError::byte(Format::Pcd, bytes.len(), expected, found)
}

/// Lines up to DATA. Comments begin with `#`; unknown keys are ignored.
fn header(bytes: &[u8]) -> Result<Header, LoadError> {
    const EXPECTED: &str = "a PCD header: FIELDS, SIZE, TYPE, POINTS and DATA";
    let (mut names, mut sizes, mut kinds, mut counts) = (vec![], vec![], vec![], vec![]);
    let (mut points, mut width, mut height) = (None, None, None);
    let (mut at, mut number) = (0, 0);
    while at < bytes.len() {
        let end = bytes[at..].iter().position(|b| *b == b'\n');
        let end = end.map_or(bytes.len(), |e| at + e);
        let line = String::from_utf8_lossy(&bytes[at..end]);
        (at, number) = ((end + 1).min(bytes.len()), number + 1);
        let text = line.split('#').next().unwrap_or_default().trim();
        let refuse = |expected: &str| LoadError::line(Format::Pcd, number, expected, text);
        let mut words = text.split_whitespace();
        let key = words.next().unwrap_or_default();
        let words: Vec<&str> = words.collect();
        let one = || words.first().and_then(|w| w.parse::<usize>().ok());
        let list = || {
            words
                .iter()
                .map(|w| w.parse().ok())
                .collect::<Option<Vec<usize>>>()
        };
        match key {
            "FIELDS" | "COLUMNS" => names = words.iter().map(|w| (*w).to_owned()).collect(),
            "SIZE" => sizes = list().ok_or_else(|| refuse("sizes in bytes"))?,
            "COUNT" => counts = list().ok_or_else(|| refuse("counts"))?,
            "TYPE" => kinds = words.iter().map(|w| w.as_bytes()[0]).collect(),
            "WIDTH" => width = Some(one().ok_or_else(|| refuse("a number of points"))?),
            "HEIGHT" => height = Some(one().ok_or_else(|| refuse("a number of rows"))?),
            "POINTS" => points = Some(one().ok_or_else(|| refuse("a number of points"))?),
            "DATA" => {
                let data = match words[..] {
                    ["ascii"] => Data::Ascii,
                    ["binary"] => Data::Binary,
                    ["binary_compressed"] => Data::Compressed,
                    _ => return Err(refuse("DATA ascii, binary or binary_compressed")),
                };
                let product = || width?.checked_mul(height.unwrap_or(1));
                let points = points
                    .or_else(product)
                    .ok_or_else(|| refuse("POINTS, or WIDTH and HEIGHT, before DATA"))?;
                if counts.is_empty() {
                    counts = vec![1; names.len()];
                }
                // Version 0.5 has `COLUMNS` alone; all are 32-bit floats.
                if sizes.is_empty() && kinds.is_empty() {
                    (sizes, kinds) = (vec![4; names.len()], vec![b'F'; names.len()]);
                }
                let (fields, stride) = layout(&names, &sizes, &kinds, &counts).ok_or_else(|| {
                    refuse("FIELDS x, y and z, with a SIZE, TYPE and COUNT for each field, before DATA")
                })?;
                return Ok(Header {
                    fields,
                    stride,
                    points,
                    data,
                    start: at,
                    start_line: number + 1,
                });
            }
            _ if number == 1 && !text.is_ascii() => return Err(refuse(EXPECTED)),
            _ => {}
        }
    }
    Err(LoadError::line(
        Format::Pcd,
        number + 1,
        EXPECTED,
        "the end of the file",
    ))
}

/// The positions of x, y and z, and the bytes per point; `None` if the lists are inconsistent.
fn layout(
    names: &[String],
    sizes: &[usize],
    kinds: &[u8],
    counts: &[usize],
) -> Option<([Field; 3], usize)> {
    let n = names.len();
    if sizes.len() != n || kinds.len() != n || counts.len() != n {
        return None;
    }
    let mut found = [None; 3];
    let (mut offset, mut column) = (0_usize, 0_usize);
    for (i, name) in names.iter().enumerate() {
        let field = Field {
            size: sizes[i],
            kind: kinds[i],
            count: counts[i],
            offset,
            column,
        };
        if let Some(axis) = ["x", "y", "z"]
            .iter()
            .position(|a| name.eq_ignore_ascii_case(a))
        {
            let known = matches!(
                (field.kind, field.size),
                (b'F', 4 | 8) | (b'I' | b'U', 1 | 2 | 4 | 8)
            );
            found[axis] = (known && field.count >= 1).then_some(field);
        }
        offset = offset.checked_add(sizes[i].checked_mul(counts[i])?)?;
        column = column.checked_add(counts[i])?;
    }
    let [x, y, z] = found;
    Some(([x?, y?, z?], offset))
}

fn ascii(body: &[u8], header: &Header) -> Result<Vec<Point3<f64>>, LoadError> {
    let mut points = Vec::new();
    let mut lines = Lines::new(body, &["#"]);
    let line_number = |line: usize| header.start_line + line - 1;
    while points.len() < header.points {
        let next = lines.next_number();
        let Some(line) = lines.next() else {
            let expected = format!("{} points, {} read", header.points, points.len());
            let line = line_number(next);
            return Err(LoadError::line(
                Format::Pcd,
                line,
                &expected,
                "the end of the file",
            ));
        };
        let words: Vec<&str> = line.text.split_whitespace().collect();
        let value = |f: &Field| words.get(f.column).and_then(|w| number(w));
        let [x, y, z] = header.fields.each_ref().map(value);
        match (x, y, z) {
            (Some(x), Some(y), Some(z)) => points.push(Point3::new(x, y, z)),
            _ => {
                let line_at = line_number(line.number);
                let expected = "a number for each field";
                return Err(LoadError::line(Format::Pcd, line_at, expected, &line.text));
            }
        }
    }
    Ok(points)
}

/// Points of data known to be long enough; `at` returns the offset of a field of a point.
fn binary(data: &[u8], header: &Header, at: impl Fn(usize, &Field) -> usize) -> Vec<Point3<f64>> {
    let value = |i: usize, f: &Field| {
        let from = at(i, f);
        scalar(&data[from..from + f.size], f.kind)
    };
    let [x, y, z] = &header.fields;
    (0..header.points)
        .map(|i| Point3::new(value(i, x), value(i, y), value(i, z)))
        .collect()
}

/// A little-endian number of a type and size that [`layout`] accepts.
fn scalar(bytes: &[u8], kind: u8) -> f64 {
    let mut word = [0; 8];
    word[..bytes.len()].copy_from_slice(bytes);
    let unsigned = u64::from_le_bytes(word);
    let unused = 64 - 8 * bytes.len() as u32;
    match (kind, bytes.len()) {
        (b'F', 4) => f64::from(f32::from_bits(unsigned as u32)),
        (b'F', _) => f64::from_bits(unsigned),
        // Shifting up and back spreads the sign.
        (b'I', _) => ((unsigned << unused) as i64 >> unused) as f64,
        _ => unsigned as f64,
    }
}

/// The data block: two sizes, then LZF of all x, then all y, and so on.
fn unpacked(bytes: &[u8], header: &Header) -> Result<Vec<u8>, LoadError> {
    let word = |at: usize| {
        let four = bytes.get(at..at + 4).and_then(|b| b.try_into().ok());
        four.map(|b| u32::from_le_bytes(b) as usize)
            .ok_or_else(|| end(bytes, "the sizes of the compressed data".to_owned()))
    };
    let (packed, size) = (word(header.start)?, word(header.start + 4)?);
    let needed = header.points.checked_mul(header.stride);
    if needed != Some(size) {
        let expected = format!("{} points of {} bytes", header.points, header.stride);
        let found = format!("{size} bytes");
        return Err(LoadError::byte(
            Format::Pcd,
            header.start + 4,
            expected,
            found,
        ));
    }
    let start = header.start + 8;
    let data = bytes
        .get(start..start.saturating_add(packed))
        .ok_or_else(|| end(bytes, format!("{packed} compressed bytes")))?;
    lzf::unpack(data, size).map_err(|(at, why)| {
        let expected = format!("LZF data that unpack to {size} bytes");
        LoadError::byte(Format::Pcd, start + at, expected, why.to_owned())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(data: &str) -> Vec<u8> {
        format!(
            "# .PCD v0.7\nVERSION 0.7\nFIELDS rgb x y z\nSIZE 1 4 8 2\nTYPE U F F I\nCOUNT 3 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA {data}\n"
        )
        .into_bytes()
    }

    fn expected() -> [Point3<f64>; 2] {
        [Point3::new(0.5, -1.25, 7.0), Point3::new(1.5, 2.25, -3.0)]
    }

    #[test]
    fn the_three_encodings_agree() {
        let mut ascii = head("ascii");
        ascii.extend(b"1 2 3 0.5 -1.25 7\n1 2 3 1.5 2.25 -3\n");
        let mut binary = head("binary");
        let mut columns = [vec![], vec![], vec![], vec![]];
        for p in expected() {
            let parts = [
                vec![1, 2, 3],
                (p.x as f32).to_le_bytes().to_vec(),
                p.y.to_le_bytes().to_vec(),
                (p.z as i16).to_le_bytes().to_vec(),
            ];
            for (column, part) in columns.iter_mut().zip(parts) {
                binary.extend(&part);
                column.extend(part);
            }
        }
        let columns = columns.concat();
        let mut packed = Vec::new();
        for run in columns.chunks(32) {
            packed.push(run.len() as u8 - 1);
            packed.extend(run);
        }
        let mut compressed = head("binary_compressed");
        compressed.extend((packed.len() as u32).to_le_bytes());
        compressed.extend((columns.len() as u32).to_le_bytes());
        compressed.extend(packed);
        for file in [&ascii, &binary, &compressed] {
            assert_eq!(read(file).unwrap().vertices, expected());
            assert!(read(&file[..file.len() - 4]).is_err());
        }
    }

    #[test]
    fn version_five_has_columns() {
        let text = b"COLUMNS x y z\nPOINTS 2\nDATA ascii\n0.5 -1.25 7\n1.5 2.25 -3\n";
        assert_eq!(read(text).unwrap().vertices, expected());
    }

    #[test]
    fn absurd_counts_are_refused() {
        let text = String::from_utf8(head("binary")).unwrap();
        let huge = text.replace("POINTS 2", "POINTS 18446744073709551615");
        assert!(matches!(read(huge.as_bytes()), Err(LoadError::Byte { .. })));
        let wide = text.replace("SIZE 1", "SIZE 18446744073709551615");
        assert!(matches!(
            read(wide.as_bytes()),
            Err(LoadError::Line { line: 10, .. })
        ));
        let flat = text.replace("rgb x y z", "rgb x y w");
        assert!(read(flat.as_bytes()).is_err());
    }
}
