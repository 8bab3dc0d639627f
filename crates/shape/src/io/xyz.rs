//! XYZ, CSV and their relatives: one point per line, in columns.

use nalgebra::Point3;

use super::error::LoadError;
use super::format::Format;
use super::geometry::Raw;
use super::table_header::{self, Unnamed};
use super::text::{Lines, number};

/// Beginnings of comments.
const COMMENTS: &[&str] = &["#", "//", "%"];

/// Reads the columns that a header calls x, y and z, or the first three where there is no header.
///
/// Columns are separated by semicolons, tabs, commas or blanks; a number may have a decimal comma
/// where the comma does not separate. `#`, `//` and `%` begin comments. A header may stand in the
/// last comment before the first point. A header with names among which x, y and z cannot be
/// told is refused. A line with the number of points alone may come first.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let layout = Layout::find(bytes)?;
    let mut raw = Raw::default();
    let mut last = 1;
    for line in Lines::new(bytes, COMMENTS) {
        last = line.number;
        if line.number < layout.first {
            continue;
        }
        let refuse = || {
            let expected = match layout.separator {
                Separator::Sign(',') => {
                    "three numbers x y z (with decimal points where commas separate)"
                }
                _ => "three numbers x y z",
            };
            LoadError::line(Format::Xyz, line.number, expected, &line.text)
        };
        raw.vertices
            .push(layout.point(&line.text).ok_or_else(refuse)?);
    }
    match layout.count {
        Some(count) if count as usize > raw.vertices.len() => {
            let expected = format!("{count} points, {} read", raw.vertices.len());
            Err(LoadError::end_of_text(Format::Xyz, last, &expected))
        }
        _ => Ok(raw),
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Separator {
    Sign(char),
    Blanks,
}

/// Where the points begin and how a line is read.
struct Layout {
    separator: Separator,
    decimal_comma: bool,
    columns: [usize; 3],
    /// The line of the first point.
    first: usize,
    /// Points that the file promises.
    count: Option<u64>,
}

impl Layout {
    fn find(bytes: &[u8]) -> Result<Self, LoadError> {
        let mut layout = Self {
            separator: Separator::Blanks,
            decimal_comma: false,
            columns: [0, 1, 2],
            first: usize::MAX,
            count: None,
        };
        let mut header: Option<(usize, String)> = None;
        let mut lines = Lines::new(bytes, COMMENTS);
        let Some(mut line) = lines.next() else {
            return Ok(layout);
        };
        if let Ok(count) = line.text.parse() {
            layout.count = Some(count);
            let Some(next) = lines.next() else {
                let expected = "three numbers x y z";
                return Err(LoadError::line(
                    Format::Xyz,
                    line.number,
                    expected,
                    &line.text,
                ));
            };
            line = next;
        }
        layout.separate(&line.text);
        let second = lines.next();
        if layout.is_header(&line.text, second.as_ref().map(|l| l.text.as_ref())) {
            header = Some((line.number, line.text.clone().into_owned()));
            layout.first = second.as_ref().map_or(usize::MAX, |l| l.number);
            if let Some(second) = &second {
                layout.separate(&second.text);
            }
        } else {
            layout.first = line.number;
            second
                .as_ref()
                .inspect(|l| layout.decimal_comma &= layout.comma_is_decimal(&l.text));
        }
        if let Some((number, text)) = header {
            layout.columns = layout.named(&text, number)?;
        } else {
            let width = layout.fields(&line.text).len();
            layout.columns = commented_columns(bytes, layout.first, width).unwrap_or([0, 1, 2]);
        }
        Ok(layout)
    }

    /// Chooses the separator by the look of one line.
    fn separate(&mut self, line: &str) {
        let sign = [';', '\t', ',']
            .into_iter()
            .find(|sign| line.contains(*sign));
        self.separator = match sign {
            Some(',') if blanks_and_decimal_commas(line) => Separator::Blanks,
            Some(sign) => Separator::Sign(sign),
            None => Separator::Blanks,
        };
        self.decimal_comma = self.separator != Separator::Sign(',') && self.comma_is_decimal(line);
    }

    fn comma_is_decimal(&self, line: &str) -> bool {
        line.contains(',') && self.fields(line).iter().all(|f| !f.contains('.'))
    }

    fn fields<'a>(&self, line: &'a str) -> Vec<&'a str> {
        match self.separator {
            Separator::Sign(sign) => line.split(sign).map(str::trim).collect(),
            Separator::Blanks => line.split_whitespace().collect(),
        }
    }

    fn number(&self, field: &str) -> Option<f64> {
        let field = field.trim_matches(['"', '\'']);
        // Beside commas, `0057` is the second half of a number with a decimal comma.
        let half =
            |f: &str| f.len() > 1 && f.starts_with('0') && f.bytes().all(|b| b.is_ascii_digit());
        if self.separator == Separator::Sign(',') && half(field) {
            return None;
        }
        match self.decimal_comma && field.contains(',') {
            true => number(&field.replacen(',', ".", 1)),
            false => number(field),
        }
    }

    fn point(&self, line: &str) -> Option<Point3<f64>> {
        // Commas and blanks may be mixed from line to line.
        let has_comma = line.contains(',');
        let mixed = match self.separator {
            Separator::Blanks => has_comma && !self.decimal_comma,
            Separator::Sign(',') => !has_comma,
            Separator::Sign(_) => false,
        };
        let fields = if mixed {
            line.split([',', ' ', '\t'])
                .filter(|f| !f.is_empty())
                .collect()
        } else {
            self.fields(line)
        };
        let coordinate = |axis: usize| match *fields.get(self.columns[axis])? {
            // A missing value: the row is dropped and counted.
            "" => Some(f64::NAN),
            field => self.number(field),
        };
        Some(Point3::new(coordinate(0)?, coordinate(1)?, coordinate(2)?))
    }

    /// Names, or the numbers 0, 1, 2 … that stand for names.
    fn is_header(&self, line: &str, next: Option<&str>) -> bool {
        let fields = self.fields(line);
        let names = |f: &&&str| !f.is_empty() && self.number(f).is_none();
        let unnamed = fields.iter().filter(names).count();
        if fields.len() >= 3 && unnamed > 0 {
            // A row with one bad number is no header.
            return 2 * unnamed > fields.len();
        }
        let rest = fields.strip_prefix(&[""]).unwrap_or(&fields);
        let counted = rest.len() >= 3 && rest.iter().enumerate().all(|(i, f)| *f == i.to_string());
        let fractions = next.is_some_and(|n| n.contains('.') || self.decimal_comma);
        counted && self.separator != Separator::Blanks && fractions
    }

    fn named(&self, header: &str, line: usize) -> Result<[usize; 3], LoadError> {
        let separated = self.fields(header);
        // The names may be separated by blanks or commas above columns of another kind.
        let fields = if separated.len() >= 3 {
            separated
        } else {
            header
                .split([',', ';', '\t', ' '])
                .filter(|f| !f.is_empty())
                .collect()
        };
        if let Some(at) = fields.iter().position(|f| *f == "0") {
            let counted = (0..3).all(|i| fields.get(at + i).is_some_and(|f| *f == i.to_string()));
            if counted {
                return Ok([at, at + 1, at + 2]);
            }
        }
        table_header::columns(&fields).map_err(|why| {
            let expected = match why {
                Unnamed::None => "a header with columns named x, y and z (or no header)",
                Unnamed::Several => "a header with one group of columns named x, y and z",
            };
            LoadError::line(Format::Xyz, line, expected, header)
        })
    }
}

/// Whether all blank-separated fields are numbers with one decimal comma or none.
fn blanks_and_decimal_commas(line: &str) -> bool {
    let number = |field: &str| {
        let (whole, part) = field.split_once(',').unwrap_or((field, "0"));
        let digits = |t: &str| !t.is_empty() && t.bytes().all(|b| b.is_ascii_digit());
        let exponent = part.split(['e', 'E']).next().unwrap_or_default();
        digits(whole.trim_start_matches(['+', '-'])) && digits(exponent)
    };
    let fields: Vec<&str> = line.split_whitespace().collect();
    fields.len() >= 3 && fields.iter().all(|f| number(f))
}

/// The columns that the last comment before a line names, among those that name `width` columns.
///
/// A comment may say anything; only names of coordinates count.
fn commented_columns(bytes: &[u8], line: usize, width: usize) -> Option<[usize; 3]> {
    let before = Lines::new(bytes, &[]).take_while(|l| l.number < line);
    let comments = before.filter(|l| COMMENTS.iter().any(|c| l.text.starts_with(c)));
    let named = comments.filter_map(|comment| {
        let fields = comment_fields(&comment.text);
        let names: Vec<&str> = fields.iter().map(String::as_str).collect();
        let columns = table_header::columns(&names).ok();
        columns.filter(|_| names.len() == width)
    });
    named.last()
}

fn comment_fields(comment: &str) -> Vec<String> {
    let bare = comment.trim_start_matches(['#', '/', '%', ' ', '\t']);
    let sign = [';', '\t', ',']
        .into_iter()
        .find(|sign| bare.contains(*sign));
    match sign {
        Some(sign) => bare.split(sign).map(|f| f.trim().to_owned()).collect(),
        None => bare.split_whitespace().map(str::to_owned).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_blanks_comments_headers() {
        for text in [
            "# made by hand\n1 2 3\n4 5 6 // last\n",
            "x,y,z\r\n1,2,3\r\n4, 5, 6",
            "\"id\";\"Z\";\"Y\";\"X\"\n9;3;2;1\n9;6;5;4\n",
            "2\n1\t2\t3\t255\n4\t5\t6\t255\n",
            "# id x y z\n7 1 2 3\n7 4 5 6\n",
            "//R G B X Y Z\n9 9 9 1 2 3\n9 9 9 4 5 6\n",
            ",0,1,2\n0,1.0,2.0,3.0\n1,4.0,5.0,6.0\n",
            "0,1,2\n1.0,2.0,3.0\n4.0,5.0,6.0\n",
            "x;y;z\n1,0;2,0;3,0\n4,0;5,0;6,0\n",
            "1,0 2,0 3,0\n4,0 5,0 6,0\n",
            "x y z\n1, 2, 3,\n4 5 6\n",
        ] {
            let raw = read(text.as_bytes()).unwrap();
            let expected = [Point3::new(1.0, 2.0, 3.0), Point3::new(4.0, 5.0, 6.0)];
            assert_eq!(raw.vertices, expected, "{text}");
        }
    }

    #[test]
    fn points_of_whole_numbers_are_no_header() {
        let raw = read(b"0 1 2\n3 4 5\n").unwrap();
        assert_eq!(raw.vertices.len(), 2);
        assert_eq!(read(b"0,1,2\n3,4,5\n").unwrap().vertices.len(), 2);
    }

    #[test]
    fn the_bad_line_is_named() {
        for (text, bad) in [
            ("1 2 3\n4 5\n", 2),
            ("x y z\nfoo bar baz\n", 2),
            ("a", 1),
            ("lat,lon,height\n1,2,3\n", 1),
            ("3\n1 2 3\n4 5 6\n", 3),
        ] {
            let error = read(text.as_bytes()).err().unwrap();
            assert!(
                matches!(error, LoadError::Line { line, .. } if line == bad),
                "{error}"
            );
        }
    }

    #[test]
    fn missing_values_are_not_finite() {
        let raw = read(b"1,,3\n4,5,6\n").unwrap();
        assert!(raw.vertices[0].y.is_nan());
    }
}
