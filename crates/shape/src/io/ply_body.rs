//! The rows of a PLY file: numbers one after the other, as text or as bytes.

use super::error::{LoadError, quoted};
use super::format::Format;
use super::ply_header::{Encoding, Header, Scalar};
use super::text::number;

/// Reads the numbers of the body in their order.
pub(super) struct Body<'a> {
    bytes: &'a [u8],
    at: usize,
    encoding: Encoding,
    /// The line of `at` in a text.
    line: usize,
}

impl<'a> Body<'a> {
    pub(super) fn new(bytes: &'a [u8], header: &Header) -> Self {
        Self {
            bytes,
            at: header.start,
            encoding: header.encoding,
            line: header.start_line,
        }
    }

    /// Bytes that are left.
    pub(super) fn rest(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Whether only blanks are left or the next number is on a new line; false for binary data.
    pub(super) fn at_line_end(&self) -> bool {
        if self.encoding != Encoding::Text {
            return true;
        }
        let rest = self.bytes[self.at..].iter();
        let mut after = rest.skip_while(|b| matches!(b, b' ' | b'\t'));
        matches!(after.next(), None | Some(b'\n' | b'\r'))
    }

    /// The next word of a text, if there is one.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        while let Some(&byte) = self.bytes.get(self.at) {
            let after_return = byte == b'\n' && self.at > 0 && self.bytes[self.at - 1] == b'\r';
            match byte {
                b'\n' if after_return => {}
                b'\n' | b'\r' => self.line += 1,
                _ if byte.is_ascii_whitespace() => {}
                _ => break,
            }
            self.at += 1;
        }
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(u8::is_ascii_whitespace);
        let word = &rest[..end.unwrap_or(rest.len())];
        self.at += word.len();
        (!word.is_empty()).then_some(word)
    }

    /// The next number; `expected` says what it is.
    pub(super) fn number(&mut self, scalar: Scalar, expected: &str) -> Result<f64, LoadError> {
        if self.encoding != Encoding::Text {
            return Ok(self.raw(scalar, expected)?.0);
        }
        let Some(word) = self.word() else {
            return Err(self.end(expected));
        };
        let text = std::str::from_utf8(word).ok();
        text.and_then(number)
            .ok_or_else(|| self.refuse(expected, &String::from_utf8_lossy(word)))
    }

    /// The next number as a whole one.
    pub(super) fn whole(&mut self, scalar: Scalar, expected: &str) -> Result<i64, LoadError> {
        let value = self.number(scalar, expected)?;
        let fits = value.fract() == 0.0 && value.abs() < 9e15;
        if fits {
            Ok(value as i64)
        } else {
            Err(self.refuse(expected, &value.to_string()))
        }
    }

    /// Skips a number of any value.
    pub(super) fn skip(&mut self, scalar: Scalar, expected: &str) -> Result<(), LoadError> {
        if self.encoding == Encoding::Text {
            let found = self.word().is_some();
            return if found {
                Ok(())
            } else {
                Err(self.end(expected))
            };
        }
        self.raw(scalar, expected).map(drop)
    }

    /// Skips the rest of a list, in a time linear in the bytes that exist.
    pub(super) fn skip_list(
        &mut self,
        count: i64,
        scalar: Scalar,
        expected: &str,
    ) -> Result<(), LoadError> {
        let count = self.count(count, scalar, expected)?;
        if self.encoding == Encoding::Text {
            return (0..count).try_for_each(|_| self.skip(scalar, expected));
        }
        self.at += count * scalar.size();
        Ok(())
    }

    /// The length of a list, checked against what is left.
    pub(super) fn count(
        &mut self,
        count: i64,
        scalar: Scalar,
        expected: &str,
    ) -> Result<usize, LoadError> {
        let each = if self.encoding == Encoding::Text {
            1
        } else {
            scalar.size()
        };
        let count = usize::try_from(count)
            .map_err(|_| self.refuse("the length of a list", &count.to_string()))?;
        match count.checked_mul(each) {
            Some(needed) if needed <= self.rest() => Ok(count),
            _ => Err(self.end(&format!("{expected}: {count} numbers"))),
        }
    }

    fn raw(&mut self, scalar: Scalar, expected: &str) -> Result<(f64, usize), LoadError> {
        let size = scalar.size();
        let Some(bytes) = self.bytes.get(self.at..self.at + size) else {
            return Err(self.end(expected));
        };
        self.at += size;
        let push = |word: u64, byte: &u8| word << 8 | u64::from(*byte);
        let word = match self.encoding {
            Encoding::Big => bytes.iter().fold(0, push),
            _ => bytes.iter().rev().fold(0, push),
        };
        let unused = 64 - 8 * size as u32;
        let value = match scalar {
            Scalar::Float => f64::from(f32::from_bits(word as u32)),
            Scalar::Double => f64::from_bits(word),
            // Shifting up and back spreads the sign.
            Scalar::Signed(_) => ((word << unused) as i64 >> unused) as f64,
            Scalar::Unsigned(_) => word as f64,
        };
        Ok((value, size))
    }

    /// The end of the file where more was expected.
    pub(super) fn end(&self, expected: &str) -> LoadError {
        match self.encoding {
            Encoding::Text => LoadError::end_of_text(Format::Ply, self.line, expected),
            _ => LoadError::byte(
                Format::Ply,
                self.bytes.len(),
                expected.to_owned(),
                "the end of the file".to_owned(),
            ),
        }
    }

    /// Something else than expected, at the last number.
    pub(super) fn refuse(&self, expected: &str, found: &str) -> LoadError {
        match self.encoding {
            Encoding::Text => LoadError::line(Format::Ply, self.line, expected, found),
            _ => LoadError::byte(Format::Ply, self.at, expected.to_owned(), quoted(found)),
        }
    }
}
