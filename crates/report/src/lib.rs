//! Figures and pages: plain data in, one self-contained HTML page out.
//!
//! Two functions return a whole page as a `String`; the caller writes it:
//!
//! - [`grasp_page`]: the ranked grasps of one object, in a rotatable view.
//! - [`Page::to_html`]: headings, text, tables, and figures ([`Chart`], [`Bars`], [`Histogram`],
//!   [`Scene`], [`SceneGrid`]) for the experiments.
//!
//! A page contains plotly.js and has a content policy under which a browser fetches nothing, so it
//! opens without a network. All text given by the caller is plain text: it is escaped for HTML, for
//! JSON and for the markup of plotly.js. Numbers must be finite; otherwise the result is a
//! [`ReportError`] that names the place. The same input gives the same bytes.
//!
//! This crate displays given numbers. It computes no shapes, hands or qualities.
//!
//! ```
//! use report::{GraspPage, Mesh, grasp_page};
//!
//! let page = GraspPage {
//!     title: "tetrahedron".to_owned(),
//!     mesh: Mesh {
//!         vertices: vec![[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1], [-0.1, -0.1, -0.1]],
//!         triangles: vec![[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]],
//!     },
//!     ..GraspPage::default()
//! };
//! let html = grasp_page(&page)?;
//! assert!(html.starts_with("<!DOCTYPE html>") && html.len() < 2_000_000);
//! # Ok::<(), report::ReportError>(())
//! ```

mod bars;
mod chart;
mod check;
mod document;
mod error;
mod glyph;
mod grasp_page;
mod grasp_view;
mod mesh;
mod packed;
mod page;
mod page_grasp;
mod rounding;
mod scene;
mod scene_grid;
mod scene_item;
mod table;
mod text;
mod theme;
mod trace;
mod view;

pub use bars::{BarSeries, Bars, Histogram, Sample};
pub use chart::{Axis, AxisScale, Chart, Mark, Series};
pub use error::ReportError;
pub use grasp_page::grasp_page;
pub use mesh::Mesh;
pub use page::{Block, Page, Section};
pub use page_grasp::{GraspPage, PageGrasp, WeakestWrench};
pub use scene::Scene;
pub use scene_grid::{SceneCell, SceneGrid};
pub use scene_item::{Arrows, ColourScale, Item, Lines, Part, Points, Surface};
pub use table::Table;
