//! Tables of doubles in `.npy` files.
//!
//! The format is that of NumPy (NEP 1): a magic number, a version, and a header that is a Python
//! dictionary with the keys `descr`, `fortran_order` and `shape`, followed by the numbers.

use std::ops::Range;

const MAGIC: &[u8] = b"\x93NUMPY";
/// Alignment of the header and the data in bytes, as NumPy writes them.
const ALIGNMENT: usize = 64;
/// Longest header that is read, bytes. The header of a table of doubles has about 80.
const MAX_HEADER: usize = 4096;

/// A table, stored row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    columns: usize,
    values: Vec<f64>,
}

/// Why bytes are not a table of numbers.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NpyError {
    /// The bytes do not begin as a `.npy` file does.
    #[error("not a .npy file: it does not begin with the mark \\x93NUMPY")]
    Magic,
    /// The version of the format is not supported.
    #[error("a .npy file of version {major}; versions 1 to 3 are read")]
    Version {
        /// The major version found.
        major: u8,
    },
    /// The header lacks a key or has an unreadable value.
    #[error(
        "the header of the .npy file, `{header}`, has no readable `{key}`; expected {expected}"
    )]
    Header {
        /// The header, or its beginning.
        header: String,
        /// The key that is missing or unreadable.
        key: &'static str,
        /// What was expected.
        expected: &'static str,
    },
    /// The file is shorter than its header states.
    #[error("the .npy file has {found} bytes; its header says {expected}")]
    Length {
        /// Bytes expected.
        expected: u128,
        /// Bytes found.
        found: usize,
    },
    /// The array has another shape than expected.
    #[error("an array of shape {found:?}; expected N×{columns}")]
    Shape {
        /// The shape found.
        found: Vec<u64>,
        /// Columns expected.
        columns: String,
    },
}

impl Table {
    /// A table of whole rows; `None` when `values` do not fill rows of `columns`, or `columns` is 0.
    pub fn new(columns: usize, values: Vec<f64>) -> Option<Self> {
        (columns > 0 && values.len().is_multiple_of(columns)).then_some(Self { columns, values })
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of rows.
    pub fn row_count(&self) -> usize {
        self.values.len() / self.columns
    }

    /// The rows.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.columns)
    }

    /// Reads an array of two axes of 32- or 64-bit floats, in either byte and memory order.
    ///
    /// # Errors
    /// The bytes are not such a file, or end too early.
    pub fn from_npy(bytes: &[u8]) -> Result<Self, NpyError> {
        let header = Header::parse(bytes)?;
        let [rows, columns] = header.shape[..] else {
            return Err(header.wrong_shape());
        };
        header.table(bytes, rows, columns)
    }

    /// Reads an array of any number of axes as rows. An array of one axis is one row. All axes but
    /// the first are flattened into a row, as by NumPy's `reshape(N, -1)`.
    /// # Errors
    /// As [`Table::from_npy`], or an array of three axes or more is in Fortran order.
    pub fn from_npy_flattened(bytes: &[u8]) -> Result<Self, NpyError> {
        let header = Header::parse(bytes)?;
        let (rows, columns) = match header.shape[..] {
            [columns] => (1, columns),
            [rows, columns] => (rows, columns),
            [rows, ref rest @ ..] if !header.fortran_order && !rest.is_empty() => {
                let product = rest.iter().try_fold(1_u64, |n, axis| n.checked_mul(*axis));
                (rows, product.ok_or_else(|| header.wrong_shape())?)
            }
            _ => return Err(header.wrong_shape()),
        };
        header.table(bytes, rows, columns)
    }

    /// Reads a table whose number of columns is known.
    ///
    /// # Errors
    /// As [`Table::from_npy`], or the table has another number of columns.
    pub fn from_npy_with_columns(bytes: &[u8], columns: usize) -> Result<Self, NpyError> {
        let wrong = |found| NpyError::Shape {
            found,
            columns: columns.to_string(),
        };
        let table = Self::from_npy(bytes).map_err(|error| match error {
            NpyError::Shape { found, .. } => wrong(found),
            other => other,
        })?;
        if table.columns == columns {
            Ok(table)
        } else {
            let found = [table.row_count(), table.columns];
            Err(wrong(found.map(|n| n as u64).to_vec()))
        }
    }

    /// The bytes of a `.npy` file of version 1 with little-endian doubles.
    ///
    /// ```
    /// use run::npy::Table;
    ///
    /// let table = Table::new(3, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).ok_or("not whole rows")?;
    /// assert_eq!(Table::from_npy(&table.to_npy())?, table);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_npy(&self) -> Vec<u8> {
        let mut header = format!(
            "{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}",
            self.row_count(),
            self.columns
        );
        let prefix = MAGIC.len() + 4;
        let unpadded = prefix + header.len() + 1;
        let padding = unpadded.next_multiple_of(ALIGNMENT) - unpadded;
        header.push_str(&" ".repeat(padding));
        header.push('\n');
        let mut bytes = Vec::with_capacity(prefix + header.len() + 8 * self.values.len());
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&[1, 0]);
        bytes.extend_from_slice(&(header.len() as u16).to_le_bytes());
        bytes.extend_from_slice(header.as_bytes());
        for value in &self.values {
            bytes.extend_from_slice(&value.to_le_bytes());
        }
        bytes
    }
}

/// The storage format of a number.
#[derive(Clone, Copy)]
struct Number {
    is_double: bool,
    is_big_endian: bool,
}

impl Number {
    fn named(name: &str) -> Option<Self> {
        let (order, kind) = name.split_at_checked(1)?;
        let is_big_endian = match order {
            "<" => false,
            ">" => true,
            "=" => cfg!(target_endian = "big"),
            _ => return None,
        };
        let is_double = match kind {
            "f8" => true,
            "f4" => false,
            _ => return None,
        };
        Some(Self {
            is_double,
            is_big_endian,
        })
    }

    fn size(self) -> usize {
        if self.is_double { 8 } else { 4 }
    }

    /// The number stored in `bytes`, whose length is the size of the format.
    fn read(self, bytes: &[u8]) -> f64 {
        let mut word = [0; 8];
        let word = &mut word[..bytes.len()];
        word.copy_from_slice(bytes);
        if self.is_big_endian {
            word.reverse();
        }
        let bits = word
            .iter()
            .rev()
            .fold(0, |bits, b| bits << 8 | u64::from(*b));
        if self.is_double {
            f64::from_bits(bits)
        } else {
            f64::from(f32::from_bits(bits as u32))
        }
    }
}

struct Header {
    number: Number,
    fortran_order: bool,
    shape: Vec<u64>,
    data_start: usize,
}

impl Header {
    fn wrong_shape(&self) -> NpyError {
        NpyError::Shape {
            found: self.shape.clone(),
            columns: "M".to_owned(),
        }
    }

    /// The numbers after the header, as rows.
    fn table(&self, bytes: &[u8], rows: u64, columns: u64) -> Result<Table, NpyError> {
        if columns == 0 {
            return Err(self.wrong_shape());
        }
        let data = &bytes[self.data_start..];
        let size = self.number.size();
        // The size is checked before memory is allocated.
        let expected = u128::from(rows)
            .saturating_mul(u128::from(columns))
            .saturating_mul(size as u128);
        if expected > data.len() as u128 {
            return Err(NpyError::Length {
                expected: expected.saturating_add(self.data_start as u128),
                found: bytes.len(),
            });
        }
        let (rows, columns) = (rows as usize, columns as usize);
        let at = |index: usize| self.number.read(&data[index * size..(index + 1) * size]);
        let values = if self.fortran_order {
            (0..rows * columns)
                .map(|i| at((i % columns) * rows + i / columns))
                .collect()
        } else {
            (0..rows * columns).map(at).collect()
        };
        Ok(Table { columns, values })
    }

    fn parse(bytes: &[u8]) -> Result<Self, NpyError> {
        if !bytes.starts_with(MAGIC) {
            return Err(NpyError::Magic);
        }
        let range = header_range(bytes)?;
        let text = String::from_utf8_lossy(&bytes[range.clone()]);
        let wrong = |key, expected| NpyError::Header {
            header: text.trim().chars().take(80).collect(),
            key,
            expected,
        };
        let float = "32- or 64-bit floating point numbers ('<f4' or '<f8')";
        let number = value_of(&text, "descr")
            .and_then(quoted)
            .and_then(Number::named)
            .ok_or_else(|| wrong("descr", float))?;
        let fortran_order = value_of(&text, "fortran_order")
            .and_then(boolean)
            .ok_or_else(|| wrong("fortran_order", "True or False"))?;
        let shape = value_of(&text, "shape")
            .and_then(tuple)
            .ok_or_else(|| wrong("shape", "a tuple of whole numbers"))?;
        Ok(Self {
            number,
            fortran_order,
            shape,
            data_start: range.end,
        })
    }
}

/// The byte range of the header's text.
fn header_range(bytes: &[u8]) -> Result<Range<usize>, NpyError> {
    let short = |expected: usize| NpyError::Length {
        expected: expected as u128,
        found: bytes.len(),
    };
    let version = *bytes
        .get(MAGIC.len())
        .ok_or_else(|| short(MAGIC.len() + 2))?;
    let start = MAGIC.len() + 2;
    let width = match version {
        1 => 2,
        2 | 3 => 4,
        major => return Err(NpyError::Version { major }),
    };
    let length = bytes
        .get(start..start + width)
        .ok_or_else(|| short(start + width))?;
    let length = length
        .iter()
        .rev()
        .fold(0, |sum, b| sum << 8 | usize::from(*b));
    let range = start + width..start + width + length;
    if length > MAX_HEADER {
        return Err(NpyError::Header {
            header: format!("{length} bytes"),
            key: "descr",
            expected: "a header of at most 4096 bytes",
        });
    }
    if range.end > bytes.len() {
        return Err(short(range.end));
    }
    Ok(range)
}

/// The text after `'key':` in a Python dictionary; no value may contain that text.
fn value_of<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let mut quotes = ['\'', '"'].into_iter();
    let rest = quotes.find_map(|quote| {
        let named = format!("{quote}{key}{quote}");
        header.split_once(&named).map(|(_, rest)| rest)
    })?;
    rest.trim_start().strip_prefix(':').map(str::trim_start)
}

fn quoted(text: &str) -> Option<&str> {
    let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    text[1..].split_once(quote).map(|(inside, _)| inside)
}

fn boolean(text: &str) -> Option<bool> {
    [("True", true), ("False", false)]
        .into_iter()
        .find_map(|(word, value)| text.starts_with(word).then_some(value))
}

fn tuple(text: &str) -> Option<Vec<u64>> {
    let (inside, _) = text.strip_prefix('(')?.split_once(')')?;
    let parts = inside.split(',').map(str::trim);
    parts
        .filter(|part| !part.is_empty())
        // Python 2 writes long integers with a suffix L.
        .map(|part| part.trim_end_matches('L').parse().ok())
        .collect()
}
