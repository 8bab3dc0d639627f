//! Fig. 5: random shapes with random contacts.

use report::{Block, SceneGrid, Section};

use super::findings::{DrawnBand, Noise};
use crate::drawing::{grasp_cell, section};
use crate::table::{Table, millimetres, number, per_cent};

pub(super) fn table(noise: &[Noise]) -> Table {
    let mut table = Table::new(
        "Sec. IV-B: noise on β_0…β_9 (coarse) and β_499…β_599 (fine)",
        &[
            "band",
            "σ mm",
            "samples",
            "in M^rad",
            "rms change mm",
            "waves",
            "rms slope",
            "force-closed",
        ],
    );
    for n in noise {
        table.row([
            n.band.into(),
            millimetres(Some(n.sigma_m), 1),
            n.samples.to_string(),
            per_cent(n.share_in_m_rad),
            millimetres(n.rms_radius_change_m, 2),
            number(n.roughness, 1),
            number(n.rms_slope_change, 3),
            per_cent(n.share_force_closed),
        ]);
    }
    table.note("The paper shows pictures, states no deviation and no numbers here.");
    table
}

/// A row of samples for every band.
pub(super) fn figures(bands: &[DrawnBand]) -> Vec<Section> {
    let grid = |band: &DrawnBand| {
        Block::SceneGrid(SceneGrid {
            title: band.title.clone(),
            columns: band.samples.len().max(1),
            cells: band
                .samples
                .iter()
                .map(|s| grasp_cell(String::new(), &s.surface, &s.directions))
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
