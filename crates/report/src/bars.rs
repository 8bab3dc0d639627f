//! Bars by category and histograms.

use plotly::common::{Marker, Title};
use plotly::layout::{Axis as PlotAxis, AxisType, BarMode, Margin};
use plotly::{Bar, Layout, Plot};

use crate::chart::{Axis, DIGITS};
use crate::check;
use crate::error::ReportError;
use crate::rounding::significant;
use crate::scene::legend_on_top;
use crate::text;
use crate::theme;

/// Bars by category, grouped by series.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bars {
    /// Caption above the figure.
    pub title: String,
    /// Title of the horizontal axis.
    pub x_label: String,
    /// Title of the vertical axis.
    pub y_label: String,
    /// The categories, left to right.
    pub categories: Vec<String>,
    /// The series, each with one bar per category.
    pub series: Vec<BarSeries>,
}

/// One series of [`Bars`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BarSeries {
    /// Name in the legend.
    pub name: String,
    /// One height per category.
    pub values: Vec<f64>,
}

/// Counts of values in bins of equal width.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Histogram {
    /// Caption above the figure.
    pub title: String,
    /// Title of the horizontal axis.
    pub x_label: String,
    /// Number of bins over the range of all samples; at least 1.
    pub bins: usize,
    /// The samples, drawn over each other in the same bins.
    pub samples: Vec<Sample>,
}

/// One sample of a [`Histogram`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sample {
    /// Name in the legend.
    pub name: String,
    /// The values of the sample.
    pub values: Vec<f64>,
}

impl Bars {
    pub(crate) fn plot(&self, place: &str) -> Result<Plot, ReportError> {
        check::not_empty(&format!("{place}: categories"), self.categories.len())?;
        check::not_empty(&format!("{place}: series"), self.series.len())?;
        let categories: Vec<String> = self.categories.iter().map(|c| text::plot(c)).collect();
        let mut plot = Plot::new();
        for (k, series) in self.series.iter().enumerate() {
            let place = format!("{place}: series {k} ({})", series.name);
            check::same_length(&place, categories.len(), series.values.len())?;
            check::finite(&place, &series.values)?;
            let heights = series.values.iter().map(|&v| significant(v, DIGITS));
            plot.add_trace(
                Bar::new(categories.clone(), heights.collect())
                    .name(text::plot(&series.name))
                    .marker(Marker::new().color(theme::series_colour(k)))
                    .show_legend(!series.name.is_empty() && self.series.len() > 1),
            );
        }
        let x_axis = axis(&self.x_label)
            .type_(AxisType::Category)
            .show_grid(false);
        plot.set_layout(layout(x_axis, &self.y_label).bar_mode(BarMode::Group));
        plot.set_configuration(theme::configuration());
        Ok(plot)
    }
}

impl Histogram {
    pub(crate) fn plot(&self, place: &str) -> Result<Plot, ReportError> {
        check::not_empty(&format!("{place}: bins"), self.bins)?;
        let total = self.samples.iter().map(|s| s.values.len()).sum();
        check::not_empty(&format!("{place}: samples"), total)?;
        for (k, sample) in self.samples.iter().enumerate() {
            check::finite(
                &format!("{place}: sample {k} ({})", sample.name),
                &sample.values,
            )?;
        }
        let bins = self.edges();
        let mut plot = Plot::new();
        let centres: Vec<f64> = (0..self.bins)
            .map(|b| significant(bins.low + (b as f64 + 0.5) * bins.width, DIGITS))
            .collect();
        for (k, sample) in self.samples.iter().enumerate() {
            plot.add_trace(
                Bar::new(centres.clone(), self.counts(&bins, &sample.values))
                    .name(text::plot(&sample.name))
                    .width(significant(bins.width, DIGITS))
                    .marker(Marker::new().color(theme::series_colour(k)))
                    .opacity(if self.samples.len() > 1 { 0.6 } else { 1.0 })
                    .show_legend(!sample.name.is_empty() && self.samples.len() > 1),
            );
        }
        plot.set_layout(layout(axis(&self.x_label), "count").bar_mode(BarMode::Overlay));
        plot.set_configuration(theme::configuration());
        Ok(plot)
    }

    /// Bins over the range of all samples; a range of zero width is widened.
    fn edges(&self) -> Edges {
        let values = || self.samples.iter().flat_map(|s| &s.values).copied();
        let low = values().fold(f64::INFINITY, f64::min);
        let high = values().fold(f64::NEG_INFINITY, f64::max);
        let width = (high - low) / self.bins as f64;
        if width > 0.0 {
            return Edges { low, width };
        }
        let width = low.abs().max(1.0) * 1e-3;
        Edges {
            low: low - 0.5 * width * self.bins as f64,
            width,
        }
    }

    /// Number of values in each bin; the last bin includes its upper edge.
    fn counts(&self, edges: &Edges, values: &[f64]) -> Vec<usize> {
        let mut counts = vec![0; self.bins];
        for value in values {
            let bin = ((value - edges.low) / edges.width) as usize;
            counts[bin.min(self.bins - 1)] += 1;
        }
        counts
    }
}

/// Lower end and width of equal bins.
struct Edges {
    low: f64,
    width: f64,
}

fn axis(label: &str) -> PlotAxis {
    PlotAxis::new()
        .title(Title::with_text(text::plot(label)).font(theme::muted_font()))
        .tick_font(theme::muted_font())
        .line_color(theme::RULE)
        .grid_color(theme::GRID)
        .show_line(true)
        .auto_margin(true)
}

fn layout(x_axis: PlotAxis, y_label: &str) -> Layout {
    theme::layout()
        .x_axis(x_axis)
        .y_axis(Axis::linear(y_label).plot_axis())
        .bar_gap(0.12)
        .margin(Margin::new().left(64).right(16).top(16).bottom(52))
        .legend(legend_on_top())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn histogram(values: Vec<f64>, bins: usize) -> Histogram {
        Histogram {
            bins,
            samples: vec![Sample {
                name: String::new(),
                values,
            }],
            ..Histogram::default()
        }
    }

    #[test]
    fn every_value_is_counted_once() {
        let values = vec![0.0, 0.1, 0.5, 0.9, 1.0];
        let histogram = histogram(values.clone(), 2);
        let counts = histogram.counts(&histogram.edges(), &values);
        assert_eq!(counts, vec![2, 3]);
    }

    #[test]
    fn equal_values_share_a_bin() {
        let values = vec![3.0; 4];
        let histogram = histogram(values.clone(), 3);
        let counts = histogram.counts(&histogram.edges(), &values);
        assert_eq!(counts, vec![0, 4, 0]);
    }

    #[test]
    fn empty_and_nan_are_refused() {
        assert!(histogram(vec![], 3).plot("h").is_err());
        assert!(histogram(vec![1.0], 0).plot("h").is_err());
        assert!(histogram(vec![f64::NAN], 3).plot("h").is_err());
    }

    #[test]
    fn bars_need_a_value_a_category() {
        let bars = Bars {
            categories: vec!["a".into(), "b".into()],
            series: vec![BarSeries {
                name: "s".into(),
                values: vec![1.0],
            }],
            ..Bars::default()
        };
        assert!(bars.plot("b").is_err());
    }
}
