//! The page of one object and its ranked grasps.

use crate::check;
use crate::document::{Scripts, document};
use crate::error::ReportError;
use crate::grasp_view;
use crate::mesh::Mesh;
use crate::rounding;
use crate::text;

const SCRIPT: &str = include_str!("assets/grasp_page.js");

/// What the page of one object shows. All points are in one frame, in metres.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GraspPage {
    /// Name of the object: title and heading.
    pub title: String,
    /// Lines under the heading: size, certified radius bounds, convention, time.
    pub subtitle_lines: Vec<String>,
    /// The surface of the object.
    pub mesh: Mesh,
    /// The measured cloud (n × 3); at most 4,000 of its points are drawn. May be empty.
    pub cloud: Vec<[f64; 3]>,
    /// Coefficient of friction μ ≥ 0: friction cones of half angle atan μ; 0 draws none.
    pub friction: f64,
    /// The grasps, best first: rank 1 is entry 0. May be empty.
    pub grasps: Vec<PageGrasp>,
}

/// One grasp on a [`GraspPage`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageGrasp {
    /// A short name; may be empty.
    pub label: String,
    /// The quality by which the grasps are ranked.
    pub quality: f64,
    /// Where the grasp comes from, as in `"transfer from S5"` or `"synthesis"`.
    pub source: String,
    /// Contact points (m × 3), metres.
    pub contacts: Vec<[f64; 3]>,
    /// Inward normals at the contacts (m × 3), of any length above zero.
    pub inward_normals: Vec<[f64; 3]>,
    /// Further facts as name and value, as in joint angles of a hand.
    pub details: Vec<(String, String)>,
    /// The hand around the object, metres. Worth giving for the best few.
    pub hand: Option<Mesh>,
}

/// The page as self-contained HTML: a view that turns, a selector, a table of the grasps.
///
/// The arrows stand outside the object and press along the inward normals; the friction
/// cones open outwards from the contacts. Coordinates are shown in millimetres, rounded to
/// 0.01 mm. Adding `#3` to the address of the page opens it at the grasp of rank 3. Size
/// is that of plotly.js (4.6 MB) and about 0.7 MB for a mesh of 10,000 vertices.
///
/// # Errors
/// [`ReportError`] names the part and entry of the first number that is not finite, of a
/// triangle without its vertex, of an empty mesh, of a normal without length, or of
/// contacts and normals that differ in number.
pub fn grasp_page(page: &GraspPage) -> Result<String, ReportError> {
    check_page(page)?;
    let mut body = String::from("<main class=\"grasps\">\n<header>\n");
    body += &format!("<h1>{}</h1>\n", text::html(&page.title));
    for line in &page.subtitle_lines {
        body += &format!("<p class=\"fact\">{}</p>\n", text::html(line));
    }
    body += "</header>\n<div class=\"columns\">\n";
    body += &view_html(page);
    body += &list_html(page);
    body += "</div>\n</main>\n";
    let scripts = Scripts {
        data: vec![("grasp-data".to_owned(), grasp_view::json(page))],
        code: SCRIPT,
    };
    Ok(document(&page.title, &body, Some(scripts)))
}

fn check_page(page: &GraspPage) -> Result<(), ReportError> {
    page.mesh.check("mesh")?;
    check::finite_points("cloud", &page.cloud)?;
    if !(page.friction.is_finite() && page.friction >= 0.0) {
        return Err(ReportError::OutOfRange {
            place: "friction".to_owned(),
            value: page.friction,
            expected: "a finite number, at least 0",
        });
    }
    for (index, grasp) in page.grasps.iter().enumerate() {
        grasp.check(&format!("grasp {index}"))?;
    }
    Ok(())
}

impl PageGrasp {
    fn check(&self, place: &str) -> Result<(), ReportError> {
        check::finite(&format!("{place}: quality"), &[self.quality])?;
        check::finite_points(&format!("{place}: contacts"), &self.contacts)?;
        let normals = format!("{place}: normals");
        check::same_length(&normals, self.contacts.len(), self.inward_normals.len())?;
        check::finite_points(&normals, &self.inward_normals)?;
        if self.inward_normals.contains(&[0.0; 3]) {
            return Err(ReportError::OutOfRange {
                place: normals,
                value: 0.0,
                expected: "a length above zero",
            });
        }
        match &self.hand {
            None => Ok(()),
            Some(hand) => hand.check(&format!("{place}: hand")),
        }
    }
}

/// Controls and view on the left, with the facts of the selected grasp below.
fn view_html(page: &GraspPage) -> String {
    let mut out = String::from("<div class=\"left\">\n");
    out += &controls_html(page);
    out += "<div id=\"view\" role=\"img\" aria-label=\"3-D view of the object and the \
            selected grasp\"></div>\n";
    out += "<p class=\"note\">";
    if !page.grasps.is_empty() {
        out += "Arrows: inward normals, pressing on the contacts. ";
        if page.friction > 0.0 {
            out += "Cones: friction. ";
        }
    }
    out += "Drag to turn, scroll to zoom. Axes in millimetres.</p>\n";
    for (index, grasp) in page.grasps.iter().enumerate() {
        out += &details_html(index, grasp);
    }
    out += "</div>\n";
    out
}

fn controls_html(page: &GraspPage) -> String {
    let mut out = String::from("<div class=\"controls\">\n");
    if !page.grasps.is_empty() {
        out += "<span class=\"group\"><button type=\"button\" id=\"previous\" \
                aria-label=\"previous grasp\">‹</button>\n\
                <select id=\"selector\" aria-label=\"grasp\">\n";
        for (index, grasp) in page.grasps.iter().enumerate() {
            out += &format!(
                "<option value=\"{index}\">{} · {} · {}</option>\n",
                index + 1,
                quality_text(grasp.quality),
                text::html(&grasp.source)
            );
        }
        out += "</select>\n<button type=\"button\" id=\"next\" \
                aria-label=\"next grasp\">›</button></span>\n";
    }
    let mut switches = vec![("glass", "see through", false)];
    if !page.cloud.is_empty() {
        switches.push(("cloud", "cloud", false));
    }
    if page.friction > 0.0 && !page.grasps.is_empty() {
        switches.push(("cones", "friction cones", true));
    }
    if page.grasps.iter().any(|g| g.hand.is_some()) {
        switches.push(("hand", "hand", true));
    }
    out += "<span class=\"group\">";
    for (id, label, on) in switches {
        let checked = if on { " checked" } else { "" };
        out += &format!(
            "<label><input type=\"checkbox\" id=\"show-{id}\"{checked}> {label}</label>\n"
        );
    }
    out += "</span>\n</div>\n";
    out
}

/// The facts of one grasp; only those of the selected grasp are shown.
fn details_html(index: usize, grasp: &PageGrasp) -> String {
    let hidden = if index == 0 { "" } else { " hidden" };
    let name = if grasp.label.is_empty() {
        format!("Grasp {}", index + 1)
    } else {
        format!("Grasp {} · {}", index + 1, text::html(&grasp.label))
    };
    let mut out =
        format!("<div class=\"details\" id=\"details-{index}\"{hidden}>\n<h2>{name}</h2>\n<dl>\n");
    let mut fact = |name: &str, value: &str| {
        let (name, value) = (text::html(name), text::html(value));
        out += &format!("<div><dt>{name}</dt><dd>{value}</dd></div>\n");
    };
    fact("quality", &quality_text(grasp.quality));
    fact("source", &grasp.source);
    for (k, normal) in grasp.inward_normals.iter().enumerate() {
        let length = normal.iter().map(|v| v * v).sum::<f64>().sqrt();
        let unit = normal.map(|v| format!("{:.3}", v / length + 0.0));
        fact(&format!("inward normal {}", k + 1), &unit.join(", "));
    }
    for (name, value) in &grasp.details {
        fact(name, value);
    }
    out += "</dl>\n</div>\n";
    out
}

/// The table of all grasps on the right.
fn list_html(page: &GraspPage) -> String {
    let mut out = String::from("<div class=\"right\">\n");
    if page.grasps.is_empty() {
        return out + "<p>No grasp was found on this object.</p>\n</div>\n";
    }
    out += "<div class=\"scroll tall\"><table id=\"grasps\">\n<thead><tr>\
            <th scope=\"col\">Rank</th><th scope=\"col\" class=\"num\">Quality</th>\
            <th scope=\"col\">Source</th>\
            <th scope=\"col\" class=\"num\">Contacts x, y, z / mm</th></tr></thead>\n<tbody>\n";
    for (index, grasp) in page.grasps.iter().enumerate() {
        out += &row_html(index, grasp);
    }
    out += "</tbody></table></div>\n</div>\n";
    out
}

fn row_html(index: usize, grasp: &PageGrasp) -> String {
    let rank = index + 1;
    let mut source = text::html(&grasp.source);
    if !grasp.label.is_empty() {
        source += &format!("<br><small>{}</small>", text::html(&grasp.label));
    }
    let contacts: Vec<String> = grasp.contacts.iter().map(|&c| point_text(c)).collect();
    let current = if index == 0 { " class=\"current\"" } else { "" };
    format!(
        "<tr data-index=\"{index}\"{current}><td><button type=\"button\" \
         aria-label=\"show grasp {rank}\">{rank}</button></td>\
         <td class=\"num\">{}</td><td>{source}</td><td class=\"num\">{}</td></tr>\n",
        quality_text(grasp.quality),
        contacts.join("<br>")
    )
}

/// Four decimals: two grasps that differ by less are equal to a reader.
fn quality_text(quality: f64) -> String {
    format!("{:.4}", rounding::decimals(quality, 4))
}

/// Millimetres with one decimal.
fn point_text(point_m: [f64; 3]) -> String {
    point_m
        .map(|v| format!("{:.1}", rounding::decimals(1000.0 * v, 1)))
        .join(", ")
}
