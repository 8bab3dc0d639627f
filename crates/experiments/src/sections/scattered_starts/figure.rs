//! The best of many ascents against our transfer.

use report::{Axis, Block, Chart, Section, Series};

use super::findings::{AtLeast, Compared, SPREAD, Settings};
use crate::drawing::section;
use crate::ledger::ThreadSeconds;
use crate::statistics::mean;
use crate::table::{Table, number, per_cent};

pub(super) fn table(
    settings: &Settings,
    compared: &[Compared],
    shares: &[AtLeast],
    times: &ThreadSeconds,
) -> Table {
    let mut table = Table::new(
        format!(
            "Transfers against the best of {} runs of the paper's ascent of {} steps from starts scattered by {SPREAD} rad",
            settings.runs, settings.ascent.steps
        ),
        &["at least the best run less", "ours", "ours, thorough"],
    );
    for s in shares {
        table.row([s.margin.to_string(), per_cent(s.ours), per_cent(s.thorough)]);
    }
    let mean_of = |pick: fn(&Compared) -> f64| mean(&compared.iter().map(pick).collect::<Vec<_>>());
    table.note(format!(
        "{} transfers; mean of the best run {}, of ours {}, thorough {}",
        compared.len(),
        number(mean_of(|c| c.runs.best()), 4),
        number(mean_of(|c| c.ours), 4),
        number(mean_of(|c| c.thorough), 4)
    ));
    table.note(format!(
        "Mean qualities computed: all runs {}, thorough {}; seconds summed over threads {:.1} and {:.1}",
        number(mean_of(|c| c.runs.evaluations as f64), 0),
        number(mean_of(|c| c.thorough_evaluations as f64), 0),
        times.paper,
        times.ours
    ));
    table
}

/// One point per transfer; above the diagonal our transfer is better.
pub(super) fn figures(compared: &[Compared]) -> Vec<Section> {
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
