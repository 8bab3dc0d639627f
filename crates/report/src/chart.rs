//! Curves and point sets in the plane.

use plotly::common::{DashType, HoverInfo, Line, Marker, Mode, Position, Title};
use plotly::layout::{Axis as PlotAxis, AxisConstrain, AxisType, Margin};
use plotly::{Plot, Scatter};

use crate::check;
use crate::error::ReportError;
use crate::rounding::significant;
use crate::scene::legend_on_top;
use crate::text;
use crate::theme;

/// Significant digits of a plotted number.
pub(crate) const DIGITS: i32 = 7;

/// A 2-D plot of named series.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Caption above the figure.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The series, in the order of the legend.
    pub series: Vec<Series>,
    /// Whether the line y = x is drawn, to compare before and after.
    pub diagonal: bool,
    /// Whether both axes have the same scale (linear axes only).
    pub equal_scale: bool,
}

/// An axis: its title and its scale.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// Title with the unit, as in `"RMS error / mm"`.
    pub label: String,
    /// Linear or logarithmic.
    pub scale: AxisScale,
}

/// Scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisScale {
    /// Linear.
    Linear,
    /// Logarithmic, to base 10; all values must be positive.
    Log,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Axis {
        Axis {
            label: label.into(),
            scale: AxisScale::Linear,
        }
    }

    /// A logarithmic axis (base 10). A page with a value ≤ 0 on it is an error.
    pub fn log(label: impl Into<String>) -> Axis {
        Axis {
            label: label.into(),
            scale: AxisScale::Log,
        }
    }

    /// The axis for plotly.js.
    pub(crate) fn plot_axis(&self) -> PlotAxis {
        let axis = PlotAxis::new()
            .title(Title::with_text(text::plot(&self.label)).font(theme::muted_font()))
            .tick_font(theme::muted_font())
            .grid_color(theme::GRID)
            .line_color(theme::RULE)
            .show_line(true)
            .zero_line(false)
            .auto_margin(true);
        match self.scale {
            AxisScale::Linear => axis.type_(AxisType::Linear),
            // Ticks at powers of ten and at 2 and 5 between them; ticks at all digits would
            // overlap.
            AxisScale::Log => axis.type_(AxisType::Log).n_ticks(8),
        }
    }
}

/// One named series of a [`Chart`].
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend; a series with an empty name has no entry.
    pub name: String,
    /// Points [x, y] in the order in which they are joined.
    pub points: Vec<[f64; 2]>,
    /// How the points are drawn.
    pub mark: Mark,
    /// One text per point; empty for none.
    pub labels: Vec<String>,
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// Points joined by a line.
    Line,
    /// Points joined by a dashed line, for a reference curve.
    Dashed,
    /// Unconnected markers.
    Points,
    /// Markers joined by a line.
    LineAndPoints,
}

impl Series {
    /// A line without labels.
    pub fn line(name: impl Into<String>, points: Vec<[f64; 2]>) -> Series {
        Series {
            name: name.into(),
            points,
            mark: Mark::Line,
            labels: Vec::new(),
        }
    }

    /// Unconnected markers without labels.
    pub fn points(name: impl Into<String>, points: Vec<[f64; 2]>) -> Series {
        Series {
            name: name.into(),
            points,
            mark: Mark::Points,
            labels: Vec::new(),
        }
    }

    fn trace(&self, k: usize) -> Box<Scatter<f64, f64>> {
        let column = |axis: usize| {
            let values = self.points.iter();
            values.map(|p| significant(p[axis], DIGITS)).collect()
        };
        let colour = theme::series_colour(k);
        let line = |dash| Line::new().color(colour).width(2.0).dash(dash);
        let labelled = !self.labels.is_empty();
        let mode = match (self.mark, labelled) {
            (Mark::Line | Mark::Dashed, false) => Mode::Lines,
            (Mark::Line | Mark::Dashed, true) => Mode::LinesText,
            (Mark::Points, false) => Mode::Markers,
            (Mark::Points, true) => Mode::MarkersText,
            (Mark::LineAndPoints, false) => Mode::LinesMarkers,
            (Mark::LineAndPoints, true) => Mode::LinesMarkersText,
        };
        // Many markers are drawn small and translucent, so that they stay readable.
        let crowded = self.points.len() > 200;
        let marker = Marker::new()
            .color(colour)
            .symbol(theme::series_symbol(k))
            .size(if crowded { 4 } else { 7 })
            .opacity(if crowded { 0.6 } else { 0.9 });
        let mut trace = Scatter::new(column(0), column(1))
            .mode(mode)
            .marker(marker)
            .line(match self.mark {
                Mark::Dashed => line(DashType::Dash),
                _ => line(theme::series_dash(k)),
            })
            .name(text::plot(&self.name))
            .show_legend(!self.name.is_empty());
        if labelled {
            let labels: Vec<String> = self.labels.iter().map(|l| text::plot(l)).collect();
            trace = trace.text_array(labels).text_position(Position::TopCenter);
        }
        trace
    }
}

impl Chart {
    pub(crate) fn plot(&self, place: &str) -> Result<Plot, ReportError> {
        self.check(place)?;
        let mut plot = Plot::new();
        if self.diagonal {
            plot.add_trace(self.diagonal_trace());
        }
        for (k, series) in self.series.iter().enumerate() {
            plot.add_trace(series.trace(k));
        }
        let (mut x_axis, mut y_axis) = (self.x.plot_axis(), self.y.plot_axis());
        if self.equal_scale {
            x_axis = x_axis.constrain(AxisConstrain::Domain);
            y_axis = y_axis.scale_anchor("x").constrain(AxisConstrain::Domain);
        }
        plot.set_layout(
            theme::layout()
                .x_axis(x_axis)
                .y_axis(y_axis)
                .margin(Margin::new().left(64).right(16).top(16).bottom(52))
                .legend(legend_on_top()),
        );
        plot.set_configuration(theme::configuration());
        Ok(plot)
    }

    fn check(&self, place: &str) -> Result<(), ReportError> {
        check::not_empty(&format!("{place}: series"), self.series.len())?;
        for (k, series) in self.series.iter().enumerate() {
            let place = format!("{place}: series {k} ({})", series.name);
            check::not_empty(&place, series.points.len())?;
            check::finite_points(&place, &series.points)?;
            check::labels(&place, series.points.len(), &series.labels)?;
            for (axis, side, name) in [(&self.x, 0, "x"), (&self.y, 1, "y")] {
                if axis.scale == AxisScale::Log {
                    let values = series.points.iter().map(|p| p[side]);
                    check::positive(&format!("{place}: {name}"), values)?;
                }
            }
        }
        let log = [&self.x, &self.y].map(|axis| axis.scale == AxisScale::Log);
        if self.equal_scale && (log[0] || log[1]) {
            return Err(ReportError::OutOfRange {
                place: format!("{place}: equal scale on a logarithmic axis, base"),
                value: 10.0,
                expected: "two linear axes",
            });
        }
        Ok(())
    }

    /// The line y = x over the range of all coordinates.
    fn diagonal_trace(&self) -> Box<Scatter<f64, f64>> {
        let coordinates = || {
            self.series
                .iter()
                .flat_map(|s| &s.points)
                .flatten()
                .copied()
        };
        let low = significant(coordinates().fold(f64::INFINITY, f64::min), DIGITS);
        let high = significant(coordinates().fold(f64::NEG_INFINITY, f64::max), DIGITS);
        Scatter::new(vec![low, high], vec![low, high])
            .mode(Mode::Lines)
            .line(
                Line::new()
                    .color(theme::RULE)
                    .width(1.5)
                    .dash(DashType::Dash),
            )
            .hover_info(HoverInfo::Skip)
            .name("y = x")
            .show_legend(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<[f64; 2]>) -> Chart {
        Chart {
            title: "t".into(),
            x: Axis::linear("x"),
            y: Axis::log("y"),
            series: vec![Series::line("s", points)],
            diagonal: false,
            equal_scale: false,
        }
    }

    #[test]
    fn log_axes_refuse_zero() {
        assert!(chart(vec![[0.0, 1.0]]).plot("c").is_ok());
        assert!(matches!(
            chart(vec![[1.0, 1.0], [0.0, 0.0]]).plot("c"),
            Err(ReportError::NotPositive { index: 1, .. })
        ));
    }

    #[test]
    fn nan_is_refused() {
        assert!(matches!(
            chart(vec![[f64::NAN, 1.0]]).plot("c"),
            Err(ReportError::NotFinite { index: 0, .. })
        ));
    }

    #[test]
    fn the_diagonal_spans_all_coordinates() {
        let mut chart = chart(vec![[0.25, 0.5], [0.125, 0.75]]);
        chart.diagonal = true;
        let json = chart.plot("c").unwrap().to_json();
        assert!(json.contains("\"x\":[0.125,0.75],\"y\":[0.125,0.75]"));
    }

    #[test]
    fn labels_must_match_the_points() {
        let mut chart = chart(vec![[1.0, 1.0]]);
        chart.series[0].labels = vec!["a".into(), "b".into()];
        assert!(chart.plot("c").is_err());
    }
}
