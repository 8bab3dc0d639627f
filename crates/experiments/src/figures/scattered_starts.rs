//! The best of many runs against our transfer.

use report::{Axis, Block, Chart, Section, Series};

use super::section;
use crate::sections::scattered_starts::Compared;

/// One point a transfer; what lies above the diagonal is won by ours.
pub fn figures(compared: &[Compared]) -> Vec<Section> {
    let series = |name: &str, pick: fn(&Compared) -> f64| {
        let points = compared.iter().map(|c| [c.runs.best(), pick(c)]).collect();
        Series::points(name.to_owned(), points)
    };
    let chart = Chart {
        title: "Q on the target".to_owned(),
        x: Axis::linear("best run of the paper's ascent"),
        y: Axis::linear("ours"),
        series: vec![
            series("thorough", |c| c.thorough),
            series("default", |c| c.ours),
        ],
        diagonal: true,
        equal_scale: true,
    };
    vec![section("Quality", "", vec![Block::Chart(chart)])]
}
