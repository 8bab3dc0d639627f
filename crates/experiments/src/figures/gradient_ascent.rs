//! Fig. 7 and Fig. 8: quality before and after, and the ways of contacts.

use report::{Axis, Block, Chart, SceneCell, SceneGrid, Section, Series};
use shape::RadialShape;
use sph::Direction;

use super::section;
use super::surfaces::{contacts, surface, track};
use crate::sections::gradient_ascent::ObjectClimbs;

/// One ascent as it is to be drawn.
pub struct DrawnClimb<'a> {
    /// The object and the change of quality.
    pub label: String,
    /// The surface.
    pub shape: &'a RadialShape,
    /// The contacts at every state.
    pub states: Vec<Vec<Direction>>,
}

/// Quality before and after, and some ascents.
pub fn figures(found: &[ObjectClimbs], drawn: &[DrawnClimb]) -> Vec<Section> {
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
            "Arrows press where the contacts end; lines show the way that they came.",
            vec![Block::SceneGrid(grid)],
        ),
    ]
}

fn cell(climb: &DrawnClimb) -> SceneCell {
    let mut items = vec![surface(climb.shape)];
    if let Some(last) = climb.states.last() {
        items.push(contacts(climb.shape, last));
        for finger in 0..last.len() {
            let way = climb.states.iter().map(|state| state[finger]);
            items.push(track(climb.shape, way));
        }
    }
    SceneCell {
        label: climb.label.clone(),
        items,
    }
}
