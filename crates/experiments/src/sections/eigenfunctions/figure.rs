//! Fig. 1: eigenfunctions on the sphere, and their errors.

use report::{Axis, Block, Chart, ColourScale, SceneCell, SceneGrid, Section, Series};
use shape::{RadialError, RadialShape};
use sph::{Coefficients, index};

use super::findings::Eigenfunctions;
use crate::drawing::{coloured, section};
use crate::table::Table;

/// Highest degree of the functions that are drawn.
const DRAWN_DEGREE: usize = 3;

/// The first eigenfunctions, and the errors by degree.
pub(super) fn figures(found: &Eigenfunctions) -> Result<Vec<Section>, RadialError> {
    let errors = found
        .laplacian_error_by_degree
        .iter()
        .enumerate()
        .filter(|(_, error)| **error > 0.0)
        .map(|(l, &error)| [l as f64, error])
        .collect();
    let chart = Chart {
        title: "Error of ΔY = −l(l+1) Y".to_owned(),
        x: Axis::linear("degree l"),
        y: Axis::log("largest error, relative"),
        series: vec![Series::line("", errors)],
        diagonal: false,
        equal_scale: false,
    };
    let grid = Block::SceneGrid(grid()?);
    Ok(vec![
        section(
            "Eigenfunctions",
            "Y_lm on the sphere, l from top to bottom.",
            vec![grid],
        ),
        section("Errors", "", vec![Block::Chart(chart)]),
    ])
}

fn grid() -> Result<SceneGrid, RadialError> {
    let sphere = RadialShape::sphere(0, 0.01)?;
    let reach = DRAWN_DEGREE as isize;
    let mut cells = Vec::new();
    for l in 0..=DRAWN_DEGREE {
        for m in -reach..=reach {
            let mut cell = SceneCell::default();
            if m.unsigned_abs() <= l {
                let mut function = Coefficients::zeros(DRAWN_DEGREE);
                function.as_mut_slice()[index::position(l, m)] = 1.0;
                cell.label = format!("l = {l}, m = {m}");
                cell.items.push(coloured(&sphere, &function));
            }
            cells.push(cell);
        }
    }
    Ok(SceneGrid {
        title: "Real spherical harmonics".to_owned(),
        columns: 2 * DRAWN_DEGREE + 1,
        cells,
        colour_scale: ColourScale::Diverging,
        value_label: "Y".to_owned(),
    })
}

/// The largest errors.
pub(super) fn table(ours: &Eigenfunctions) -> Table {
    let mut table = Table::new(
        format!(
            "Fig. 1: {} eigenfunctions Y_lm, l up to {}",
            ours.functions, ours.degree
        ),
        &["largest error", "here", "paper"],
    );
    let mut row = |what: &str, value: f64, paper: &str| {
        table.row([what.into(), format!("{value:.1e}"), paper.into()]);
    };
    row("orthonormality", ours.orthonormality_error, "0");
    row("against the formula of Sec. II-C", ours.formula_error, "0");
    row("ΔY = -l(l+1) Y, Hessian", ours.laplacian_error, "0");
    row(
        "ΔY = -l(l+1) Y, differences",
        ours.difference_laplacian_error,
        "0",
    );
    table.note("The paper prints ΔY = +l(l+1) Y; with its own Laplacian the sign is minus.");
    table
}
