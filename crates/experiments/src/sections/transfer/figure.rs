//! Fig. 9: quality before and after transfers, and the stations of one transfer.

use report::{Axis, BarSeries, Bars, Block, Chart, SceneCell, SceneGrid, Section, Series};
use shape::RadialShape;
use sph::Direction;

use super::findings::{Carried, Count, DrawnTransfer, Settings};
use crate::drawing::{grasp_cell, section};
use crate::ledger::ThreadSeconds;
use crate::paper;
use crate::table::{Table, number};

pub(super) fn table(settings: &Settings, counts: &[Count], times: &ThreadSeconds) -> Table {
    let mut table = Table::new(
        format!(
            "Sec. IV-E: {} stations of {} steps, the best {} grasps of {} poses (paper: {}, {}, {}, {})",
            settings.transfer.intervals + 1,
            settings.transfer.ascent.steps,
            settings.grasps,
            settings.poses,
            paper::TRANSFER_STATIONS,
            paper::TRANSFER_STEPS,
            paper::VERY_BEST_GRASPS,
            paper::HAND_POSES
        ),
        &[
            "from",
            "transfers",
            "unstable",
            "in the paper",
            "naive unstable",
            "initial",
            "final",
            "naive",
            "ours Q < 0.01",
            "ours",
            "evaluations",
        ],
    );
    for c in counts {
        let of = if c.from == "all" {
            paper::TRANSFERS
        } else {
            paper::TRANSFERS_PER_SOURCE
        };
        let in_paper = c
            .unstable_in_paper
            .map_or("–".to_owned(), |n| format!("{n} of {of}"));
        table.row([
            c.from.clone(),
            c.transfers.to_string(),
            c.unstable.to_string(),
            in_paper,
            c.unstable_naive.to_string(),
            number(c.mean_initial, 3),
            number(c.mean_final, 3),
            number(c.mean_naive, 3),
            c.unstable_ours.to_string(),
            number(c.mean_ours, 3),
            number(c.evaluations_ratio, 1),
        ]);
    }
    table.note(format!(
        "Seconds of all transfers, summed over threads: {:.1}, ours {:.1}",
        times.paper, times.ours
    ));
    table.note("evaluations: qualities that the paper's transfer computes for one of ours");
    table.note(format!(
        "The paper transferred {} grasps, {} of which ended unstable",
        paper::TRANSFERS,
        paper::UNSTABLE_TRANSFERS
    ));
    table
}

/// Quality before and after, unstable transfers by source, and one transfer.
pub(super) fn figures(
    carried: &[Carried],
    counts: &[Count],
    drawn: Option<&DrawnTransfer>,
) -> Vec<Section> {
    let sources = counts.iter().filter(|c| c.from != "all");
    let chart = |title: &str, pick: fn(&Carried) -> f64| {
        let series = |c: &Count| {
            let of = carried.iter().filter(|t| t.from == c.from);
            Series::points(
                format!("from {}", c.from),
                of.map(|t| [t.paper.initial, pick(t)]).collect(),
            )
        };
        Block::Chart(Chart {
            title: title.to_owned(),
            x: Axis::linear("Q on the source"),
            y: Axis::linear("Q on the target"),
            series: sources
                .clone()
                .map(series)
                .filter(|s| !s.points.is_empty())
                .collect(),
            diagonal: true,
            equal_scale: true,
        })
    };
    let quality = vec![
        chart("The paper's transfer", |t| t.paper.last),
        chart("Our transfer", |t| t.ours.last),
        chart("The naive transfer: θ and φ kept", |t| t.paper.naive),
        Block::Bars(unstable(&sources.clone().collect::<Vec<_>>())),
    ];
    let way = drawn.map(|d| Block::SceneGrid(grid(d)));
    vec![
        section("Quality", "", quality),
        section("One transfer", "", way.into_iter().collect()),
    ]
}

fn unstable(sources: &[&Count]) -> Bars {
    let series = |name: &str, pick: fn(&Count) -> (usize, usize)| BarSeries {
        name: name.to_owned(),
        values: sources
            .iter()
            .map(|c| pick(c))
            .map(|(part, whole)| 100.0 * part as f64 / whole.max(1) as f64)
            .collect(),
    };
    Bars {
        title: "Transfers that end unstable".to_owned(),
        x_label: "source".to_owned(),
        y_label: "unstable / %".to_owned(),
        categories: sources.iter().map(|c| c.from.clone()).collect(),
        series: vec![
            series("the paper's transfer, here", |c| (c.unstable, c.transfers)),
            series("the naive transfer, here", |c| {
                (c.unstable_naive, c.transfers)
            }),
            series("the paper", |c| {
                (
                    c.unstable_in_paper.unwrap_or(0),
                    paper::TRANSFERS_PER_SOURCE,
                )
            }),
        ],
    }
}

fn grid(drawn: &DrawnTransfer) -> SceneGrid {
    let last = drawn.stations.len().saturating_sub(1).max(1) as f64;
    let cell = |(k, (shape, contacts, quality)): (usize, &(RadialShape, Vec<Direction>, f64))| -> SceneCell {
        let t = k as f64 / last;
        grasp_cell(format!("t = {t:.1}, Q = {quality:.2}"), shape, contacts)
    };
    SceneGrid {
        title: drawn.title.clone(),
        columns: 4,
        cells: drawn.stations.iter().enumerate().map(cell).collect(),
        ..SceneGrid::default()
    }
}
