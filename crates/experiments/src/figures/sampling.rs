//! Fig. 5: random shapes with random contacts.

use report::{Block, SceneGrid, Section};
use shape::RadialShape;
use space::ModuliPoint;

use super::section;
use super::surfaces::grasp_cell;

/// Samples of one band, as they are to be drawn.
pub struct DrawnBand {
    /// Which coefficients, and the deviation.
    pub title: String,
    /// The samples.
    pub samples: Vec<ModuliPoint<RadialShape>>,
}

/// A row of samples for every band.
pub fn figures(bands: &[DrawnBand]) -> Vec<Section> {
    let grid = |band: &DrawnBand| {
        Block::SceneGrid(SceneGrid {
            title: band.title.clone(),
            columns: band.samples.len().max(1),
            cells: band
                .samples
                .iter()
                .map(|s| grasp_cell(String::new(), &s.surface, &s.contacts))
                .collect(),
            ..SceneGrid::default()
        })
    };
    let drawn = bands.iter().filter(|band| !band.samples.is_empty());
    vec![section(
        "Samples",
        "Three random contacts with their inward normals on randomly changed surfaces.",
        drawn.map(grid).collect(),
    )]
}
