//! Sec. IV-C: the best hand grasps, what became of the poses, qualities.

use report::{BarSeries, Bars, Block, Histogram, Sample, SceneGrid, Section};

use super::section;
use super::surfaces::grasp_cell;
use crate::pipeline::FittedSet;
use crate::sections::initial_grasps::ObjectGrasps;

/// The best grasp of each object, outcomes and qualities.
pub fn figures(set: &FittedSet, found: &[ObjectGrasps]) -> Vec<Section> {
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
        title: "What became of the poses".to_owned(),
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
