//! Lines and numbers of text formats.

use std::borrow::Cow;

/// One line that is not blank after comments are cut off.
pub(super) struct Line<'a> {
    /// From 1.
    pub(super) number: usize,
    /// Without comment and surrounding blanks.
    pub(super) text: Cow<'a, str>,
}

/// The lines of a text, with LF, CR LF or CR ends.
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    next: usize,
    comment: &'static [&'static str],
}

impl<'a> Lines<'a> {
    /// Lines of `bytes`, cut at the first of the `comment` markers.
    pub(super) fn new(bytes: &'a [u8], comment: &'static [&'static str]) -> Self {
        // A byte order mark is no part of the first line.
        let rest = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        Self {
            rest,
            next: 1,
            comment,
        }
    }

    /// The number of the line after the last one.
    pub(super) fn next_number(&self) -> usize {
        self.next
    }

    fn raw(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|b| matches!(b, b'\n' | b'\r'));
        let end = end.unwrap_or(self.rest.len());
        let (line, tail) = self.rest.split_at(end);
        self.rest = match tail {
            [b'\r', b'\n', tail @ ..] | [_, tail @ ..] => tail,
            [] => tail,
        };
        self.next += 1;
        Some(line)
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        loop {
            let number = self.next;
            let text = String::from_utf8_lossy(self.raw()?);
            let end = self.comment.iter().filter_map(|c| text.find(c)).min();
            let end = end.unwrap_or(text.len());
            let text = match text {
                Cow::Borrowed(text) => Cow::Borrowed(text[..end].trim()),
                Cow::Owned(text) => Cow::Owned(text[..end].trim().to_owned()),
            };
            if !text.is_empty() {
                return Some(Line { number, text });
            }
        }
    }
}

/// The words of a text with their lines, wherever the lines break; `#` begins a comment.
#[derive(Clone)]
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xEF\xBB\xBF") {
            3
        } else {
            0
        };
        Self { bytes, at, line: 1 }
    }

    /// The line of the word that was read last.
    pub(super) fn line(&self) -> usize {
        self.line
    }
}

impl<'a> Iterator for Words<'a> {
    /// A word is empty where it is not UTF-8.
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let mut in_comment = false;
        loop {
            let rest = &self.bytes[self.at..];
            match rest {
                [] => return None,
                // The line feed behind it ends the line.
                [b'\r', b'\n', ..] => {}
                [b'\n' | b'\r', ..] => {
                    in_comment = false;
                    self.line += 1;
                }
                [b'#', ..] => in_comment = true,
                [byte, ..] if in_comment || byte.is_ascii_whitespace() => {}
                _ => {
                    let ends = |b: &u8| b.is_ascii_whitespace() || *b == b'#';
                    let end = rest.iter().position(ends).unwrap_or(rest.len());
                    self.at += end;
                    return Some(std::str::from_utf8(&rest[..end]).unwrap_or_default());
                }
            }
            self.at += 1;
        }
    }
}

/// A number as scanners write it: also `nan`, `-nan(ind)` and `inf`.
pub(super) fn number(word: &str) -> Option<f64> {
    if let Ok(value) = word.parse() {
        return Some(value);
    }
    let bare = word.trim_start_matches(['+', '-']).to_ascii_lowercase();
    let odd = bare.starts_with("nan(") || bare.starts_with("1.#");
    odd.then_some(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_numbered_with_any_end() {
        let bytes = b"\xEF\xBB\xBFa # x\r\n\r\nb\r# c\nd\n";
        let lines: Vec<_> = Lines::new(bytes, &["#"])
            .map(|l| (l.number, l.text.into_owned()))
            .collect();
        let expected = [(1, "a"), (3, "b"), (5, "d")].map(|(n, t)| (n, t.to_owned()));
        assert_eq!(lines, expected);
    }

    #[test]
    fn words_know_their_lines() {
        let mut words = Words::new(b"\xEF\xBB\xBFa b#c d\r\n# e\rf\n\xFF g");
        let mut seen = Vec::new();
        while let Some(word) = words.next() {
            seen.push((words.line(), word));
        }
        assert_eq!(seen, [(1, "a"), (1, "b"), (3, "f"), (4, ""), (4, "g")]);
    }

    #[test]
    fn odd_numbers_are_numbers() {
        assert_eq!(number("-1e-3"), Some(-1e-3));
        for odd in ["nan", "-NaN(ind)", "1.#QNAN"] {
            assert!(number(odd).is_some_and(f64::is_nan));
        }
        assert_eq!(number("x1"), None);
    }
}
