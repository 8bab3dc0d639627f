//! The three kinds of thing that a 3-D view draws: meshes, points, lines.

use plotly::common::{HoverInfo, Line, Marker, MarkerSymbol, Mode};
use plotly::traces::mesh3d::{LightPosition, Lighting};
use plotly::{Mesh3D, Scatter3D};

/// A mesh whose coordinates are all numbers.
pub(crate) type MeshTrace = Mesh3D<f64, f64, f64>;
/// A 3-D scatter whose coordinates are all numbers.
pub(crate) type ScatterTrace = Scatter3D<f64, f64, f64>;

/// Splits points into the three coordinate lists that plotly.js wants.
fn columns(points: &[[f64; 3]]) -> [Vec<f64>; 3] {
    std::array::from_fn(|axis| points.iter().map(|p| p[axis]).collect())
}

/// A lit mesh of one colour with a semi-matte finish, silent on hover.
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
        .light_position(light_placeholder())
        .hover_info(HoverInfo::Skip)
        .show_legend(false)
}

/// Mostly diffuse light with a faint sheen.
fn semi_matte() -> Lighting {
    Lighting::new()
        .ambient(0.5)
        .diffuse(0.55)
        .specular(0.12)
        .roughness(0.6)
        .fresnel(0.08)
        // Triangles are measured in the figure's own unit; in metres the default bounds
        // would take small ones for degenerate and leave them black.
        .face_normals_epsilon(1e-24)
        .vertex_normals_epsilon(1e-24)
}

/// Stands in every mesh until [`with_light`] knows the projection.
fn light_placeholder() -> LightPosition {
    LightPosition::new().x(vec![0.0]).y(vec![0.0]).z(vec![0.0])
}

/// Sets the light of all meshes in the JSON of a figure: over the viewer's left shoulder,
/// whichever way the object is turned.
///
/// plotly.js reads the position in coordinates of the screen: right, up, and depth with −1
/// at the near plane, so one place in space has other numbers in a `flat` (parallel) view.
/// The plotly crate writes each coordinate as a list, which plotly.js does not accept (it
/// falls back to a light from the side); it wants plain numbers. User text cannot hold the
/// pattern, since quotes inside JSON strings are escaped.
pub(crate) fn with_light(json: &str, flat: bool) -> String {
    json.replace(
        r#""lightposition":{"x":[0.0],"y":[0.0],"z":[0.0]}"#,
        if flat {
            r#""lightposition":{"x":-4,"y":6,"z":-8}"#
        } else {
            r#""lightposition":{"x":-12,"y":18,"z":-1}"#
        },
    )
}

/// Unconnected points.
pub(crate) fn points(
    points: &[[f64; 3]],
    colour: &'static str,
    size_px: usize,
) -> Box<ScatterTrace> {
    let [x, y, z] = columns(points);
    Scatter3D::new(x, y, z)
        .mode(Mode::Markers)
        .marker(
            Marker::new()
                .color(colour)
                .size(size_px)
                .symbol(MarkerSymbol::Circle)
                .line(Line::new().width(0.0)),
        )
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

/// Text that stands at points.
pub(crate) fn text(points: &[[f64; 3]], labels: Vec<String>) -> Box<ScatterTrace> {
    let [x, y, z] = columns(points);
    Scatter3D::new(x, y, z)
        .mode(Mode::Text)
        .text_array(labels)
        .hover_info(HoverInfo::Skip)
        .show_legend(false)
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotly::Trace;

    #[test]
    fn the_light_position_is_three_numbers() {
        let trace = mesh(
            &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            &[[0, 1, 2]],
            "#fff",
        );
        let json: serde_json::Value =
            serde_json::from_str(&with_light(&trace.to_json(), false)).unwrap();
        for axis in ["x", "y", "z"] {
            assert!(json["lightposition"][axis].is_number());
        }
    }
}
