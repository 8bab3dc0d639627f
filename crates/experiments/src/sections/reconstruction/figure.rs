//! Fig. 2: a cloud and its surfaces, and the errors against L.

use report::{Axis, Block, Chart, SceneCell, SceneGrid, Section, Series};

use super::findings::{Fitted, Reconstruction};
use crate::drawing::{cloud, section, surface};
use crate::objects::{ObjectCloud, Objects};
use crate::paper;
use crate::table::{Table, millimetres};

pub(super) fn table(objects: &Objects, fits: &[&Reconstruction]) -> Table {
    let mut table = Table::new(
        "Fig. 2: error against L, in mm: plain least squares (as the paper) | with the penalty",
        &[
            "object",
            "L",
            "rms",
            "held out",
            "from truth",
            "M^rad",
            "rms",
            "held out",
            "from truth",
            "M^rad",
        ],
    );
    for object in &objects.clouds {
        let mut degrees: Vec<usize> = fits.iter().map(|f| f.degree).collect();
        degrees.sort_unstable();
        degrees.dedup();
        for degree in degrees {
            let of = |penalised| {
                let fit = fits
                    .iter()
                    .find(|f| f.id == object.id && f.degree == degree && f.penalised == penalised);
                cells(fit.copied())
            };
            let head = vec![object.id.clone(), degree.to_string()];
            table.row([head, of(false), of(true)].concat());
        }
    }
    table.note("The paper shows pictures and no numbers here.");
    table
}

fn cells(fit: Option<&Reconstruction>) -> Vec<String> {
    let yes_no = fit.map_or("–", |f| if f.in_m_rad { "yes" } else { "no" });
    vec![
        millimetres(fit.map(|f| f.rms_m), 3),
        millimetres(fit.and_then(|f| f.held_out_rms_m), 3),
        millimetres(fit.and_then(|f| f.true_rms_m), 3),
        yes_no.to_owned(),
    ]
}

/// Errors of every object, and the surfaces of S8 (or of the last object).
pub(super) fn figures(objects: &[ObjectCloud], fits: &[Fitted]) -> Vec<Section> {
    let charts = objects
        .iter()
        .map(|object| Block::Chart(chart(object, fits)))
        .collect();
    let drawn = objects
        .iter()
        .find(|o| o.number == paper::CLOUD_OBJECT)
        .or(objects.last());
    let grids = drawn.map(|object| Block::SceneGrid(grid(object, fits)));
    vec![
        section(
            "Surfaces",
            "The cloud, thinned, and the surfaces of plain least squares up to degree L.",
            grids.into_iter().collect(),
        ),
        section("Errors", "Root mean squares, in millimetres.", charts),
    ]
}

fn grid(object: &ObjectCloud, fits: &[Fitted]) -> SceneGrid {
    let mut cells = vec![SceneCell {
        label: format!("{} points", object.cloud.points().len()),
        items: vec![cloud(&object.cloud, &object.cloud.mean())],
    }];
    for Fitted { record, shape } in fits {
        if let Some(shape) = shape
            && record.id == object.id
            && !record.penalised
        {
            cells.push(SceneCell {
                label: format!("L = {}", record.degree),
                items: vec![surface(shape)],
            });
        }
    }
    SceneGrid {
        title: format!("{}: {}", object.id, object.name),
        columns: cells.len().min(4),
        cells,
        ..SceneGrid::default()
    }
}

fn chart(object: &ObjectCloud, fits: &[Fitted]) -> Chart {
    let series = |name: &str, penalised: bool, pick: fn(&Reconstruction) -> Option<f64>| {
        let points = fits
            .iter()
            .map(|fit| &fit.record)
            .filter(|r| r.id == object.id && r.penalised == penalised)
            .filter_map(|r| Some([r.degree as f64, 1e3 * pick(r)?]))
            .filter(|point| point[1] > 0.0)
            .collect();
        Series::line(name, points)
    };
    let mut all = vec![
        series("plain, at the points", false, |r| Some(r.rms_m)),
        series("plain, held out", false, |r| r.held_out_rms_m),
        series("penalised, at the points", true, |r| Some(r.rms_m)),
        series("penalised, held out", true, |r| r.held_out_rms_m),
    ];
    if object.truth.is_some() {
        all.push(series("plain, from the true surface", false, |r| {
            r.true_rms_m
        }));
        all.push(series("penalised, from the true surface", true, |r| {
            r.true_rms_m
        }));
    }
    all.retain(|s| !s.points.is_empty());
    Chart {
        title: format!("{}: {}", object.id, object.name),
        x: Axis::linear("L"),
        y: Axis::log("error / mm"),
        series: all,
        diagonal: false,
        equal_scale: false,
    }
}
