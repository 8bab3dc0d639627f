//! The page that `grasp` writes.

use hand::{Hand, hand_meshes};
use moduli::{Embedding, Grasp, Measure, Object};
use nalgebra::{Isometry3, Point3, Vector3};
use record::GraspsFile;
use record::grasps::{
    ConventionRecord, EdgesRecord, JointRecord, JointUnit, SourceRecord, SurfaceModel,
};
use report::{GraspPage, Mesh, PageGrasp, WeakestWrench, grasp_page};
use shape::closed_patch::patch_at;
use shape::{ClosedPatch, PointCloud, Support, TriangleMesh};

use crate::failure::Failure;

/// The paper's mesh: 10,000 vertices.
const MESH: usize = 100;
/// The same for a map of the sphere, whose points are not spread evenly.
const MAP_MESH: usize = 160;
/// Number of grasps that are drawn with their hand.
const HANDS: usize = 12;

/// Corners of the disc that stands for the support plane.
const CORNERS: u32 = 64;
/// The disc is this many times as wide as the object seen from above.
const WIDER: f64 = 1.5;

/// The whole page, in the frame of the cloud; `more` are lines at the end of its head.
pub(crate) fn render(
    measure: &Measure,
    cloud: Option<&PointCloud>,
    hand: &Hand,
    ranked: &[Grasp],
    file: &GraspsFile,
    more: Vec<String>,
) -> Result<String, Failure> {
    let object = measure.object();
    let rows = match object.model() {
        SurfaceModel::Radial => MESH,
        SurfaceModel::Spherical => MAP_MESH,
    };
    let mesh = object.shape().mesh(rows, rows);
    let (open, closed) = by_holes(&mesh, object.shape().closed_patches());
    let mut hands_left = HANDS;
    let grasps = ranked.iter().zip(&file.grasps).map(|(grasp, record)| {
        let placement = grasp.hand().filter(|_| hands_left > 0);
        hands_left -= usize::from(placement.is_some());
        PageGrasp {
            label: String::new(),
            quality: record.quality,
            lower: grasp.epsilon().lower,
            distances_to_cloud: cloud.map_or_else(Vec::new, |cloud| {
                let distance = |c: &[f64; 3]| nearest(cloud, c);
                record.contacts_m.iter().map(distance).collect()
            }),
            weakest: Some(weakest(grasp)),
            pose: pose_text(record),
            source: source_label(&record.source),
            contacts: record.contacts_m.clone(),
            inward_normals: record.inward_normals.clone(),
            details: details(record),
            hand: placement.and_then(|p| drawn_hand(hand, &p.joints, &grasp.palm_in_cloud()?)),
        }
    });
    let mut subtitle_lines = facts(measure, &mesh, &file.convention);
    subtitle_lines.extend(more);
    let warnings = object.report().warnings.iter();
    subtitle_lines.extend(warnings.map(|w| format!("Warning: {w}.")));
    let vertices: Vec<Point3<f64>> = mesh
        .vertices
        .iter()
        .map(|p| object.frame().to_cloud(p))
        .collect();
    let mut drawn = Mesh {
        vertices: vertices.iter().map(|p| (*p).into()).collect(),
        triangles: open,
    };
    if let Some(support) = measure.support() {
        let in_cloud = object.frame().plane_to_cloud(&support);
        drawn.append(&ground(&in_cloud, &vertices));
        subtitle_lines.push(
            "The disc below the object is the plane on which it stands; hands stay above it."
                .to_owned(),
        );
    }
    let page = GraspPage {
        title: object.name().to_owned(),
        subtitle_lines,
        mesh: drawn,
        closed_holes: alone(&mesh, &closed, object),
        cloud: cloud.map_or_else(Vec::new, |cloud| {
            cloud.points().iter().map(|p| (*p).into()).collect()
        }),
        friction: file.convention.friction,
        grasps: grasps.collect(),
    };
    grasp_page(&page).map_err(|e| Failure::other(format!("cannot draw the page: {e}")))
}

/// A disc of the support plane below the vertices of an object.
fn ground(support: &Support, vertices: &[Point3<f64>]) -> Mesh {
    let foot = |p: &Point3<f64>| p - support.normal.into_inner() * support.height(p);
    let count = vertices.len().max(1) as f64;
    let sum: Vector3<f64> = vertices.iter().map(|p| foot(p).coords).sum();
    let middle = Point3::from(sum / count);
    let reach = vertices.iter().map(|p| (foot(p) - middle).norm());
    let radius = WIDER * reach.fold(0.0, f64::max);
    let (a, b) = sph::direction::tangent_frame(&support.normal);
    let rim = (0..CORNERS).map(|k| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
        (middle + (a * cos + b * sin) * radius).into()
    });
    Mesh {
        vertices: std::iter::once(middle.into()).chain(rim).collect(),
        triangles: (0..CORNERS)
            .map(|k| [0, 1 + k, 1 + (k + 1) % CORNERS])
            .collect(),
    }
}

/// The triangles of a surface that are not on parts that close holes, and those that are.
fn by_holes(mesh: &TriangleMesh, patches: &[ClosedPatch]) -> (Vec<[u32; 3]>, Vec<[u32; 3]>) {
    let on: Vec<bool> = mesh
        .vertices
        .iter()
        .map(|v| patch_at(patches, v).is_some())
        .collect();
    let closes = |t: &[u32; 3]| t.iter().all(|v| on[*v as usize]);
    let (closed, open) = mesh.triangles.iter().copied().partition(closes);
    (open, closed)
}

/// Some triangles of a mesh with their own vertices, in the frame of the cloud.
fn alone(mesh: &TriangleMesh, triangles: &[[u32; 3]], object: &Object) -> Mesh {
    let mut names = vec![None; mesh.vertices.len()];
    let mut out = Mesh::default();
    for triangle in triangles {
        out.triangles.push(triangle.map(|v| {
            *names[v as usize].get_or_insert_with(|| {
                let place = object.frame().to_cloud(&mesh.vertices[v as usize]);
                out.vertices.push(place.into());
                out.vertices.len() as u32 - 1
            })
        }));
    }
    out
}

/// Distance of a point from the nearest point of the cloud, metres.
pub(crate) fn nearest(cloud: &PointCloud, point: &[f64; 3]) -> f64 {
    let point = Point3::from(*point);
    let squares = cloud.points().iter().map(|p| (p - point).norm_squared());
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

/// The unit wrench that the grasp resists least.
fn weakest(grasp: &Grasp) -> WeakestWrench {
    let wrench = grasp.epsilon().direction;
    WeakestWrench {
        force: [wrench[0], wrench[1], wrench[2]],
        torque: [wrench[3], wrench[4], wrench[5]],
    }
}

/// The hand of a grasp as JSON to copy; empty without one.
fn pose_text(record: &record::GraspRecord) -> String {
    let hand = record.hand.as_ref();
    hand.and_then(|hand| serde_json::to_string(hand).ok())
        .unwrap_or_default()
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
    match source {
        SourceRecord::Transfer {
            from: Some(from), ..
        } => format!("{} from {from}", source.kind()),
        _ => source.kind().to_owned(),
    }
}

fn facts(measure: &Measure, mesh: &TriangleMesh, convention: &ConventionRecord) -> Vec<String> {
    let size = 1e3 * extent(mesh);
    let object = measure.object();
    let torque = convention
        .torque_length_m
        .map_or(String::new(), |l| format!(", torques per {} mm", 1e3 * l));
    let edges = match convention.edges {
        EdgesRecord::Round { .. } => "round cone".to_owned(),
        EdgesRecord::Polygon(count) => format!("{count} edges"),
    };
    vec![
        format!(
            "{} points, {:.0} × {:.0} × {:.0} mm; degree {}, fitted to {:.2} mm (root mean square).",
            object.report().points,
            size.x,
            size.y,
            size.z,
            object.shape().degree(),
            1e3 * object.report().rms
        ),
        proved(object),
        format!(
            "Quality under convention {}: μ = {}, {edges}{torque}.",
            convention.name, convention.friction
        ),
    ]
}

/// What is proved of the surface.
fn proved(object: &Object) -> String {
    let (low, high) = object.radius_bounds();
    match (object.model(), object.report().embedding) {
        (SurfaceModel::Radial, _) => format!(
            "Proved: every point of the surface is between {:.1} and {:.1} mm from its centre.",
            1e3 * low,
            1e3 * high
        ),
        (SurfaceModel::Spherical, Some(Embedding::Proved { .. })) => {
            "A map of the sphere, proved to be smooth and not to touch itself.".to_owned()
        }
        (SurfaceModel::Spherical, _) => {
            "A map of the sphere, proved to be an immersion.".to_owned()
        }
    }
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
    let distance = match &record.source {
        SourceRecord::Transfer {
            shape_distance_m, ..
        } => *shape_distance_m,
        _ => None,
    };
    if let Some(distance) = distance {
        facts.push((
            "distance of the shapes".to_owned(),
            format!("{:.1} mm", 1e3 * distance),
        ));
    }
    if let Some(quality) = record.source.source_quality() {
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
        for (name, joint) in &hand.joints {
            facts.push((name.clone(), joint_value(joint)));
        }
    }
    facts
}

/// Degrees for joints that turn, millimetres for joints that slide.
fn joint_value(joint: &JointRecord) -> String {
    // Adding 0 leaves no negative zero.
    match joint.unit {
        Some(JointUnit::Radians) => format!("{:.1}°", joint.value.to_degrees() + 0.0),
        Some(JointUnit::Metres) => format!("{:.1} mm", 1e3 * joint.value + 0.0),
        None => format!("{} rad or m", joint.value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliding_joints_are_shown_in_millimetres() {
        let joint = |value, unit| {
            joint_value(&JointRecord {
                value,
                unit,
                follows: None,
            })
        };
        assert_eq!(joint(0.0205, Some(JointUnit::Metres)), "20.5 mm");
        assert_eq!(joint(0.5, Some(JointUnit::Radians)), "28.6°");
        assert_eq!(joint(-0.0, Some(JointUnit::Radians)), "0.0°");
        assert_eq!(joint(0.0205, None), "0.0205 rad or m");
    }
}
