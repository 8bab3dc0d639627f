//! Fig. 7 and Fig. 8: quality before and after, and the paths of contacts.

use report::{Axis, Block, Chart, SceneCell, SceneGrid, Section, Series};

use super::findings::{Climb, DrawnClimb, ObjectClimbs, Overall, Settings, examples, overall};
use crate::drawing::{contacts, section, surface, track};
use crate::ledger::ThreadSeconds;
use crate::paper;
use crate::statistics::summary;
use crate::table::{Table, number, per_cent};

pub(super) fn table(
    settings: &Settings,
    ours: &[ObjectClimbs],
    overall: &Overall,
    times: &ThreadSeconds,
) -> Table {
    let mut table = Table::new(
        format!(
            "Sec. IV-D: {} steps of the paper's ascent from the best {} grasps of {} poses (paper: {}, {}, {})",
            settings.ascent.steps,
            settings.grasps,
            settings.poses,
            paper::ASCENT_STEPS,
            paper::BEST_GRASPS,
            paper::HAND_POSES
        ),
        &[
            "object",
            "ascents",
            "improved",
            "worse",
            "initial",
            "final",
            "best final",
            "ours",
            "ours worse",
        ],
    );
    for o in ours {
        let of = self::overall(&o.climbs);
        let ends: Vec<f64> = o.climbs.iter().map(|c| c.paper.last).collect();
        table.row([
            o.id.clone(),
            of.climbs.to_string(),
            per_cent(of.share_improved),
            per_cent(of.share_worsened),
            number(of.mean_initial, 3),
            number(of.mean_final, 3),
            number(summary(&ends).map(|s| s.greatest), 3),
            number(of.ours_mean_final, 3),
            of.ours_below_start.to_string(),
        ]);
    }
    table.row([
        "all".into(),
        overall.climbs.to_string(),
        per_cent(overall.share_improved),
        per_cent(overall.share_worsened),
        number(overall.mean_initial, 3),
        number(overall.mean_final, 3),
        String::new(),
        number(overall.ours_mean_final, 3),
        overall.ours_below_start.to_string(),
    ]);
    let pairs = |list: &[(f64, f64)]| {
        let text: Vec<String> = list.iter().map(|(a, b)| format!("{a:.2}→{b:.2}")).collect();
        text.join(", ")
    };
    let all: Vec<Climb> = ours.iter().flat_map(|o| o.climbs.iter().cloned()).collect();
    table.note(format!(
        "Ours from the same starts: {} improved, none of its steps down; the paper's computes {} times as many qualities",
        per_cent(overall.ours_share_improved),
        number(overall.evaluations_ratio, 1)
    ));
    table.note(format!(
        "Seconds of all ascents, summed over threads: {:.1}, ours {:.1}",
        times.paper, times.ours
    ));
    table.note(format!(
        "Largest improvements {}; examples of the paper {}",
        pairs(&examples(&all)),
        pairs(&paper::ASCENT_EXAMPLES)
    ));
    table
}

/// Quality before and after, and some ascents.
pub(super) fn figures(found: &[ObjectClimbs], drawn: &[DrawnClimb]) -> Vec<Section> {
    let series = found
        .iter()
        .filter(|o| !o.climbs.is_empty())
        .map(|o| {
            let points = o
                .climbs
                .iter()
                .map(|c| [c.paper.initial, c.paper.last])
                .collect();
            Series::points(o.id.clone(), points)
        })
        .collect();
    let chart = Chart {
        title: "Initial against final quality".to_owned(),
        x: Axis::linear("initial Q"),
        y: Axis::linear("final Q"),
        series,
        diagonal: true,
        equal_scale: true,
    };
    let grid = SceneGrid {
        title: "Ascents".to_owned(),
        columns: drawn.len().clamp(1, 4),
        cells: drawn.iter().map(cell).collect(),
        ..SceneGrid::default()
    };
    vec![
        section("Quality", "", vec![Block::Chart(chart)]),
        section(
            "Contacts",
            "Arrows show the contacts at the end; lines show their paths.",
            vec![Block::SceneGrid(grid)],
        ),
    ]
}

fn cell(climb: &DrawnClimb) -> SceneCell {
    let mut items = vec![surface(&climb.shape)];
    if let Some(last) = climb.states.last() {
        items.push(contacts(&climb.shape, last));
        for finger in 0..last.len() {
            let way = climb.states.iter().map(|state| state[finger]);
            items.push(track(&climb.shape, way));
        }
    }
    SceneCell {
        label: climb.label.clone(),
        items,
    }
}
