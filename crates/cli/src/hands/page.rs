//! The page of a hand: findings, and pictures in every pre-shape.

use hand::{Hand, Joint, JointKind, hand_meshes};
use nalgebra::{Isometry3, Point3};
use report::{Block, Item, Mesh, Page, Part, SceneCell, SceneGrid, Section, Surface, Table};

use super::findings::Checked;
use super::trial::Trial;
use crate::failure::Failure;
use crate::outcomes::sentence;

/// Share of the closing motion in the middle picture.
const HALF: f64 = 0.5;
/// The ball's mesh has this many rows and columns.
const BALL_MESH: usize = 40;

/// The whole page.
pub(crate) fn render(hand: &Hand, checked: &Checked, trial: &Trial) -> Result<String, Failure> {
    let page = Page {
        title: format!("Hand {}", hand.name()),
        intro: intro(hand, trial),
        sections: vec![pictures(hand, trial)?, findings(checked), joints(hand)],
    };
    page.to_html()
        .map_err(|e| Failure::other(format!("cannot draw the page: {e}")))
}

fn intro(hand: &Hand, trial: &Trial) -> String {
    let model = hand.model();
    format!(
        "{} links, {} joints of which {} are driven, {} fingers, {} pre-shapes; the palm is '{}'.\n\nOn a ball of {:.0} mm, {}.",
        model.links().len(),
        model.joints().len(),
        model.driven_count(),
        hand.fingers().len(),
        hand.preshapes().len(),
        model.links()[0].name,
        1e3 * trial.diameter,
        sentence(&trial.outcomes)
    )
}

fn pictures(hand: &Hand, trial: &Trial) -> Result<Section, Failure> {
    let mut cells = Vec::new();
    for (preshape, best) in hand.preshapes().iter().zip(&trial.best) {
        // A legend needs every name once.
        let named = cells.is_empty();
        let mut cell = |what: &str, items: Vec<Item>| {
            let label = format!("{}: {what}", preshape.name);
            cells.push(SceneCell { label, items });
        };
        cell("opened", drawn(hand, &preshape.joints, named)?);
        let half = hand.closed(&preshape.joints, HALF);
        cell("half closed", drawn(hand, &half, false)?);
        match best {
            None => cell("no grasp of the ball", Vec::new()),
            Some(grasp) => {
                let mut items = drawn(hand, &grasp.joints, false)?;
                items.push(ball(trial, &grasp.centred_from_palm.inverse()));
                cell("on the ball", items);
            }
        }
    }
    Ok(Section {
        heading: "Pre-shapes".to_owned(),
        text: "The collision model in the frame of the palm, x to the right and z up: before the fingers close, half-way to the limits of their joints, and in the best grasp of the ball."
            .to_owned(),
        blocks: vec![Block::SceneGrid(SceneGrid {
            columns: 3,
            cells,
            ..SceneGrid::default()
        })],
    })
}

/// The parts that no finger moves, and one part per finger.
fn drawn(hand: &Hand, joints: &[f64], named: bool) -> Result<Vec<Item>, Failure> {
    let meshes = hand_meshes(hand, joints).map_err(|e| Failure::other(e.to_string()))?;
    let mut fixed = Mesh::default();
    let mut fingers = vec![Mesh::default(); hand.fingers().len()];
    for (link, mesh) in meshes {
        let mover = hand
            .fingers()
            .iter()
            .position(|f| f.moving_links.contains(&link));
        let whole = mover.map_or(&mut fixed, |finger| &mut fingers[finger]);
        whole.append(&Mesh {
            vertices: mesh.vertices.iter().map(|p| (*p).into()).collect(),
            triangles: mesh.triangles,
        });
    }
    let mut items: Vec<Item> = hand
        .fingers()
        .iter()
        .zip(fingers)
        .map(|(finger, mesh)| {
            let name = if named {
                finger.name.clone()
            } else {
                String::new()
            };
            Item::Part(Part { name, mesh })
        })
        .collect();
    if !fixed.vertices.is_empty() {
        items.push(Item::Surface(Surface {
            mesh: fixed,
            values: Vec::new(),
        }));
    }
    Ok(items)
}

fn ball(trial: &Trial, palm_from_object: &Isometry3<f64>) -> Item {
    let mesh = trial.ball.mesh(BALL_MESH, BALL_MESH);
    let moved = |p: &Point3<f64>| (palm_from_object * p).into();
    Item::Part(Part {
        name: String::new(),
        mesh: Mesh {
            vertices: mesh.vertices.iter().map(moved).collect(),
            triangles: mesh.triangles,
        },
    })
}

fn findings(checked: &Checked) -> Section {
    let heading = "Findings".to_owned();
    if checked.findings.is_empty() {
        return Section {
            heading,
            text: "Nothing to worry about.".to_owned(),
            blocks: Vec::new(),
        };
    }
    let row = |f: &super::findings::Finding| vec![f.severity.to_owned(), f.text.clone()];
    Section {
        heading,
        text: String::new(),
        blocks: vec![Block::Table(Table {
            title: String::new(),
            headers: vec!["severity".to_owned(), "finding".to_owned()],
            rows: checked.findings.iter().map(row).collect(),
        })],
    }
}

/// Driven joints, their limits, which finger they close and their values in the pre-shapes.
fn joints(hand: &Hand) -> Section {
    let mut headers: Vec<String> = ["joint", "least", "greatest", "closes"]
        .map(str::to_owned)
        .into();
    headers.extend(hand.preshapes().iter().map(|p| p.name.clone()));
    let row = |(driven, joint): (usize, &Joint)| {
        let closes = hand.groups().iter().find_map(|group| {
            let (_, ratio) = group.closing.iter().find(|(d, _)| *d == driven)?;
            let names = group
                .fingers
                .iter()
                .map(|&f| hand.fingers()[f].name.as_str());
            let names: Vec<&str> = names.collect();
            Some(format!("{} × {ratio}", names.join(", ")))
        });
        let mut cells = vec![
            joint.name.clone(),
            value(joint, joint.limits.0),
            value(joint, joint.limits.1),
            closes.unwrap_or_default(),
        ];
        cells.extend(
            hand.preshapes()
                .iter()
                .map(|p| value(joint, p.joints[driven])),
        );
        cells
    };
    Section {
        heading: "Driven joints".to_owned(),
        text: String::new(),
        blocks: vec![Block::Table(Table {
            title: String::new(),
            headers,
            rows: hand.model().driven_joints().enumerate().map(row).collect(),
        })],
    }
}

/// Degrees, or millimetres of a joint that slides.
fn value(joint: &Joint, value: f64) -> String {
    // Adding 0 leaves no negative zero.
    match joint.kind {
        JointKind::Prismatic => format!("{:.1} mm", 1e3 * value + 0.0),
        JointKind::Fixed | JointKind::Revolute => format!("{:.1}°", value.to_degrees() + 0.0),
    }
}
