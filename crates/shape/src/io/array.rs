//! Arrays of NumPy (NEP 1) with one point per row.

use nalgebra::Point3;

use super::error::{LoadError, quoted};
use super::format::Format;
use super::geometry::Raw;

const MAGIC: &[u8] = b"\x93NUMPY";
/// Longest header that is read. That of an array of numbers has about 80 bytes.
const MAX_HEADER: usize = 4096;
const EXPECTED: &str = "an array of shape (N, 3), or more columns that begin with x, y, z";

/// How a number is stored.
#[derive(Clone, Copy)]
struct Number {
    kind: char,
    size: usize,
    big: bool,
}

/// Reads the first three entries of the last axis as x, y and z.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let (header, start) = header(bytes)?;
    let number = number_type(&header)?;
    let fortran = value_of(&header, "fortran_order").is_some_and(|v| v.starts_with("True"));
    let shape = value_of(&header, "shape")
        .and_then(tuple)
        .ok_or_else(|| refuse("`shape`, a tuple of whole numbers", &header))?;
    let (rows, columns) = layout(&shape, fortran)?;
    let data = &bytes[start..];
    let needed = rows
        .checked_mul(columns)
        .and_then(|n| n.checked_mul(number.size));
    if needed.is_none_or(|needed| needed > data.len()) {
        return Err(LoadError::byte(
            Format::Npy,
            bytes.len(),
            format!("{rows} × {columns} numbers of {} bytes", number.size),
            "the end of the file".to_owned(),
        ));
    }
    let at = |row: usize, column: usize| {
        let index = if fortran {
            column * rows + row
        } else {
            row * columns + column
        };
        number.read(&data[index * number.size..][..number.size])
    };
    Ok(Raw {
        vertices: (0..rows)
            .map(|row| Point3::new(at(row, 0), at(row, 1), at(row, 2)))
            .collect(),
        triangles: Vec::new(),
    })
}

fn refuse(expected: &str, found: &str) -> LoadError {
    LoadError::byte(Format::Npy, 10, expected.to_owned(), quoted(found.trim()))
}

/// The text of the header, and where the data begin.
fn header(bytes: &[u8]) -> Result<(String, usize), LoadError> {
    let cut = |expected: &str| {
        let found = "the end of the file".to_owned();
        LoadError::byte(Format::Npy, bytes.len(), expected.to_owned(), found)
    };
    if !bytes.starts_with(MAGIC) {
        let found = "other bytes".to_owned();
        return Err(LoadError::byte(
            Format::Npy,
            0,
            "the mark \\x93NUMPY".to_owned(),
            found,
        ));
    }
    let start = MAGIC.len() + 2;
    let width = match bytes.get(MAGIC.len()) {
        Some(1) => 2,
        Some(2 | 3) => 4,
        Some(other) => {
            let found = other.to_string();
            return Err(LoadError::byte(
                Format::Npy,
                6,
                "version 1, 2 or 3".to_owned(),
                found,
            ));
        }
        None => return Err(cut("a version")),
    };
    let length = bytes
        .get(start..start + width)
        .ok_or_else(|| cut("the length of the header"))?;
    let length = length
        .iter()
        .rev()
        .fold(0, |sum, b| sum << 8 | usize::from(*b));
    if length > MAX_HEADER {
        let found = format!("{length} bytes");
        let expected = format!("a header of at most {MAX_HEADER} bytes");
        return Err(LoadError::byte(Format::Npy, start, expected, found));
    }
    let from = start + width;
    let text = bytes
        .get(from..from + length)
        .ok_or_else(|| cut("the whole header"))?;
    Ok((String::from_utf8_lossy(text).into_owned(), from + length))
}

fn number_type(header: &str) -> Result<Number, LoadError> {
    let descr = value_of(header, "descr").unwrap_or_default();
    let quote = descr.chars().next().filter(|c| matches!(c, '\'' | '"'));
    let name = quote
        .and_then(|q| descr[1..].split_once(q))
        .map(|(name, _)| name);
    let parsed = name.and_then(|name| {
        let (order, rest) = name.split_at_checked(1)?;
        let (kind, size) = rest.split_at_checked(1)?;
        let number = Number {
            kind: kind.chars().next()?,
            size: size.parse().ok()?,
            big: order == ">" || order == "=" && cfg!(target_endian = "big"),
        };
        let known = matches!(
            (number.kind, number.size),
            ('f', 4 | 8) | ('i' | 'u', 1 | 2 | 4 | 8)
        );
        (known && ["<", ">", "=", "|"].contains(&order)).then_some(number)
    });
    parsed.ok_or_else(|| match name {
        Some("|O") => refuse("numbers (save the array without pickled objects)", header),
        _ => refuse(
            "an array of one type of number, such as '<f4' or '<f8'",
            header,
        ),
    })
}

/// Rows and columns. All axes but the last count points.
fn layout(shape: &[usize], fortran: bool) -> Result<(usize, usize), LoadError> {
    let names: Vec<String> = shape.iter().map(usize::to_string).collect();
    let found = || {
        LoadError::content(
            Format::Npy,
            format!("an array of shape ({})", names.join(", ")),
            EXPECTED,
        )
    };
    let transposed = || {
        let advice = "an array of shape (N, 3); this one looks transposed, save its transpose";
        LoadError::content(
            Format::Npy,
            format!("an array of shape ({})", names.join(", ")),
            advice,
        )
    };
    let [leading @ .., columns] = shape else {
        return Err(found());
    };
    if leading.is_empty() || (fortran && leading.len() > 1) {
        return Err(found());
    }
    let rows = leading
        .iter()
        .try_fold(1_usize, |product, n| product.checked_mul(*n));
    match rows {
        Some(3) if *columns > 16 => Err(transposed()),
        Some(rows) if (3..=64).contains(columns) => Ok((rows, *columns)),
        _ => Err(found()),
    }
}

impl Number {
    /// The number in `bytes`, which are of its size.
    fn read(self, bytes: &[u8]) -> f64 {
        let push = |word: u64, b: &u8| word << 8 | u64::from(*b);
        let word = if self.big {
            bytes.iter().fold(0, push)
        } else {
            bytes.iter().rev().fold(0, push)
        };
        let unused = 64 - 8 * bytes.len() as u32;
        match (self.kind, bytes.len()) {
            ('f', 4) => f64::from(f32::from_bits(word as u32)),
            ('f', _) => f64::from_bits(word),
            // Shifting up and back spreads the sign.
            ('i', _) => ((word << unused) as i64 >> unused) as f64,
            _ => word as f64,
        }
    }
}

/// The text that follows `'key':` in a Python dictionary whose values hold no such text.
fn value_of<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let rest = ['\'', '"'].into_iter().find_map(|quote| {
        let named = format!("{quote}{key}{quote}");
        header.split_once(&named).map(|(_, rest)| rest)
    })?;
    rest.trim_start().strip_prefix(':').map(str::trim_start)
}

fn tuple(text: &str) -> Option<Vec<usize>> {
    let (inside, _) = text.strip_prefix('(')?.split_once(')')?;
    let parts = inside
        .split(',')
        .map(str::trim)
        .filter(|part| !part.is_empty());
    // Python 2 wrote long integers with an The degree L of the coefficients.
    parts
        .map(|part| part.trim_end_matches('L').parse().ok())
        .collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// An array as NumPy writes it.
    pub(in crate::io) fn npy(descr: &str, shape: &str, fortran: &str, data: &[u8]) -> Vec<u8> {
        let header =
            format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend(data);
        bytes
    }

    #[test]
    fn types_and_orders_agree() {
        let values = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0];
        let little: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let big: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
        let turned = [0, 3, 1, 4, 2, 5].map(|i: usize| values[i]);
        let turned: Vec<u8> = turned.iter().flat_map(|v| v.to_le_bytes()).collect();
        let bytes: Vec<u8> = vec![1, 2, 3, 4, 5, 6];
        let files = [
            npy("'<f4'", "(2, 3)", "False", &little),
            npy("'>f4'", "(2, 3)", "False", &big),
            npy("'<f4'", "(2, 3)", "True", &turned),
            npy("'|u1'", "(1, 2, 3)", "False", &bytes),
        ];
        for file in files {
            let raw = read(&file).unwrap();
            let expected = [Point3::new(1.0, 2.0, 3.0), Point3::new(4.0, 5.0, 6.0)];
            assert_eq!(raw.vertices, expected);
        }
    }

    #[test]
    fn other_arrays_are_refused() {
        for (descr, shape, data) in [
            ("'|O'", "(1, 3)", 24),
            ("'<f8'", "(6,)", 48),
            ("'<f8'", "(3, 100)", 2400),
            ("'<f8'", "(2, 3)", 47),
            ("'<f8'", "(18446744073709551615, 3)", 24),
            ("[('x', '<f8')]", "(1, 3)", 24),
            ("[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]", "(1, 3)", 24),
        ] {
            assert!(
                read(&npy(descr, shape, "False", &vec![0; data])).is_err(),
                "{descr} {shape}"
            );
        }
    }
}
