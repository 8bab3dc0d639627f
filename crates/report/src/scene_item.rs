//! Items of a scene: surfaces, parts, points, lines, arrows.

use plotly::Trace;
use plotly::common::{ColorBar, ColorScale, ColorScalePalette, HoverInfo, ThicknessMode, Title};

use crate::check;
use crate::error::ReportError;
use crate::glyph;
use crate::mesh::{Extent, Mesh};
use crate::rounding;
use crate::text;
use crate::theme;
use crate::trace;

/// One item of a [`Scene`](crate::Scene) or of a cell of a [`SceneGrid`](crate::SceneGrid).
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A shaded surface, plain or coloured by a scalar.
    Surface(Surface),
    /// A shaded surface with a colour of the palette.
    Part(Part),
    /// Unconnected points.
    Points(Points),
    /// One polyline.
    Lines(Lines),
    /// Arrows that end at the given points.
    Arrows(Arrows),
}

/// A shaded surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// The mesh.
    pub mesh: Mesh,
    /// One scalar per vertex, which colours the surface; empty for a plain surface.
    pub values: Vec<f64>,
}

/// A shaded surface in a colour of the palette.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Part {
    /// Name in the legend; an empty name has no entry.
    pub name: String,
    /// The mesh.
    pub mesh: Mesh,
}

/// Unconnected points of one colour.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Points {
    /// Name in the legend; an empty name has no entry.
    pub name: String,
    /// Positions (n × 3).
    pub points: Vec<[f64; 3]>,
    /// One text per point; empty for none.
    pub labels: Vec<String>,
    /// Diameter in pixels.
    pub size_px: usize,
}

/// One polyline.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lines {
    /// Name in the legend; an empty name has no entry.
    pub name: String,
    /// Vertices in order (n × 3).
    pub points: Vec<[f64; 3]>,
}

/// Arrows of one colour; arrow i ends at `tips[i]` and points along `directions[i]`.
///
/// With contacts as tips and inward normals as directions, the arrows are outside the object and
/// press on it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Arrows {
    /// End points of the arrows (n × 3).
    pub tips: Vec<[f64; 3]>,
    /// Directions of the arrows (n × 3), of any positive length.
    pub directions: Vec<[f64; 3]>,
    /// Length of each arrow in the unit of the scene.
    pub length: f64,
}

/// Map from scalars to colours; its range is that of all values of the figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourScale {
    /// From the smallest to the largest value (Viridis).
    #[default]
    Sequential,
    /// Blue below zero, red above, with a symmetric range.
    Diverging,
}

/// Colour map of a figure: the scale, its bounds, its title.
pub(crate) struct Colours {
    pub(crate) scale: ColourScale,
    pub(crate) range: [f64; 2],
    pub(crate) title: String,
}

impl Colours {
    /// The colours of all surface values among `items`.
    pub(crate) fn of<'a>(
        scale: ColourScale,
        title: &str,
        items: impl Iterator<Item = &'a Item>,
    ) -> Colours {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for item in items {
            if let Item::Surface(surface) = item {
                for &value in &surface.values {
                    range = [range[0].min(value), range[1].max(value)];
                }
            }
        }
        if scale == ColourScale::Diverging {
            let bound = range[0].abs().max(range[1].abs());
            range = [-bound, bound];
        }
        Colours {
            scale,
            range,
            title: text::plot(title),
        }
    }
}

impl Item {
    pub(crate) fn check(&self, place: &str) -> Result<(), ReportError> {
        match self {
            Item::Surface(surface) => {
                surface.mesh.check(&format!("{place}: mesh"))?;
                if surface.values.is_empty() {
                    return Ok(());
                }
                let place = format!("{place}: values");
                check::same_length(&place, surface.mesh.vertices.len(), surface.values.len())?;
                check::finite(&place, &surface.values)
            }
            Item::Part(part) => part.mesh.check(&format!("{place}: mesh")),
            Item::Points(points) => {
                check::finite_points(&format!("{place}: points"), &points.points)?;
                let labels = format!("{place}: labels");
                check::labels(&labels, points.points.len(), &points.labels)
            }
            Item::Lines(lines) => check::finite_points(&format!("{place}: line"), &lines.points),
            Item::Arrows(arrows) => arrows.check(place),
        }
    }

    /// The box of all points of the item.
    pub(crate) fn extent(&self) -> Extent {
        match self {
            Item::Surface(surface) => Extent::of(&surface.mesh.vertices),
            Item::Part(part) => Extent::of(&part.mesh.vertices),
            Item::Points(points) => Extent::of(&points.points),
            Item::Lines(lines) => Extent::of(&lines.points),
            Item::Arrows(arrows) => Extent::of(&arrows.mesh().vertices),
        }
    }

    /// The traces, shifted by `offset` and rounded to `places` decimals.
    pub(crate) fn traces(
        &self,
        series: usize,
        offset: [f64; 3],
        places: i32,
        colours: &Colours,
        colour_bar: bool,
    ) -> Vec<Box<dyn Trace>> {
        let place = |points: &[[f64; 3]]| -> Vec<[f64; 3]> {
            let moved = points.iter().map(|&p| glyph::add(p, offset));
            moved
                .map(|p| p.map(|v| rounding::decimals(v, places)))
                .collect()
        };
        match self {
            Item::Surface(surface) => vec![surface_trace(
                surface,
                &place(&surface.mesh.vertices),
                colours,
                colour_bar,
            )],
            Item::Part(part) => {
                let colour = theme::series_colour(series);
                let vertices = place(&part.mesh.vertices);
                let trace = trace::mesh(&vertices, &part.mesh.triangles, colour).flat_shading(true);
                vec![if part.name.is_empty() {
                    trace
                } else {
                    trace.name(text::plot(&part.name)).show_legend(true)
                }]
            }
            Item::Points(points) => point_traces(points, &place(&points.points), series),
            Item::Lines(lines) => {
                let trace = trace::line(&place(&lines.points), theme::series_colour(series), 4.0);
                vec![if lines.name.is_empty() {
                    trace
                } else {
                    trace.name(text::plot(&lines.name)).show_legend(true)
                }]
            }
            Item::Arrows(arrows) => {
                let mesh = arrows.mesh();
                let vertices = place(&mesh.vertices);
                vec![trace::mesh(&vertices, &mesh.triangles, theme::CONTACT)]
            }
        }
    }

    /// Whether the item takes a colour from the series palette.
    pub(crate) fn takes_series_colour(&self) -> bool {
        matches!(self, Item::Part(_) | Item::Points(_) | Item::Lines(_))
    }
}

impl Arrows {
    fn check(&self, place: &str) -> Result<(), ReportError> {
        check::finite_points(&format!("{place}: arrow tips"), &self.tips)?;
        let directions = format!("{place}: arrow directions");
        check::same_length(&directions, self.tips.len(), self.directions.len())?;
        check::finite_points(&directions, &self.directions)?;
        let lengths = self.directions.iter().map(|&d| glyph::norm(d));
        if let Some(value) = lengths.into_iter().find(|&l| l <= 0.0) {
            return Err(ReportError::OutOfRange {
                place: directions,
                value,
                expected: "a length above zero",
            });
        }
        if self.length.is_finite() && self.length > 0.0 {
            return Ok(());
        }
        Err(ReportError::OutOfRange {
            place: format!("{place}: arrow length"),
            value: self.length,
            expected: "a finite length above zero",
        })
    }

    fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        for (&tip, &direction) in self.tips.iter().zip(&self.directions) {
            let back = glyph::scale(direction, -self.length / glyph::norm(direction));
            mesh.append(&glyph::arrow(
                glyph::add(tip, back),
                tip,
                0.035 * self.length,
            ));
        }
        mesh
    }
}

fn surface_trace(
    surface: &Surface,
    vertices: &[[f64; 3]],
    colours: &Colours,
    colour_bar: bool,
) -> Box<dyn Trace> {
    let trace = trace::mesh(vertices, &surface.mesh.triangles, theme::SURFACE);
    if surface.values.is_empty() {
        return trace;
    }
    let palette = match colours.scale {
        ColourScale::Sequential => ColorScalePalette::Viridis,
        ColourScale::Diverging => ColorScalePalette::RdBu,
    };
    let values = surface.values.iter();
    let trace = trace
        .intensity(values.map(|&v| rounding::significant(v, 5)).collect())
        .color_scale(ColorScale::Palette(palette))
        .c_min(colours.range[0])
        .c_max(colours.range[1])
        .show_scale(colour_bar);
    if colour_bar {
        trace.color_bar(
            ColorBar::new()
                .title(Title::with_text(&colours.title).font(theme::muted_font()))
                .tick_font(theme::muted_font())
                .thickness(12)
                // In pixels, which leaves the corner free for the buttons.
                .len_mode(ThicknessMode::Pixels)
                .len(180)
                .outline_width(0),
        )
    } else {
        trace
    }
}

fn point_traces(points: &Points, positions: &[[f64; 3]], series: usize) -> Vec<Box<dyn Trace>> {
    let mut trace = trace::points(
        positions,
        theme::series_colour(series),
        points.size_px.max(1),
    );
    if !points.name.is_empty() {
        trace = trace.name(text::plot(&points.name)).show_legend(true);
    }
    if points.labels.is_empty() {
        return vec![trace];
    }
    let labels: Vec<String> = points.labels.iter().map(|l| text::plot(l)).collect();
    let trace = trace
        .hover_text_array(labels.clone())
        .hover_info(HoverInfo::Text);
    let names = trace::text(positions, labels).text_position(plotly::common::Position::TopCenter);
    vec![trace, names]
}
