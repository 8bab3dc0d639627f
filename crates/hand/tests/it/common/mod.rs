//! Shapes and plain parry queries that the tests of this crate share.
#![allow(dead_code, unreachable_pub)]

use hand::{Geometry, Hand, HandModel};
use nalgebra::{Isometry3, Vector3};
use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::{Ball, Capsule, ConvexPolyhedron, Cuboid, Cylinder, Shape, TriMesh};
use shape::RadialShape;
use sph::Coefficients;

/// A smooth lump: a sphere with waves of low degree, never far from round.
pub fn lump(radius: f64, waves: &[f64]) -> RadialShape {
    let mut beta = Coefficients::constant(6, radius);
    for (k, w) in waves.iter().enumerate() {
        if let Some(b) = beta.as_mut_slice().get_mut(k + 1) {
            *b = w * radius;
        }
    }
    RadialShape::new(beta).unwrap()
}

/// Something like an ellipsoid of this radius, longer along z by `stretch`.
pub fn egg(radius: f64, stretch: f64) -> RadialShape {
    let mut beta = Coefficients::constant(4, radius);
    beta.as_mut_slice()[6] = stretch * radius;
    RadialShape::new(beta).unwrap()
}

/// The generator of a seed.
pub fn seeded(seed: u64) -> rand_chacha::ChaCha8Rng {
    use rand_chacha::rand_core::SeedableRng;
    rand_chacha::ChaCha8Rng::seed_from_u64(seed)
}

fn vector(v: Vector3<f64>) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn pose(p: &Isometry3<f64>) -> Pose {
    let q = p.rotation.coords;
    Pose::from_parts(
        vector(p.translation.vector),
        Rotation::from_xyzw(q.x, q.y, q.z, q.w),
    )
}

/// The mesh of a surface as parry has it.
pub fn parry_mesh(surface: &RadialShape, rows: usize, columns: usize) -> TriMesh {
    let mesh = surface.mesh(rows, columns);
    let vertices = mesh.vertices.iter().map(|v| vector(v.coords)).collect();
    TriMesh::new(vertices, mesh.triangles).unwrap()
}

/// Every collision piece of a link as parry has it, placed in the frame of the poses.
pub fn link_pieces(
    model: &HandModel,
    link: usize,
    pose_of_link: &Isometry3<f64>,
) -> Vec<(Pose, Box<dyn Shape>)> {
    let y_from_z =
        nalgebra::UnitQuaternion::rotation_between(&Vector3::y(), &Vector3::z()).unwrap();
    model.links()[link]
        .geometry
        .iter()
        .map(|piece| {
            let placed = pose_of_link * piece.link_from_geometry;
            let turned = placed * y_from_z;
            let (at, shape): (_, Box<dyn Shape>) = match &piece.geometry {
                Geometry::Box { half_extents } => {
                    (placed, Box::new(Cuboid::new(vector(*half_extents))))
                }
                Geometry::Cylinder {
                    radius,
                    half_length,
                } => (turned, Box::new(Cylinder::new(*half_length, *radius))),
                Geometry::Capsule {
                    radius,
                    half_length,
                } => (turned, Box::new(Capsule::new_y(*half_length, *radius))),
                Geometry::Sphere { radius } => (placed, Box::new(Ball::new(*radius))),
                Geometry::Hull { points, .. } => {
                    let points: Vec<_> = points.iter().map(|p| vector(p.coords)).collect();
                    let hull = ConvexPolyhedron::from_convex_hull(&points).unwrap();
                    (placed, Box::new(hull))
                }
            };
            (pose(&at), shape)
        })
        .collect()
}

/// Distance of a link to a mesh by parry if it is below `margin`, else `margin`; 0 where they meet.
pub fn link_distance(
    model: &HandModel,
    link: usize,
    pose_of_link: &Isometry3<f64>,
    mesh: &TriMesh,
    margin: f64,
) -> f64 {
    link_pieces(model, link, pose_of_link)
        .iter()
        .map(|(at, piece)| {
            match query::closest_points(at, piece.as_ref(), &Pose::IDENTITY, mesh, margin).unwrap()
            {
                query::ClosestPoints::Intersecting => 0.0,
                query::ClosestPoints::WithinMargin(a, b) => (a - b).length(),
                query::ClosestPoints::Disjoint => margin,
            }
        })
        .fold(margin, f64::min)
}

/// Whether a link meets a mesh, by parry.
pub fn link_meets(
    model: &HandModel,
    link: usize,
    pose_of_link: &Isometry3<f64>,
    mesh: &TriMesh,
) -> bool {
    link_pieces(model, link, pose_of_link)
        .iter()
        .any(|(at, piece)| {
            query::intersection_test(at, piece.as_ref(), &Pose::IDENTITY, mesh)
                .unwrap()
                .intersecting
        })
}

/// Distance of two links by parry.
pub fn links_distance(model: &HandModel, poses: &[Isometry3<f64>], a: usize, b: usize) -> f64 {
    let mut least = f64::INFINITY;
    for (at, piece) in &link_pieces(model, a, &poses[a]) {
        for (there, other) in &link_pieces(model, b, &poses[b]) {
            let gap = query::distance(at, piece.as_ref(), there, other.as_ref()).unwrap();
            least = least.min(gap.distance);
        }
    }
    least
}

/// Poses of all links in the object frame.
pub fn object_from_links(
    hand: &Hand,
    object_from_palm: &Isometry3<f64>,
    joints: &[f64],
) -> Vec<Isometry3<f64>> {
    hand.model()
        .root_from_links(joints)
        .unwrap()
        .into_iter()
        .map(|palm_from_link| object_from_palm * palm_from_link)
        .collect()
}

/// Parameters of a run under the paper's convention about the origin.
pub fn paper_params(hand: &Hand, poses: usize) -> hand::SynthesisParams {
    hand::SynthesisParams {
        poses,
        sampling: hand::PoseSampling::of_hand(hand),
        rules: hand::ClosingRules::default(),
        convention: grasp::Convention::named("paper").unwrap(),
        centre: nalgebra::Point3::origin(),
        tips: hand.tip_model(),
        least_quality: 0.01,
    }
}

/// The same above a support plane.
pub fn on_ground(hand: &Hand, poses: usize, support: shape::Support) -> hand::SynthesisParams {
    let plain = paper_params(hand, poses);
    hand::SynthesisParams {
        rules: hand::ClosingRules {
            support: Some(support),
            ..plain.rules
        },
        sampling: hand::PoseSampling {
            support: Some((support, 3e-3)),
            ..plain.sampling
        },
        ..plain
    }
}
