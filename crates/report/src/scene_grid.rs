//! Several small views side by side in one 3-D scene.

use plotly::Plot;
use plotly::common::Position;
use plotly::layout::Margin;

use crate::check;
use crate::error::ReportError;
use crate::glyph;
use crate::mesh::Extent;
use crate::scene::{decimals_for, legend_on_top};
use crate::scene_item::{ColourScale, Colours, Item};
use crate::text;
use crate::theme;
use crate::trace;
use crate::view::{View, ViewProjection};

/// Space between cells as a share of the largest cell.
const GAP: f64 = 0.18;

/// Objects in rows and columns, all to one scale, each with its label below.
///
/// All cells are in the xz-plane of one scene seen from the front (−y). So a page of fifty surfaces
/// needs one graphics context, and the whole grid is rotated at once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneGrid {
    /// Caption above the figure.
    pub title: String,
    /// Cells per row; at least 1.
    pub columns: usize,
    /// Cells, row by row from the top left; a cell without items is blank.
    pub cells: Vec<SceneCell>,
    /// Colour map of surface values, the same for all cells.
    pub colour_scale: ColourScale,
    /// Title of the colour bar.
    pub value_label: String,
}

/// One cell of a grid.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneCell {
    /// Text below the cell; may be empty.
    pub label: String,
    /// What the cell shows, in its own coordinates; the grid centres it.
    pub items: Vec<Item>,
}

impl SceneCell {
    fn extent(&self) -> Extent {
        let mut extent = Extent::EMPTY;
        for reach in self.items.iter().map(Item::extent) {
            if !reach.is_empty() {
                extent.grow(&[reach.low, reach.high]);
            }
        }
        extent
    }
}

/// Layout of the cells of a grid.
struct Lattice {
    columns: usize,
    /// Largest cell: width, depth, height.
    cell: [f64; 3],
    /// Space between neighbours.
    gap: f64,
}

impl Lattice {
    fn of(grid: &SceneGrid, extents: &[Extent]) -> Lattice {
        let mut cell = [0.0f64; 3];
        for extent in extents.iter().filter(|e| !e.is_empty()) {
            let size = extent.size();
            cell = std::array::from_fn(|i| cell[i].max(size[i]));
        }
        let longest = cell.into_iter().fold(1e-9, f64::max);
        Lattice {
            columns: grid.columns.max(1),
            // A minimum size, so that labels and view do not collapse for flat cells.
            cell: cell.map(|v| v.max(0.2 * longest)),
            gap: GAP * longest,
        }
    }

    /// Centre of the `k`-th cell.
    fn centre(&self, k: usize) -> [f64; 3] {
        let (row, column) = (k / self.columns, k % self.columns);
        [
            column as f64 * (self.cell[0] + self.gap),
            0.0,
            // Space for the labels below each row.
            -(row as f64) * (self.cell[2] + 1.6 * self.gap),
        ]
    }

    /// Position of the label of the `k`-th cell.
    fn label(&self, k: usize) -> [f64; 3] {
        let mut position = self.centre(k);
        position[2] -= 0.5 * self.cell[2] + 0.6 * self.gap;
        position
    }

    /// The box of the first `count` cells with their labels.
    fn bounds(&self, count: usize) -> Extent {
        let half = self.cell.map(|v| 0.5 * v);
        let mut bounds = Extent::EMPTY;
        for k in 0..count {
            let centre = self.centre(k);
            bounds.grow(&[glyph::add(centre, half), glyph::subtract(centre, half)]);
            bounds.grow(&[self.label(k)]);
        }
        bounds.padded(0.5 * self.gap)
    }
}

impl SceneGrid {
    pub(crate) fn plot(&self, place: &str) -> Result<Plot, ReportError> {
        check::not_empty(&format!("{place}: cells"), self.cells.len())?;
        check::not_empty(&format!("{place}: columns"), self.columns)?;
        for (k, cell) in self.cells.iter().enumerate() {
            for (index, item) in cell.items.iter().enumerate() {
                item.check(&format!("{place}: cell {k}: item {index}"))?;
            }
        }
        let extents: Vec<Extent> = self.cells.iter().map(SceneCell::extent).collect();
        let lattice = Lattice::of(self, &extents);
        let bounds = lattice.bounds(self.cells.len());
        let view = View {
            bounds,
            subject: bounds,
            axes: None,
            projection: ViewProjection::Front {
                shape: shape_of(&bounds),
            },
        };
        let mut plot = Plot::new();
        plot.set_layout(
            theme::layout()
                .scene(view.scene())
                .margin(Margin::new().left(0).right(0).top(0).bottom(0))
                .legend(legend_on_top()),
        );
        plot.set_configuration(theme::configuration_3d());
        self.add_traces(
            &mut plot,
            &lattice,
            &extents,
            decimals_for(bounds.longest()),
        );
        Ok(plot)
    }

    fn add_traces(&self, plot: &mut Plot, lattice: &Lattice, extents: &[Extent], places: i32) {
        let all = self.cells.iter().flat_map(|cell| &cell.items);
        let colours = Colours::of(self.colour_scale, &self.value_label, all);
        let mut colour_bar = true;
        for (k, (cell, extent)) in self.cells.iter().zip(extents).enumerate() {
            if extent.is_empty() {
                continue;
            }
            let offset = glyph::subtract(lattice.centre(k), extent.centre());
            let mut series = 0;
            for item in &cell.items {
                plot.add_traces(item.traces(series, offset, places, &colours, colour_bar));
                series += usize::from(item.takes_series_colour());
                colour_bar &= !matches!(item, Item::Surface(s) if !s.values.is_empty());
            }
        }
        let positions: Vec<[f64; 3]> = (0..self.cells.len()).map(|k| lattice.label(k)).collect();
        let labels = self.cells.iter().map(|cell| text::plot(&cell.label));
        plot.add_trace(
            trace::text(&positions, labels.collect()).text_position(Position::MiddleCenter),
        );
    }

    /// Height over width of the whole grid, which is the aspect ratio of its figure.
    pub(crate) fn shape(&self) -> f64 {
        let extents: Vec<Extent> = self.cells.iter().map(SceneCell::extent).collect();
        shape_of(&Lattice::of(self, &extents).bounds(self.cells.len()))
    }
}

/// Height over width of the projection of a grid.
fn shape_of(bounds: &Extent) -> f64 {
    let size = bounds.size();
    (size[2] / size[0]).clamp(0.2, 1.4)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_item::Points;

    #[test]
    fn cells_do_not_overlap() {
        let cell = SceneCell {
            label: "a".into(),
            items: vec![Item::Points(Points {
                points: vec![[5.0, 5.0, 5.0], [7.0, 6.0, 8.0]],
                size_px: 3,
                ..Points::default()
            })],
        };
        let grid = SceneGrid {
            columns: 2,
            cells: vec![cell.clone(), cell.clone(), cell],
            ..SceneGrid::default()
        };
        let extents: Vec<Extent> = grid.cells.iter().map(SceneCell::extent).collect();
        let lattice = Lattice::of(&grid, &extents);
        assert!(lattice.centre(1)[0] - lattice.centre(0)[0] >= 2.0);
        assert!(lattice.centre(0)[2] - lattice.centre(2)[2] >= 3.0);
        assert!(lattice.label(0)[2] < lattice.centre(0)[2] - 1.5);
        assert!(grid.plot("grid").is_ok());
    }

    #[test]
    fn a_grid_without_columns_is_refused() {
        let grid = SceneGrid {
            cells: vec![SceneCell::default()],
            ..SceneGrid::default()
        };
        assert!(grid.plot("grid").is_err());
    }
}
