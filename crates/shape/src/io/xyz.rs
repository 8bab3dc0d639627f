//! XYZ, CSV and their relatives: one point a line.

use nalgebra::Point3;

use super::error::{Format, LoadError};
use super::geometry::Raw;
use super::text::{Lines, number};

/// Reads the first three columns, or those that a header line calls x, y and z.
///
/// Columns are separated by commas or semicolons if the line has any, else by blanks. `#`, `//`
/// and `%` begin comments. One header line is allowed before the first point, and a line with
/// the number of points alone.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let mut raw = Raw::default();
    let mut columns = [0, 1, 2];
    let mut header_seen = false;
    for line in Lines::new(bytes, &["#", "//", "%"]) {
        match point(&line.text, columns) {
            Some(p) => raw.vertices.push(p),
            None if raw.vertices.is_empty() && !header_seen && is_header(&line.text) => {
                header_seen = true;
                columns = named_columns(&line.text).unwrap_or(columns);
            }
            None => {
                let expected = "three numbers x y z";
                return Err(LoadError::line(
                    Format::Xyz,
                    line.number,
                    expected,
                    &line.text,
                ));
            }
        }
    }
    Ok(raw)
}

fn fields(line: &str) -> Vec<&str> {
    if line.contains([',', ';']) {
        line.split([',', ';']).map(str::trim).collect()
    } else {
        line.split_whitespace().collect()
    }
}

fn point(line: &str, columns: [usize; 3]) -> Option<Point3<f64>> {
    let fields = fields(line);
    let coordinate = |axis: usize| match *fields.get(columns[axis])? {
        // A missing value: the row is dropped and counted.
        "" => Some(f64::NAN),
        field => number(field),
    };
    Some(Point3::new(coordinate(0)?, coordinate(1)?, coordinate(2)?))
}

/// Column names, or the number of points that some programs write first.
fn is_header(line: &str) -> bool {
    let fields = fields(line);
    let names = fields.len() >= 3 && fields.iter().all(|f| number(unquoted(f)).is_none());
    let count = fields.len() == 1 && fields[0].parse::<u64>().is_ok();
    names || count
}

fn named_columns(line: &str) -> Option<[usize; 3]> {
    let fields = fields(line);
    let column = |name: &str| {
        let is_it = |f: &&str| unquoted(f).eq_ignore_ascii_case(name);
        fields.iter().position(is_it)
    };
    Some([column("x")?, column("y")?, column("z")?])
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
    fn missing_values_are_not_finite() {
        let raw = read(b"1,,3\n4,5,6\n").unwrap();
        assert!(raw.vertices[0].y.is_nan());
    }
}
