//! The best hand grasps, the outcomes of the poses, and the distribution of quality.

use grasp::Convention;
use report::{BarSeries, Bars, Block, Histogram, Sample, SceneGrid, Section};

use super::findings::ObjectGrasps;
use crate::drawing::{grasp_cell, section};
use crate::paper;
use crate::pipeline::FittedSet;
use crate::table::{Table, number, per_cent};

pub(super) fn table(ours: &[ObjectGrasps], conventions: &[Convention]) -> Table {
    let poses = ours.first().map_or(0, |o| o.poses);
    let mut table = Table::new(
        format!(
            "Sec. IV-C: {poses} hand poses per surface; then the mean quality of the stable grasps under each convention"
        ),
        &[
            "object", "stable", "of 1400", "unstable", "rejected", "best", "10th", "50th",
        ],
    );
    table
        .cells
        .headers
        .extend(conventions.iter().map(|c| c.name.clone()));
    for o in ours {
        let ranked = |rank: usize| number(o.best_qualities.get(rank - 1).copied(), 3);
        let mut row = vec![
            o.id.clone(),
            o.stable.to_string(),
            number(Some(o.stable_of_1400), 0),
            o.unstable.to_string(),
            (o.poses - o.stable - o.unstable).to_string(),
            ranked(1),
            ranked(paper::VERY_BEST_GRASPS),
            ranked(paper::BEST_GRASPS),
        ];
        row.extend(
            o.conventions
                .iter()
                .map(|c| number(c.quality.map(|q| q.mean), 4)),
        );
        table.row(row);
    }
    let least = ours
        .iter()
        .map(|o| o.stable_of_1400)
        .fold(f64::INFINITY, f64::min);
    table.note(format!(
        "Stable grasps of 1400 poses: at least {least:.0} on every object; paper: more than {}",
        paper::STABLE_GRASPS_ABOVE
    ));
    for convention in conventions {
        table.note(rank_note(ours, &convention.name));
    }
    table
}

fn rank_note(ours: &[ObjectGrasps], name: &str) -> String {
    let of = |o: &ObjectGrasps| {
        let found = o.conventions.iter().find(|c| c.name == name)?;
        Some((found.rank_correlation?, found.share_closed?))
    };
    let found: Vec<(f64, f64)> = ours.iter().filter_map(of).collect();
    let mean = |pick: fn(&(f64, f64)) -> f64| {
        crate::statistics::mean(&found.iter().map(pick).collect::<Vec<_>>())
    };
    format!(
        "{name}: {} force-closed, rank correlation {}",
        per_cent(mean(|f| f.1)),
        number(mean(|f| f.0), 2)
    )
}

/// The best grasp of each object, outcomes and distributions of quality.
pub(super) fn figures(set: &FittedSet, found: &[ObjectGrasps]) -> Vec<Section> {
    let cells = set
        .objects
        .iter()
        .zip(found)
        .filter_map(|(o, grasps)| {
            let best = grasps.best_contacts.as_ref()?;
            let quality = grasps.best_qualities.first()?;
            Some(grasp_cell(
                format!("{} Q = {quality:.2}", o.id()),
                o.shape(),
                best,
            ))
        })
        .collect();
    let best = SceneGrid {
        title: "Best grasp on each surface".to_owned(),
        columns: 4,
        cells,
        ..SceneGrid::default()
    };
    let mut blocks = Vec::new();
    if !best.cells.is_empty() {
        blocks.push(Block::SceneGrid(best));
    }
    let mut numbers = vec![Block::Bars(outcomes(found))];
    if found.iter().any(|o| !o.best_qualities.is_empty()) {
        numbers.push(Block::Histogram(qualities(found)));
    }
    vec![
        section(
            "Grasps",
            "Contacts of the closed hand with their inward normals.",
            blocks,
        ),
        section("Outcomes", "", numbers),
    ]
}

fn outcomes(found: &[ObjectGrasps]) -> Bars {
    let series = |name: &str, pick: &dyn Fn(&ObjectGrasps) -> f64| BarSeries {
        name: name.to_owned(),
        values: found.iter().map(pick).collect(),
    };
    let mut all = vec![
        series("stable", &|o| o.stable as f64),
        series("unstable", &|o| o.unstable as f64),
    ];
    for reason in hand::Rejection::REASONS {
        let count = |o: &ObjectGrasps| {
            o.rejected
                .get(reason)
                .and_then(|n| n.as_f64())
                .unwrap_or(0.0)
        };
        all.push(series(&reason.replace('_', " "), &count));
    }
    Bars {
        title: "Outcomes of the poses".to_owned(),
        x_label: "object".to_owned(),
        y_label: "poses".to_owned(),
        categories: found.iter().map(|o| o.id.clone()).collect(),
        series: all,
    }
}

fn qualities(found: &[ObjectGrasps]) -> Histogram {
    Histogram {
        title: "Quality of the best grasps on all surfaces".to_owned(),
        x_label: "Q".to_owned(),
        bins: 30,
        samples: vec![Sample {
            name: String::new(),
            values: found
                .iter()
                .flat_map(|o| o.best_qualities.clone())
                .collect(),
        }],
    }
}
