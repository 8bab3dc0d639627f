//! Colours and fonts: one look for pages and figures.

use plotly::common::{DashType, Font, MarkerSymbol};
use plotly::configuration::DisplayModeBar;
use plotly::layout::ModeBar;
use plotly::{Configuration, Layout};

/// Fonts that every system has; the style sheet has the same list.
pub(crate) const FONT_FAMILY: &str =
    "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', 'DejaVu Sans', sans-serif";
/// Body text.
pub(crate) const INK: &str = "#1d2733";
/// Secondary text and axis titles (contrast 5.9 : 1 on white).
pub(crate) const MUTED: &str = "#55606e";
/// Grid lines.
pub(crate) const GRID: &str = "#e1e6eb";
/// Axis lines and reference lines.
pub(crate) const RULE: &str = "#98a3af";
/// The object.
pub(crate) const SURFACE: &str = "#c3d0db";
/// Contacts and the arrows of their normals.
pub(crate) const CONTACT: &str = "#b84500";
/// Parts of a surface that close holes of the object.
pub(crate) const CLOSED_HOLE: &str = "#cc79a7";
/// Friction cones.
pub(crate) const CONE: &str = "#e69f00";
/// The hand.
pub(crate) const HAND: &str = "#4a5f7a";
/// The cloud of measured points.
pub(crate) const CLOUD: &str = "#2b6f9e";
/// The force of the weakest wrench.
pub(crate) const FORCE: &str = "#cc79a7";
/// The torque of the weakest wrench.
pub(crate) const TORQUE: &str = "#56b4e9";
/// Colours of contacts by their distance from the scan: up to 1 mm, up to 3 mm, farther.
pub(crate) const DISTANCE: [&str; 3] = ["#009e73", "#e69f00", "#d55e00"];

/// The colour of a contact at a distance from the scan, metres.
pub(crate) fn distance_colour(distance: f64) -> &'static str {
    DISTANCE[usize::from(distance > 1e-3) + usize::from(distance > 3e-3)]
}

/// Fully transparent.
pub(crate) const CLEAR: &str = "rgba(0,0,0,0)";

/// The palette of Okabe and Ito, which is distinguishable with all common forms of colour vision,
/// without its yellow (too pale on white).
const SERIES: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#4d4d4d",
];

/// Colour of the `k`-th series.
pub(crate) fn series_colour(k: usize) -> &'static str {
    SERIES[k % SERIES.len()]
}

/// Marker of the `k`-th series of a plane figure; it changes when the colours repeat.
pub(crate) fn series_symbol(k: usize) -> MarkerSymbol {
    const SYMBOLS: [MarkerSymbol; 5] = [
        MarkerSymbol::Circle,
        MarkerSymbol::Diamond,
        MarkerSymbol::Square,
        MarkerSymbol::TriangleUp,
        MarkerSymbol::Cross,
    ];
    SYMBOLS[(k / SERIES.len()) % SYMBOLS.len()].clone()
}

/// Line style of the `k`-th series; it changes when the colours repeat.
pub(crate) fn series_dash(k: usize) -> DashType {
    const DASHES: [DashType; 4] = [
        DashType::Solid,
        DashType::DashDot,
        DashType::LongDash,
        DashType::Dot,
    ];
    DASHES[(k / SERIES.len()) % DASHES.len()].clone()
}

/// The font of all text inside figures.
pub(crate) fn font() -> Font {
    Font::new().family(FONT_FAMILY).size(12).color(INK)
}

/// The font of axis titles.
pub(crate) fn muted_font() -> Font {
    Font::new().family(FONT_FAMILY).size(12).color(MUTED)
}

/// A layout without title on a transparent background.
pub(crate) fn layout() -> Layout {
    Layout::new()
        .font(font())
        .paper_background_color(CLEAR)
        .plot_background_color(CLEAR)
        .mode_bar(
            ModeBar::new()
                .background_color(CLEAR)
                .color(RULE)
                .active_color(INK),
        )
        .auto_size(true)
}

/// For plane figures: resized with the page, with the legend on top. A double click resets the
/// zoom.
pub(crate) fn configuration() -> Configuration {
    Configuration::new()
        .responsive(true)
        .display_mode_bar(DisplayModeBar::False)
}

/// For 3-D views: resized with the page, with plotly's buttons on hover and no logo.
pub(crate) fn configuration_3d() -> Configuration {
    Configuration::new()
        .responsive(true)
        .display_logo(false)
        .display_mode_bar(DisplayModeBar::Hover)
}
