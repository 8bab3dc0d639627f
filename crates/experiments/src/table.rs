//! Tables of results.

use std::fmt;

/// A table with notes below, for a terminal and for a page.
///
/// On a terminal the first column is aligned to the left, the others to the right.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Title, headers and rows.
    pub cells: report::Table,
    /// Lines of text below the table.
    pub notes: Vec<String>,
}

impl Table {
    /// A table without rows.
    pub fn new(title: impl Into<String>, headers: &[&str]) -> Self {
        Self {
            cells: report::Table {
                title: title.into(),
                headers: headers.iter().map(|&h| h.to_owned()).collect(),
                rows: Vec::new(),
            },
            notes: Vec::new(),
        }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl Into<Vec<String>>) {
        self.cells.rows.push(cells.into());
    }

    /// Adds a line below.
    pub fn note(&mut self, line: impl Into<String>) {
        self.notes.push(line.into());
    }

    /// The table and its notes as a section of a page.
    pub fn section(self) -> report::Section {
        report::Section {
            heading: "Numbers".to_owned(),
            text: String::new(),
            blocks: vec![
                report::Block::Table(self.cells),
                report::Block::Text(self.notes.join("\n\n")),
            ],
        }
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = || std::iter::once(&self.cells.headers).chain(&self.cells.rows);
        let columns = lines().map(Vec::len).max().unwrap_or(0);
        let width = |k: usize| {
            lines()
                .filter_map(|line| line.get(k))
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        writeln!(f, "{}", self.cells.title)?;
        for line in lines() {
            for (k, (cell, &width)) in line.iter().zip(&widths).enumerate() {
                match k {
                    0 => write!(f, "{cell:<width$}")?,
                    _ => write!(f, "  {cell:>width$}")?,
                }
            }
            writeln!(f)?;
        }
        for note in &self.notes {
            writeln!(f, "{note}")?;
        }
        Ok(())
    }
}

/// A number with a fixed number of decimals, or a dash.
pub fn number(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |v| format!("{v:.decimals$}"))
}

/// A length in millimetres, or a dash.
pub fn millimetres(metres: Option<f64>, decimals: usize) -> String {
    number(metres.map(|m| 1e3 * m), decimals)
}

/// A share in per cent, or a dash.
pub fn per_cent(share: Option<f64>) -> String {
    share.map_or_else(|| "–".to_owned(), |s| format!("{:.1} %", 100.0 * s))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let mut table = Table::new("Title", &["who", "Q"]);
        table.row(["a".into(), "1.25".into()]);
        table.row(["longer".into(), number(None, 2)]);
        table.note("Note");
        let expected = "Title\nwho        Q\na       1.25\nlonger     –\nNote\n";
        assert_eq!(table.to_string(), expected);
    }

    #[test]
    fn numbers_have_units() {
        assert_eq!(millimetres(Some(0.0123), 1), "12.3");
        assert_eq!(per_cent(Some(0.5)), "50.0 %");
    }
}
