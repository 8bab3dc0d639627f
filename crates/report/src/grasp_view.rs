//! The 3-D view of a grasp page as data for its script.
//!
//! The script reads the role of a trace from its `meta` (`surface`, `cloud`, `grasp`, `cones`,
//! `hand`). It shows the fixed traces and those of the selected grasp.

use plotly::common::{HoverInfo, Position};
use plotly::layout::Margin;
use plotly::plot::Traces;
use plotly::{Plot, Trace};

use crate::glyph;
use crate::mesh::{Extent, Mesh};
use crate::packed;
use crate::page_grasp::{GraspPage, PageGrasp};
use crate::rounding::{millimetres, point_millimetres};
use crate::theme;
use crate::trace;
use crate::view::{EYE_DIRECTION, View, ViewProjection};

/// Largest number of cloud points that are drawn; of a larger cloud every k-th point is drawn.
const MAX_CLOUD_POINTS: usize = 4000;
/// Length of an arrow as a share of the diagonal of the object's bounding box.
const ARROW: f64 = 0.2;
/// Slant length of a friction cone as a share of the same diagonal.
const CONE: f64 = 0.11;

/// `{"plot": figure, "grasps": [[trace…]…], "cameras": [{eye, center}…]}`.
pub(crate) fn json(page: &GraspPage) -> String {
    let object = Extent::of(&in_millimetres(&page.mesh.vertices));
    let bounds = bounds(page, object);
    let cameras: Vec<String> = page
        .grasps
        .iter()
        .map(|grasp| view(bounds, object, Some(grasp)).camera_json())
        .collect();
    let grasps: Vec<String> = page
        .grasps
        .iter()
        .map(|grasp| grasp_traces(grasp, page.friction, object).to_json())
        .collect();
    let mut value = packed::figure_value(&format!(
        "{{\"plot\":{},\"grasps\":[{}],\"cameras\":[{}]}}",
        fixed_plot(page, &view(bounds, object, page.grasps.first())).to_json(),
        grasps.join(",\n"),
        cameras.join(",\n")
    ));
    packed::set_light(&mut value, false);
    value.to_string()
}

/// The box of everything that can be shown.
fn bounds(page: &GraspPage, object: Extent) -> Extent {
    let mut bounds = object.padded(0.1 * object.diagonal());
    for grasp in &page.grasps {
        bounds.grow(&label_positions(grasp, object.diagonal()));
    }
    bounds.grow(&in_millimetres(&page.cloud));
    for hand in page.grasps.iter().filter_map(|g| g.hand.as_ref()) {
        bounds.grow(&in_millimetres(&hand.vertices));
    }
    bounds
}

/// The view of one grasp: the object, with the hand seen from the side, so that neither hides the
/// other.
fn view(bounds: Extent, object: Extent, grasp: Option<&PageGrasp>) -> View<'static> {
    let mut subject = object.padded(0.5 * ARROW * object.diagonal());
    let mut from = EYE_DIRECTION;
    if let Some(hand) = grasp.and_then(|g| g.hand.as_ref()) {
        let hand = Extent::of(&in_millimetres(&hand.vertices));
        from = across(glyph::subtract(hand.centre(), object.centre()));
        subject = object;
        subject.grow(&[hand.low, hand.high]);
        // The corners of the box are usually empty.
        subject = subject.padded(-0.06 * subject.diagonal());
    }
    View {
        bounds,
        subject,
        axes: Some(["x / mm", "y / mm", "z / mm"]),
        projection: ViewProjection::Perspective { from },
    }
}

/// The direction at a right angle to `line` that is nearest to the default direction of the camera;
/// the default direction if the two are nearly parallel.
fn across(line: [f64; 3]) -> [f64; 3] {
    let square = line.iter().map(|v| v * v).sum::<f64>();
    let along: f64 = (0..3).map(|i| line[i] * EYE_DIRECTION[i]).sum();
    if square <= 0.0 {
        return EYE_DIRECTION;
    }
    let rest = glyph::subtract(EYE_DIRECTION, glyph::scale(line, along / square));
    let length = glyph::norm(rest);
    if length < 0.2 {
        EYE_DIRECTION
    } else {
        glyph::scale(rest, 1.0 / length)
    }
}

/// Surface and cloud.
fn fixed_plot(page: &GraspPage, view: &View) -> Plot {
    let mut plot = Plot::new();
    let vertices = in_millimetres(&page.mesh.vertices);
    plot.add_trace(trace::mesh(&vertices, &page.mesh.triangles, theme::SURFACE).meta("surface"));
    let closed = &page.closed_holes;
    if !closed.triangles.is_empty() {
        let vertices = in_millimetres(&closed.vertices);
        let closed = trace::mesh(&vertices, &closed.triangles, theme::CLOSED_HOLE);
        plot.add_trace(closed.meta("surface"));
    }
    if !page.cloud.is_empty() {
        let stride = page.cloud.len().div_ceil(MAX_CLOUD_POINTS);
        let thinned: Vec<[f64; 3]> = page.cloud.iter().copied().step_by(stride).collect();
        let points = in_millimetres(&thinned);
        plot.add_trace(trace::points(&points, theme::CLOUD, 2).meta("cloud"));
    }
    plot.set_layout(
        theme::layout()
            .scene(view.scene())
            .show_legend(false)
            .margin(Margin::new().left(0).right(0).top(0).bottom(0)),
    );
    plot.set_configuration(theme::configuration_3d());
    plot
}

/// Numbered contacts, arrows, cones and hand of one grasp.
fn grasp_traces(grasp: &PageGrasp, friction: f64, object: Extent) -> Traces {
    let diagonal_mm = object.diagonal();
    let contacts = in_millimetres(&grasp.contacts);
    let mut traces = Traces::new();
    let arrow_length = ARROW * diagonal_mm;
    let mut arrows = Mesh::default();
    let mut cones = Mesh::default();
    for (&contact, out) in contacts.iter().zip(outward_normals(grasp)) {
        let tail = glyph::add(contact, glyph::scale(out, arrow_length));
        arrows.append(&glyph::arrow(tail, contact, 0.028 * arrow_length));
        // With a constant slant length the cone stays the same size for large μ.
        let height = CONE * diagonal_mm / friction.hypot(1.0);
        cones.append(&glyph::cone(contact, out, height, friction * height));
    }
    if !contacts.is_empty() {
        traces.push(solid(&arrows, theme::CONTACT, "grasp"));
        traces.push(contact_markers(&contacts, &grasp.distances_to_cloud));
        let numbers = (1..=contacts.len()).map(|k| k.to_string()).collect();
        traces.push(
            trace::text(&rounded(&label_positions(grasp, diagonal_mm)), numbers)
                .text_position(Position::MiddleCenter)
                .meta("grasp"),
        );
        if friction > 0.0 {
            let vertices = rounded(&cones.vertices);
            traces.push(
                trace::mesh(&vertices, &cones.triangles, theme::CONE)
                    .opacity(0.28)
                    .meta("cones"),
            );
        }
    }
    if let Some(weakest) = &grasp.weakest {
        for (axis, colour) in [
            (weakest.force, theme::FORCE),
            (weakest.torque, theme::TORQUE),
        ] {
            if let Some(arrow) = wrench_arrow(axis, colour, object) {
                traces.push(arrow);
            }
        }
    }
    if let Some(hand) = &grasp.hand {
        let hand = Mesh {
            vertices: in_millimetres(&hand.vertices),
            triangles: hand.triangles.clone(),
        };
        let vertices = rounded(&hand.vertices);
        traces.push(
            trace::mesh(&vertices, &hand.triangles, theme::HAND)
                .flat_shading(true)
                .meta("hand"),
        );
    }
    traces
}

/// Unit normals that point out of the object.
fn outward_normals(grasp: &PageGrasp) -> impl Iterator<Item = [f64; 3]> {
    let inward = grasp.inward_normals.iter();
    inward.map(|&n| glyph::scale(n, -1.0 / glyph::norm(n)))
}

/// Positions of the contacts' numbers: just beyond the tails of the arrows.
fn label_positions(grasp: &PageGrasp, diagonal_mm: f64) -> Vec<[f64; 3]> {
    let contacts = in_millimetres(&grasp.contacts);
    let pairs = contacts.iter().zip(outward_normals(grasp));
    pairs
        .map(|(&c, out)| glyph::add(c, glyph::scale(out, 1.12 * ARROW * diagonal_mm)))
        .collect()
}

/// The force or torque of the weakest wrench, as an arrow from the middle of the object; its length
/// is its share of the wrench.
fn wrench_arrow(part: [f64; 3], colour: &'static str, object: Extent) -> Option<Box<dyn Trace>> {
    let share = glyph::norm(part);
    if share < 0.05 {
        return None;
    }
    let tail = object.centre();
    let length = 0.7 * object.diagonal();
    let tip = glyph::add(tail, glyph::scale(part, length));
    let arrow = glyph::arrow(tail, tip, 0.012 * object.diagonal());
    Some(solid(&arrow, colour, "wrench"))
}

/// Contacts, coloured by their distance from the scan.
fn contact_markers(contacts_mm: &[[f64; 3]], distances: &[f64]) -> Box<dyn Trace> {
    let distance = |k: usize| distances.get(k).copied();
    let texts = contacts_mm.iter().enumerate().map(|(k, c)| {
        let [x, y, z] = c.map(|v| format!("{v:.1}"));
        let from_scan = distance(k).map_or(String::new(), |d| {
            format!(", {:.1} mm from the scan", 1e3 * d)
        });
        format!("contact {}: {x}, {y}, {z} mm{from_scan}", k + 1)
    });
    let colours = (0..contacts_mm.len())
        .map(|k| distance(k).map_or(theme::CONTACT, theme::distance_colour))
        .collect();
    trace::points_of(contacts_mm, colours, 9)
        .hover_text_array(texts.collect())
        .hover_info(HoverInfo::Text)
        .meta("grasp")
}

fn solid(mesh: &Mesh, colour: &'static str, role: &str) -> Box<dyn Trace> {
    trace::mesh(&rounded(&mesh.vertices), &mesh.triangles, colour).meta(role)
}

fn in_millimetres(points_m: &[[f64; 3]]) -> Vec<[f64; 3]> {
    points_m.iter().map(|&p| point_millimetres(p)).collect()
}

/// Rounds points given in millimetres.
fn rounded(points_mm: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let points = points_mm.iter();
    points.map(|p| p.map(|v| millimetres(v * 1e-3))).collect()
}
