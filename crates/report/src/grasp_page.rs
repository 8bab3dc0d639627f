//! The page of one object and its ranked grasps.

use crate::document::{Scripts, document};
use crate::error::ReportError;
use crate::grasp_view;
use crate::page_grasp::{GraspPage, PageGrasp};
use crate::rounding;
use crate::text;
use crate::theme;

const SCRIPT: &str = include_str!("assets/grasp_page.js");

/// The page as self-contained HTML: a rotatable view, a selector, and a table of the grasps.
///
/// The arrows are outside the object and press along the inward normals. The friction cones open
/// outwards from the contacts. Coordinates are shown in millimetres. Adding `#3` to the address of
/// the page opens it at the grasp of rank 3; the arrow keys select the previous and the next grasp.
/// The page has the size of compressed plotly.js (1.9 MB) plus about 0.3 MB for a mesh of 10,000
/// vertices.
///
/// # Errors
/// [`ReportError`] names the part and entry of the first number that is not finite, of a
/// triangle without its vertex, of an empty mesh, of a normal without length, or of
/// contacts and normals that differ in number.
pub fn grasp_page(page: &GraspPage) -> Result<String, ReportError> {
    page.check()?;
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

/// Controls and view on the left, with the details of the selected grasp below.
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
        if page.grasps.iter().any(|g| !g.distances_to_cloud.is_empty()) {
            let [near, middle, far] = theme::DISTANCE;
            out += &format!(
                "Contacts by distance from the scan: {} up to 1 mm, {} up to 3 mm, {} farther. ",
                dot(near),
                dot(middle),
                dot(far)
            );
        }
        if page.grasps.iter().any(|g| g.weakest.is_some()) {
            out += &format!(
                "Weakest wrench: {} force, {} torque. ",
                dot(theme::FORCE),
                dot(theme::TORQUE)
            );
        }
    }
    if !page.closed_holes.triangles.is_empty() {
        out += &format!(
            "{} Closed holes: nothing is there to touch. ",
            dot(theme::CLOSED_HOLE)
        );
    }
    out +=
        "Drag to turn, scroll to zoom, arrow keys for the next grasp. Axes in millimetres.</p>\n";
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
        switches.push(("handglass", "hand see through", true));
    }
    if page.grasps.iter().any(|g| g.weakest.is_some()) {
        switches.push(("wrench", "weakest wrench", false));
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

/// The details of one grasp; only those of the selected grasp are visible.
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
    fact("proved lower bound", &quality_text(grasp.lower));
    fact("source", &grasp.source);
    if let Some(weakest) = &grasp.weakest {
        fact("weakest wrench: force", &vector_text(weakest.force));
        fact("weakest wrench: torque", &vector_text(weakest.torque));
    }
    for (k, &contact) in grasp.contacts.iter().enumerate() {
        fact(&format!("contact {} / mm", k + 1), &point_text(contact));
    }
    for (k, normal) in grasp.inward_normals.iter().enumerate() {
        let length = normal.iter().map(|v| v * v).sum::<f64>().sqrt();
        let unit = normal.map(|v| format!("{:.3}", v / length + 0.0));
        fact(&format!("inward normal {}", k + 1), &unit.join(", "));
    }
    for (name, value) in &grasp.details {
        fact(name, value);
    }
    out += "</dl>\n";
    if !grasp.pose.is_empty() {
        out += &format!(
            "<p><button type=\"button\" class=\"copy\" data-text=\"{}\">copy the pose</button></p>\n",
            text::html(&grasp.pose)
        );
    }
    out += "</div>\n";
    out
}

/// A dot in the colour of a mark in the view.
fn dot(colour: &str) -> String {
    format!("<span class=\"dot\" style=\"background:{colour}\"></span>")
}

/// Three components with three decimals each.
fn vector_text(v: [f64; 3]) -> String {
    v.map(|x| format!("{:.3}", rounding::decimals(x, 3)))
        .join(", ")
}

/// The table of all grasps on the right.
fn list_html(page: &GraspPage) -> String {
    let mut out = String::from("<div class=\"right\">\n");
    if page.grasps.is_empty() {
        return out + "<p>No grasp was found on this object.</p>\n</div>\n";
    }
    out += "<div class=\"scroll tall\"><table id=\"grasps\">\n<thead><tr>\
            <th scope=\"col\">Rank</th><th scope=\"col\" class=\"num\">Quality</th>\
            <th scope=\"col\" class=\"num\">Lower</th>\
            <th scope=\"col\" class=\"num\">Scan / mm</th><th scope=\"col\">Hand</th>\
            <th scope=\"col\">Source</th></tr></thead>\n<tbody>\n";
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
    let farthest = grasp.distances_to_cloud.iter().copied().reduce(f64::max);
    let to_scan = farthest.map_or("–".to_owned(), |d| {
        format!("{:.1}", rounding::decimals(1e3 * d, 1))
    });
    let hand = if grasp.hand.is_some() || !grasp.pose.is_empty() {
        "yes"
    } else {
        "no"
    };
    let current = if index == 0 { " class=\"current\"" } else { "" };
    format!(
        "<tr data-index=\"{index}\"{current}><td><button type=\"button\" \
         aria-label=\"show grasp {rank}\">{rank}</button></td>\
         <td class=\"num\">{}</td><td class=\"num\">{}</td><td class=\"num\">{to_scan}</td>\
         <td>{hand}</td><td>{source}</td></tr>\n",
        quality_text(grasp.quality),
        quality_text(grasp.lower),
    )
}

/// Quality with four decimals.
fn quality_text(quality: f64) -> String {
    format!("{:.4}", rounding::decimals(quality, 4))
}

/// Millimetres with one decimal.
fn point_text(point_m: [f64; 3]) -> String {
    point_m
        .map(|v| format!("{:.1}", rounding::decimals(1000.0 * v, 1)))
        .join(", ")
}
