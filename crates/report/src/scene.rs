//! One 3-D view.

use plotly::Plot;
use plotly::common::{Anchor, Orientation};
use plotly::layout::{Legend, Margin};

use crate::check;
use crate::error::ReportError;
use crate::mesh::Extent;
use crate::scene_item::{ColourScale, Colours, Item};
use crate::theme;
use crate::view::{EYE_DIRECTION, View, ViewProjection};

/// One rotatable 3-D view with equal scales on all axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scene {
    /// Caption above the figure.
    pub title: String,
    /// Axis titles with their unit, such as `"x / mm"`; `None` draws no axes.
    pub axes: Option<[String; 3]>,
    /// What is shown. Parts, points and lines take the colours of the palette in this order.
    pub items: Vec<Item>,
    /// Colour map of surface values.
    pub colour_scale: ColourScale,
    /// Title of the colour bar.
    pub value_label: String,
}

impl Scene {
    pub(crate) fn plot(&self, place: &str) -> Result<Plot, ReportError> {
        check::not_empty(&format!("{place}: items"), self.items.len())?;
        let mut extent = Extent::EMPTY;
        for (index, item) in self.items.iter().enumerate() {
            item.check(&format!("{place}: item {index}"))?;
            let reach = item.extent();
            if !reach.is_empty() {
                extent.grow(&[reach.low, reach.high]);
            }
        }
        if extent.is_empty() {
            return Err(ReportError::Empty {
                place: format!("{place}: items"),
            });
        }
        let bounds = extent.padded(0.04 * extent.diagonal().max(1e-9));
        let view = View {
            bounds,
            subject: bounds,
            axes: self
                .axes
                .as_ref()
                .map(|titles| std::array::from_fn(|i| titles[i].as_str())),
            projection: ViewProjection::Perspective {
                from: EYE_DIRECTION,
            },
        };
        let mut plot = Plot::new();
        plot.set_layout(
            theme::layout()
                .scene(view.scene())
                .margin(Margin::new().left(0).right(0).top(0).bottom(0))
                .legend(legend_on_top()),
        );
        plot.set_configuration(theme::configuration_3d());
        self.add_traces(&mut plot, decimals_for(bounds.longest()));
        Ok(plot)
    }

    fn add_traces(&self, plot: &mut Plot, places: i32) {
        let colours = Colours::of(self.colour_scale, &self.value_label, self.items.iter());
        let mut series = 0;
        let mut colour_bar = true;
        for item in &self.items {
            plot.add_traces(item.traces(series, [0.0; 3], places, &colours, colour_bar));
            series += usize::from(item.takes_series_colour());
            colour_bar &= !matches!(item, Item::Surface(s) if !s.values.is_empty());
        }
    }
}

/// A legend in one row above the figure, so that the figure has the full width.
pub(crate) fn legend_on_top() -> Legend {
    Legend::new()
        .orientation(Orientation::Horizontal)
        .x(0.0)
        .x_anchor(Anchor::Left)
        .y(1.02)
        .y_anchor(Anchor::Bottom)
        .background_color(theme::CLEAR)
}

/// Number of decimals that resolves 1e-5 of a figure of this size.
pub(crate) fn decimals_for(size: f64) -> i32 {
    if size > 0.0 {
        5 - size.log10().floor() as i32
    } else {
        6
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_item::Points;

    #[test]
    fn decimals_follow_the_size() {
        assert_eq!(decimals_for(0.2), 6);
        assert_eq!(decimals_for(150.0), 3);
    }

    #[test]
    fn a_scene_without_points_is_refused() {
        let scene = Scene {
            items: vec![Item::Points(Points::default())],
            ..Scene::default()
        };
        assert!(matches!(scene.plot("s"), Err(ReportError::Empty { .. })));
    }
}
