//! The hand's collision model as triangles, for the picture.

use hand::{Geometry, Hand};
use nalgebra::{Isometry3, Point3};
use report::Mesh;

/// Corners around a circle.
const SIDES: u32 = 20;
/// Circles of latitude on a half sphere.
const CAPS: u32 = 4;

/// All pieces of the hand at joint values, in the frame into which `frame_from_palm` leads.
///
/// Pieces that are hulls of user meshes are left out; joint values of the wrong number give `None`.
pub(crate) fn hand_mesh(
    hand: &Hand,
    joints: &[f64],
    frame_from_palm: &Isometry3<f64>,
) -> Option<Mesh> {
    let palm_from_links = hand.model().root_from_links(joints).ok()?;
    let mut mesh = Mesh::default();
    for (link, palm_from_link) in hand.model().links().iter().zip(&palm_from_links) {
        for piece in &link.geometry {
            let frame_from_piece = frame_from_palm * palm_from_link * piece.link_from_geometry;
            if let Some(part) = solid(&piece.geometry) {
                mesh.append(&placed(part, &frame_from_piece));
            }
        }
    }
    Some(mesh)
}

fn placed(mut part: Mesh, pose: &Isometry3<f64>) -> Mesh {
    for vertex in &mut part.vertices {
        *vertex = (pose * Point3::from(*vertex)).into();
    }
    part
}

fn solid(geometry: &Geometry) -> Option<Mesh> {
    match geometry {
        Geometry::Box { half_extents } => Some(cuboid((*half_extents).into())),
        Geometry::Cylinder {
            radius,
            half_length,
        } => Some(turned(&[
            (0.0, -half_length),
            (*radius, -half_length),
            (*radius, *half_length),
            (0.0, *half_length),
        ])),
        Geometry::Capsule {
            radius,
            half_length,
        } => Some(turned(&capsule_profile(*radius, *half_length))),
        Geometry::Sphere { radius } => Some(turned(&capsule_profile(*radius, 0.0))),
        Geometry::Hull { .. } => None,
    }
}

fn cuboid([x, y, z]: [f64; 3]) -> Mesh {
    let sign = |bit: u32, i: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
    Mesh {
        vertices: (0..8)
            .map(|i| [x * sign(0, i), y * sign(1, i), z * sign(2, i)])
            .collect(),
        triangles: [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ]
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect(),
    }
}

/// (distance from the axis, height) from the bottom to the top.
fn capsule_profile(radius: f64, half_length: f64) -> Vec<(f64, f64)> {
    let arc = |k: u32| std::f64::consts::FRAC_PI_2 * f64::from(k) / f64::from(CAPS);
    let bottom = (0..=CAPS).map(|k| (radius * arc(k).sin(), -half_length - radius * arc(k).cos()));
    let top = (0..=CAPS)
        .rev()
        .map(|k| (radius * arc(k).sin(), half_length + radius * arc(k).cos()));
    bottom.chain(top).collect()
}

/// A profile turned about z.
fn turned(profile: &[(f64, f64)]) -> Mesh {
    let mut mesh = Mesh::default();
    for (radius, z) in profile {
        for k in 0..SIDES {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(SIDES)).sin_cos();
            mesh.vertices.push([radius * cos, radius * sin, *z]);
        }
    }
    for ring in 0..profile.len() as u32 - 1 {
        for k in 0..SIDES {
            let next = (k + 1) % SIDES;
            let (a, b) = (ring * SIDES + k, ring * SIDES + next);
            mesh.triangles.push([a, b, b + SIDES]);
            mesh.triangles.push([a, b + SIDES, a + SIDES]);
        }
    }
    mesh
}
