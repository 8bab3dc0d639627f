//! XYZ, CSV and their relatives: one point per line.

use nalgebra::Point3;

use super::error::{Format, LoadError};
use super::geometry::Raw;
use super::table_header::{self, Unnamed};
use super::text::{Lines, number};

/// What begins a comment.
const COMMENTS: [&str; 3] = ["#", "//", "%"];

/// Reads the columns that a header calls x, y and z, or the first three where there is none.
///
/// Columns are separated by semicolons if the line has any, else by commas, else by blanks; beside
/// semicolons a comma is a decimal comma. `#`, `//` and `%` begin comments. One header line is allowed
/// before the first point, as a comment or not, and a line with the number of points alone. A header
/// among whose names no x, y and z are found is refused, since the first three columns would be a
/// guess.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let mut raw = Raw::default();
    let mut columns = [0, 1, 2];
    let mut header_seen = false;
    for line in Lines::new(bytes, &COMMENTS) {
        if raw.vertices.is_empty() && !header_seen {
            if is_header(&line.text) {
                header_seen = true;
                columns = named_columns(&line.text, line.number)?;
                continue;
            }
            if is_numbered(&line.text) {
                let expected = "column names x, y and z instead of column numbers, or no header";
                let (number, text) = (line.number, &line.text);
                return Err(LoadError::line(Format::Xyz, number, expected, text));
            }
            columns = commented_columns(bytes, fields(&line.text).len()).unwrap_or(columns);
        }
        let point = point(&line.text, columns).ok_or_else(|| {
            let expected = "three numbers x y z";
            LoadError::line(Format::Xyz, line.number, expected, &line.text)
        })?;
        raw.vertices.push(point);
    }
    Ok(raw)
}

fn fields(line: &str) -> Vec<&str> {
    match [';', ','].into_iter().find(|c| line.contains(*c)) {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// A number, perhaps with a decimal comma: where commas separate, no field has one.
fn value(field: &str) -> Option<f64> {
    number(&field.replace(',', "."))
}

fn point(line: &str, columns: [usize; 3]) -> Option<Point3<f64>> {
    let fields = fields(line);
    let coordinate = |axis: usize| match *fields.get(columns[axis])? {
        // A missing value: the row is dropped and counted.
        "" => Some(f64::NAN),
        field => value(field),
    };
    Some(Point3::new(coordinate(0)?, coordinate(1)?, coordinate(2)?))
}

/// Column names, or the number of points that some programs write first.
fn is_header(line: &str) -> bool {
    let fields = fields(line);
    let names = fields.len() >= 3 && fields.iter().all(|f| value(unquoted(f)).is_none());
    let count = fields.len() == 1 && fields[0].parse::<u64>().is_ok();
    names || count
}

/// The header of a table with an index and without names, as pandas writes it: `,0,1,2`.
fn is_numbered(line: &str) -> bool {
    let fields = fields(line);
    fields.len() > 3
        && fields[0].is_empty()
        && fields[1..]
            .iter()
            .enumerate()
            .all(|(k, field)| *field == k.to_string())
}

/// The columns that a header names. A line with the number of points alone names none.
fn named_columns(line: &str, number: usize) -> Result<[usize; 3], LoadError> {
    let names = fields(line);
    if names.len() == 1 {
        return Ok([0, 1, 2]);
    }
    table_header::columns(&names).map_err(|why| {
        let expected = match why {
            Unnamed::None => "a header with columns named x, y and z (or no header)",
            Unnamed::Several => "a header with one group of columns named x, y and z",
        };
        LoadError::line(Format::Xyz, number, expected, line)
    })
}

/// The columns that the last comment before the first row names, if it names as many columns as the
/// row has fields.
fn commented_columns(bytes: &[u8], count: usize) -> Option<[usize; 3]> {
    let lines = bytes
        .split(|byte| *byte == b'\n')
        .map(String::from_utf8_lossy);
    let comments = lines
        .map(|line| line.trim().to_owned())
        .take_while(|line| line.is_empty() || COMMENTS.iter().any(|c| line.starts_with(c)));
    let last = comments.filter(|line| !line.is_empty()).last()?;
    let header = last.trim_start_matches(['#', '/', '%']).trim_start();
    let names = fields(header);
    (names.len() == count)
        .then(|| table_header::columns(&names).ok())
        .flatten()
}

fn unquoted(field: &str) -> &str {
    field.trim_matches(['"', '\''])
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
        ] {
            let raw = read(text.as_bytes()).unwrap();
            let expected = [Point3::new(1.0, 2.0, 3.0), Point3::new(4.0, 5.0, 6.0)];
            assert_eq!(raw.vertices, expected, "{text}");
        }
    }

    #[test]
    fn the_bad_line_is_named() {
        for (text, bad) in [("1 2 3\n4 5\n", 2), ("x y z\nfoo bar baz\n", 2), ("a", 1)] {
            let error = read(text.as_bytes()).err().unwrap();
            assert!(
                matches!(error, LoadError::Line { line, .. } if line == bad),
                "{error}"
            );
        }
    }

    #[test]
    fn columns_are_found_by_their_names() {
        let expected = [Point3::new(1.0, 2.0, 3.5), Point3::new(4.0, 5.0, 6.0)];
        for text in [
            "timestamp,x [m],y [m],z [m]\n17,1,2,3.5\n18,4,5,6\n",
            "id,pos_x,pos_y,pos_z\n0,1,2,3.5\n1,4,5,6\n",
            "\"Result\",\"Points:0\",\"Points:1\",\"Points:2\"\n9,1,2,3.5\n9,4,5,6\n",
            "# id x y z\n0 1 2 3.5\n1 4 5 6\n",
            "x;y;z\n1,0;2,0;3,5\n4,0;5,0;6,0\n",
            "1,0;2,0;3,5\n4,0;5,0;6,0\n",
        ] {
            assert_eq!(read(text.as_bytes()).unwrap().vertices, expected, "{text}");
        }
    }

    #[test]
    fn headers_that_name_no_coordinates_are_refused_and_shown() {
        for (text, shown) in [
            ("a,b,c\n1,2,3\n", "a,b,c"),
            (",0,1,2\n0,1,2,3\n", "column names"),
            (
                "left_x,left_y,left_z,right_x,right_y,right_z\n1,2,3,4,5,6\n",
                "one group",
            ),
        ] {
            let error = read(text.as_bytes()).err().unwrap().to_string();
            assert!(error.contains(shown) && error.contains("line 1"), "{error}");
        }
    }

    #[test]
    fn missing_values_are_not_finite() {
        let raw = read(b"1,,3\n4,5,6\n").unwrap();
        assert!(raw.vertices[0].y.is_nan());
    }
}
