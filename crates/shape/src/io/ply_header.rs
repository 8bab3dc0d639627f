//! The header of a PLY file: elements and their properties.

use super::error::{LoadError, quoted};
use super::format::Format;

/// How the numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Little,
    Big,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    Signed(usize),
    Unsigned(usize),
    Float,
    Double,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "char" | "int8" => Self::Signed(1),
            "short" | "int16" => Self::Signed(2),
            "int" | "int32" => Self::Signed(4),
            "int64" | "long" | "longlong" => Self::Signed(8),
            "uchar" | "uint8" | "byte" => Self::Unsigned(1),
            "ushort" | "uint16" => Self::Unsigned(2),
            "uint" | "uint32" => Self::Unsigned(4),
            "uint64" | "ulong" | "ulonglong" => Self::Unsigned(8),
            "float" | "float32" => Self::Float,
            "double" | "float64" => Self::Double,
            _ => return None,
        })
    }

    /// Bytes of one number.
    pub(super) fn size(self) -> usize {
        match self {
            Self::Signed(size) | Self::Unsigned(size) => size,
            Self::Float => 4,
            Self::Double => 8,
        }
    }

    pub(super) fn is_whole(self) -> bool {
        matches!(self, Self::Signed(_) | Self::Unsigned(_))
    }
}

/// A property of an element.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    /// The type of the count, for a list.
    pub(super) list: Option<Scalar>,
    pub(super) scalar: Scalar,
}

/// An element and its number of rows.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
    /// The line that declares it.
    pub(super) line: usize,
}

impl Element {
    /// The fewest bytes of one row, or the fewest numbers of a text.
    pub(super) fn least_row(&self, encoding: Encoding) -> usize {
        let least = |p: &Property| match encoding {
            Encoding::Text => 2,
            _ => p.list.unwrap_or(p.scalar).size(),
        };
        self.properties.iter().map(least).sum()
    }
}

/// A whole header.
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Where the body begins: byte from 0, and line from 1.
    pub(super) start: usize,
    pub(super) start_line: usize,
}

/// The most elements, and the most properties of one element.
const MOST: usize = 1000;

/// Reads up to `end_header`. Lines may end in LF, CR LF or CR, all alike.
pub(super) fn read(bytes: &[u8]) -> Result<Header, LoadError> {
    let mark = if bytes.starts_with(b"\xEF\xBB\xBF") {
        3
    } else {
        0
    };
    let line_end = line_end(&bytes[mark..]);
    let (mut at, mut number) = (mark, 0);
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    while at < bytes.len() {
        let rest = &bytes[at..];
        let end = rest.iter().position(|b| *b == line_end);
        let line = String::from_utf8_lossy(&rest[..end.unwrap_or(rest.len())]);
        at += end.map_or(rest.len(), |end| end + 1);
        number += 1;
        let mut words: Vec<&str> = line.split_whitespace().collect();
        // Keywords are read in any case, names are not.
        let key = words.first().map(|w| w.to_ascii_lowercase());
        if let (Some(first), Some(key)) = (words.first_mut(), &key) {
            *first = key;
        }
        let refuse = |expected: &str| LoadError::line(Format::Ply, number, expected, line.trim());
        match words[..] {
            ["ply"] if number == 1 => {}
            _ if number == 1 => return Err(refuse("`ply`")),
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name, ..] => {
                let known = named_encoding(name);
                encoding = Some(known.ok_or_else(|| {
                    refuse("`format` and ascii, binary_little_endian or binary_big_endian")
                })?);
            }
            ["element", .., count] if words.len() >= 3 && elements.len() < MOST => {
                let expected = "`element`, a name and a number of rows";
                elements.push(Element {
                    name: words[1..words.len() - 1].join(" "),
                    count: count.parse().map_err(|_| refuse(expected))?,
                    properties: Vec::new(),
                    line: number,
                });
            }
            ["property", ..] => {
                let last = elements.last_mut().filter(|e| e.properties.len() < MOST);
                let element = last.ok_or_else(|| refuse("`element` before `property`"))?;
                element
                    .properties
                    .push(property(&words[1..]).map_err(|e| refuse(&e))?);
            }
            ["end_header"] => {
                return Ok(Header {
                    encoding: encoding.ok_or_else(|| refuse("a line `format` before"))?,
                    elements,
                    start: at,
                    start_line: number + 1,
                });
            }
            _ => return Err(refuse("format, comment, element, property or end_header")),
        }
    }
    Err(LoadError::end_of_text(
        Format::Ply,
        number + 1,
        "`end_header`",
    ))
}

/// The byte that ends a line. A return before a line feed counts as a blank.
fn line_end(bytes: &[u8]) -> u8 {
    let first = bytes.iter().position(|b| matches!(b, b'\n' | b'\r'));
    match first.map(|i| &bytes[i..]) {
        Some([b'\r', next, ..]) if *next != b'\n' => b'\r',
        _ => b'\n',
    }
}

fn named_encoding(name: &str) -> Option<Encoding> {
    Some(match name.to_ascii_lowercase().as_str() {
        "ascii" => Encoding::Text,
        "binary_little_endian" => Encoding::Little,
        "binary_big_endian" => Encoding::Big,
        _ => return None,
    })
}

/// A property after its keyword. A name may have blanks and any signs.
fn property(words: &[&str]) -> Result<Property, String> {
    let types = "a type of number (int8 to uint64, float, double)";
    let scalar =
        |word: &str| Scalar::named(word).ok_or(format!("{types} instead of {}", quoted(word)));
    match words {
        [kind, count, item, name @ ..] if kind.eq_ignore_ascii_case("list") && !name.is_empty() => {
            let count = scalar(count)?;
            if !count.is_whole() {
                return Err("a whole type for the count of a list".to_owned());
            }
            Ok(Property {
                name: name.join(" "),
                list: Some(count),
                scalar: scalar(item)?,
            })
        }
        [kind, name @ ..] if !name.is_empty() => Ok(Property {
            name: name.join(" "),
            list: None,
            scalar: scalar(kind)?,
        }),
        _ => Err("a type and a name after `property`".to_owned()),
    }
}
