//! The three kinds of traces of a 3-D view: meshes, points, lines.

use plotly::common::{HoverInfo, Line, Marker, MarkerSymbol, Mode};
use plotly::traces::mesh3d::Lighting;
use plotly::{Mesh3D, Scatter3D};

/// A mesh with numeric coordinates.
pub(crate) type MeshTrace = Mesh3D<f64, f64, f64>;
/// A 3-D scatter with numeric coordinates.
pub(crate) type ScatterTrace = Scatter3D<f64, f64, f64>;

/// Splits points into the three coordinate lists of plotly.js.
fn columns(points: &[[f64; 3]]) -> [Vec<f64>; 3] {
    std::array::from_fn(|axis| points.iter().map(|p| p[axis]).collect())
}

/// A shaded mesh of one colour with a semi-matte finish and no hover text.
pub(crate) fn mesh(
    vertices: &[[f64; 3]],
    triangles: &[[u32; 3]],
    colour: &'static str,
) -> Box<MeshTrace> {
    let [x, y, z] = columns(vertices);
    let corner = |c: usize| Some(triangles.iter().map(|t| t[c] as usize).collect());
    Mesh3D::new(x, y, z, corner(0), corner(1), corner(2))
        .color(colour)
        .flat_shading(false)
        .lighting(semi_matte())
        .hover_info(HoverInfo::Skip)
        .show_legend(false)
}

/// Mostly diffuse light with a faint gloss.
fn semi_matte() -> Lighting {
    Lighting::new()
        .ambient(0.5)
        .diffuse(0.55)
        .specular(0.12)
        .roughness(0.6)
        .fresnel(0.08)
        // Triangles are measured in the figure's unit. In metres the default bound would treat
        // small triangles as degenerate and draw them black.
        .face_normals_epsilon(1e-24)
        .vertex_normals_epsilon(1e-24)
}

/// Unconnected points of one colour.
pub(crate) fn points(
    points: &[[f64; 3]],
    colour: &'static str,
    size_px: usize,
) -> Box<ScatterTrace> {
    let outline = Line::new().width(0.0);
    markers(
        points,
        Marker::new().color(colour).size(size_px).line(outline),
    )
}

/// Unconnected points, each with its own colour and a thin outline.
pub(crate) fn points_of(
    points: &[[f64; 3]],
    colours: Vec<&'static str>,
    size_px: usize,
) -> Box<ScatterTrace> {
    let outline = Line::new().width(1.0).color("#ffffff");
    let marker = Marker::new().color_array(colours).size(size_px);
    markers(points, marker.line(outline))
}

fn markers(points: &[[f64; 3]], marker: Marker) -> Box<ScatterTrace> {
    let [x, y, z] = columns(points);
    Scatter3D::new(x, y, z)
        .mode(Mode::Markers)
        .marker(marker.symbol(MarkerSymbol::Circle))
        .hover_info(HoverInfo::Skip)
        .show_legend(false)
}

/// A polyline.
pub(crate) fn line(points: &[[f64; 3]], colour: &'static str, width_px: f64) -> Box<ScatterTrace> {
    let [x, y, z] = columns(points);
    Scatter3D::new(x, y, z)
        .mode(Mode::Lines)
        .line(Line::new().color(colour).width(width_px))
        .hover_info(HoverInfo::Skip)
        .show_legend(false)
}

/// Text at points.
pub(crate) fn text(points: &[[f64; 3]], labels: Vec<String>) -> Box<ScatterTrace> {
    let [x, y, z] = columns(points);
    Scatter3D::new(x, y, z)
        .mode(Mode::Text)
        .text_array(labels)
        .hover_info(HoverInfo::Skip)
        .show_legend(false)
}
