//! Pages of headings, text, figures and tables.

use crate::bars::{Bars, Histogram};
use crate::chart::Chart;
use crate::document::{Scripts, document};
use crate::error::ReportError;
use crate::packed::{self, figure_value};
use crate::scene::Scene;
use crate::scene_grid::SceneGrid;
use crate::table::Table;
use crate::text;

const SCRIPT: &str = include_str!("assets/figures.js");

/// A page: title, introduction, sections.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// Title of the page.
    pub title: String,
    /// Introduction; blank lines separate paragraphs.
    pub intro: String,
    /// The sections from top to bottom.
    pub sections: Vec<Section>,
}

/// A section of a page.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// Heading.
    pub heading: String,
    /// Text before the blocks; blank lines separate paragraphs.
    pub text: String,
    /// Figures and tables from top to bottom.
    pub blocks: Vec<Block>,
}

/// A figure, a table, or text between them.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A 2-D plot.
    Chart(Chart),
    /// Bars by category.
    Bars(Bars),
    /// A histogram.
    Histogram(Histogram),
    /// A 3-D view.
    Scene(Scene),
    /// A grid of objects.
    SceneGrid(SceneGrid),
    /// A table.
    Table(Table),
    /// Paragraphs, separated by blank lines.
    Text(String),
}

/// How the style sheet and the script treat a figure.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// A plane figure, drawn at once.
    Plane,
    /// A 3-D figure, drawn when it is in view, since browsers grant only about sixteen graphics
    /// contexts.
    Scene,
    /// A 3-D figure whose view has a fixed aspect ratio.
    Grid,
}

impl Page {
    /// The whole page as self-contained HTML. plotly.js (1.9 MB, compressed) is embedded once if
    /// there is a figure.
    ///
    /// Text is escaped. Cost is linear in the data.
    ///
    /// # Errors
    /// [`ReportError`] names section, block and entry of the first number that is not
    /// finite, not positive on a logarithmic axis, or of lists that do not match.
    pub fn to_html(&self) -> Result<String, ReportError> {
        let mut figures = Vec::new();
        let mut body = String::from("<main class=\"page\">\n<header>\n");
        body += &format!("<h1>{}</h1>\n", text::html(&self.title));
        body += &text::paragraphs(&self.intro);
        body += "</header>\n";
        for (s, section) in self.sections.iter().enumerate() {
            body += "<section>\n";
            if !section.heading.is_empty() {
                body += &format!("<h2>{}</h2>\n", text::html(&section.heading));
            }
            body += &text::paragraphs(&section.text);
            for (b, block) in section.blocks.iter().enumerate() {
                let place = format!("section {s} ({}): block {b}", section.heading);
                body += &block_html(block, &place, &mut figures)?;
            }
            body += "</section>\n";
        }
        body += "</main>\n";
        let scripts = (!figures.is_empty()).then_some(Scripts {
            data: figures,
            code: SCRIPT,
        });
        Ok(document(&self.title, &body, scripts))
    }
}

/// The HTML of a block; the data of a figure is appended to `figures`.
fn block_html(
    block: &Block,
    place: &str,
    figures: &mut Vec<(String, String)>,
) -> Result<String, ReportError> {
    let (title, plot, shape, kind) = match block {
        Block::Text(text) => return Ok(text::paragraphs(text)),
        Block::Table(table) => return table.html(place),
        Block::Chart(chart) => {
            let shape = if chart.equal_scale { 0.8 } else { 0.55 };
            (&chart.title, chart.plot(place)?, shape, Kind::Plane)
        }
        Block::Bars(bars) => (&bars.title, bars.plot(place)?, 0.5, Kind::Plane),
        Block::Histogram(counts) => (&counts.title, counts.plot(place)?, 0.5, Kind::Plane),
        Block::Scene(scene) => (&scene.title, scene.plot(place)?, 0.7, Kind::Scene),
        Block::SceneGrid(grid) => (&grid.title, grid.plot(place)?, grid.shape(), Kind::Grid),
    };
    let id = format!("figure-{}", figures.len());
    let mut figure = figure_value(&plot.to_json());
    packed::set_light(&mut figure, kind == Kind::Grid);
    figures.push((format!("{id}-data"), figure.to_string()));
    Ok(figure_html(&id, title, shape, kind))
}

/// The container of a figure; `shape` is height over width.
fn figure_html(id: &str, title: &str, shape: f64, kind: Kind) -> String {
    let caption = if title.is_empty() {
        String::new()
    } else {
        format!("<figcaption>{}</figcaption>", text::html(title))
    };
    let class = match kind {
        Kind::Plane => "plot",
        Kind::Scene => "plot three-d",
        Kind::Grid => "plot three-d grid",
    };
    format!(
        "<figure>{caption}<div class=\"{class}\" id=\"{id}\" \
         style=\"aspect-ratio: {:.3}\"></div></figure>\n",
        1.0 / shape
    )
}
