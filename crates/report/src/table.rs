//! Tables of text.

use crate::check;
use crate::error::ReportError;
use crate::text;

/// A table; columns of numbers are aligned to the right.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Caption above the table; may be empty.
    pub title: String,
    /// One header per column.
    pub headers: Vec<String>,
    /// Rows, each with as many cells as there are headers.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn html(&self, place: &str) -> Result<String, ReportError> {
        check::not_empty(&format!("{place}: headers"), self.headers.len())?;
        let mut out = String::from("<div class=\"scroll\"><table>\n");
        if !self.title.is_empty() {
            out += &format!("<caption>{}</caption>\n", text::html(&self.title));
        }
        out += "<thead><tr>";
        for (column, header) in self.headers.iter().enumerate() {
            let class = self.class(column);
            out += &format!("<th scope=\"col\"{class}>{}</th>", text::html(header));
        }
        out += "</tr></thead>\n<tbody>\n";
        for (index, row) in self.rows.iter().enumerate() {
            let place = format!("{place}: row {index}");
            check::same_length(&place, self.headers.len(), row.len())?;
            out += "<tr>";
            for (column, cell) in row.iter().enumerate() {
                out += &format!("<td{}>{}</td>", self.class(column), text::html(cell));
            }
            out += "</tr>\n";
        }
        out += "</tbody></table></div>\n";
        Ok(out)
    }

    /// The class attribute of a column: numeric if every non-empty cell starts like a number.
    fn class(&self, column: usize) -> &'static str {
        let cells = self.rows.iter().filter_map(|row| row.get(column));
        let mut filled = cells.filter(|cell| !cell.is_empty()).peekable();
        let numeric = filled.peek().is_some() && filled.all(|cell| starts_like_a_number(cell));
        if numeric { " class=\"num\"" } else { "" }
    }
}

fn starts_like_a_number(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['-', '+', '−', '±', '<', '≤', '≥', '>', ' ']);
    digits.starts_with(|c: char| c.is_ascii_digit()) || matches!(cell, "–" | "-" | "—")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ragged_rows_are_refused() {
        let table = Table {
            title: String::new(),
            headers: vec!["a".into(), "b".into()],
            rows: vec![vec!["1".into()]],
        };
        assert!(matches!(
            table.html("t"),
            Err(ReportError::LengthMismatch {
                expected: 2,
                found: 1,
                ..
            })
        ));
    }

    #[test]
    fn numbers_are_set_flush_right_and_text_is_escaped() {
        let table = Table {
            title: "<t>".into(),
            headers: vec!["name".into(), "value".into()],
            rows: vec![
                vec!["<b>".into(), "-1.5".into()],
                vec!["c".into(), String::new()],
            ],
        };
        let html = table.html("t").unwrap();
        assert!(html.contains("<td class=\"num\">-1.5</td>"));
        assert!(html.contains("<td>&lt;b&gt;</td>"));
        assert!(html.contains("&lt;t&gt;"));
    }
}
