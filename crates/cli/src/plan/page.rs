//! The page that `grasp` writes.

use hand::{Hand, hand_meshes};
use nalgebra::{Isometry3, Vector3};
use record::GraspsFile;
use record::grasps::{ConventionRecord, SourceRecord};
use report::{GraspPage, Mesh, PageGrasp, grasp_page};
use shape::{PointCloud, TriangleMesh};

use super::ranking::{cloud_from_palm, in_cloud};
use super::{Candidate, Target};
use crate::failure::Failure;

/// The paper's mesh: 10,000 vertices.
const MESH: usize = 100;
/// Grasps that are drawn with their hand.
const HANDS: usize = 12;

/// The whole page, in the frame of the cloud; `more` are lines at the end of its head.
pub(crate) fn render(
    target: &Target,
    cloud: Option<&PointCloud>,
    hand: &Hand,
    ranked: &[Candidate],
    file: &GraspsFile,
    more: Vec<String>,
) -> Result<String, Failure> {
    let centre = target.fit.centre_in_cloud;
    let mesh = target.fit.shape.mesh(MESH, MESH);
    let mut hands_left = HANDS;
    let grasps = ranked.iter().zip(&file.grasps).map(|(candidate, record)| {
        let placement = candidate.hand.as_ref().filter(|_| hands_left > 0);
        hands_left -= usize::from(placement.is_some());
        PageGrasp {
            label: String::new(),
            quality: record.quality,
            source: source_label(&record.source),
            contacts: record.contacts_m.clone(),
            inward_normals: record.inward_normals.clone(),
            details: details(record),
            hand: placement.and_then(|p| drawn_hand(hand, &p.joints, &cloud_from_palm(p, &centre))),
        }
    });
    let mut subtitle_lines = facts(target, &mesh, &file.convention);
    subtitle_lines.extend(more);
    let page = GraspPage {
        title: target.name.to_owned(),
        subtitle_lines,
        mesh: Mesh {
            vertices: mesh.vertices.iter().map(|p| in_cloud(p, &centre)).collect(),
            triangles: mesh.triangles,
        },
        cloud: cloud.map_or_else(Vec::new, |cloud| {
            cloud.points().iter().map(|p| (*p).into()).collect()
        }),
        friction: file.convention.friction,
        grasps: grasps.collect(),
    };
    grasp_page(&page).map_err(|e| Failure::other(format!("cannot draw the page: {e}")))
}

/// All pieces of a hand's collision model; `None` for joint values of the wrong number.
fn drawn_hand(hand: &Hand, joints: &[f64], cloud_from_palm: &Isometry3<f64>) -> Option<Mesh> {
    let mut drawn = Mesh::default();
    for (_, mesh) in hand_meshes(hand, joints).ok()? {
        drawn.append(&Mesh {
            vertices: mesh
                .vertices
                .iter()
                .map(|p| (cloud_from_palm * p).into())
                .collect(),
            triangles: mesh.triangles,
        });
    }
    Some(drawn)
}

/// "synthesis", or "transfer from S5 shampoo bottle".
pub(crate) fn source_label(source: &SourceRecord) -> String {
    match &source.from {
        Some(from) => format!("{} from {from}", source.kind),
        None => source.kind.clone(),
    }
}

fn facts(target: &Target, mesh: &TriangleMesh, convention: &ConventionRecord) -> Vec<String> {
    let size = 1e3 * extent(mesh);
    let (low, high) = target.fit.shape.radius_bounds();
    let torque = convention
        .torque_length_m
        .map_or(String::new(), |l| format!(", torques per {} mm", 1e3 * l));
    let edges = convention
        .edges
        .map_or("round cone".to_owned(), |k| format!("{k} edges"));
    vec![
        format!(
            "{} points, {:.0} × {:.0} × {:.0} mm; degree {}, fitted to {:.2} mm (root mean square).",
            target.fit.points,
            size.x,
            size.y,
            size.z,
            target.fit.shape.degree(),
            1e3 * target.fit.rms
        ),
        format!(
            "Proved: every point of the surface is between {:.1} and {:.1} mm from its centre.",
            1e3 * low,
            1e3 * high
        ),
        format!(
            "Quality under convention {}: μ = {}, {edges}{torque}.",
            convention.name, convention.friction
        ),
    ]
}

/// Lengths of the edges of the mesh's box, metres.
fn extent(mesh: &TriangleMesh) -> Vector3<f64> {
    let start = Vector3::repeat(f64::INFINITY);
    let (low, high) = mesh
        .vertices
        .iter()
        .fold((start, -start), |(low, high), p| {
            (low.inf(&p.coords), high.sup(&p.coords))
        });
    high - low
}

fn details(record: &record::GraspRecord) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    if let Some(distance) = record.source.shape_distance_m {
        facts.push((
            "distance of the shapes".to_owned(),
            format!("{:.1} mm", 1e3 * distance),
        ));
    }
    if let Some(quality) = record.source.source_quality {
        facts.push((
            "quality on the known object".to_owned(),
            format!("{quality:.3}"),
        ));
    }
    if let Some(hand) = &record.hand {
        facts.push(("hand".to_owned(), hand.name.clone()));
        if hand.contact_error_m > 0.0 {
            let error = format!("within {:.1} mm", 1e3 * hand.contact_error_m);
            facts.push(("tips at the contacts".to_owned(), error));
        }
        for (joint, value) in &hand.joints_rad {
            facts.push((joint.clone(), format!("{:.1}°", value.to_degrees())));
        }
    }
    facts
}
