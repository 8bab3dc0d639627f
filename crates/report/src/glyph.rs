//! Arrows and friction cones as meshes.

use crate::mesh::Mesh;

/// Number of points around a circle: enough to look round at the size of an arrow.
const SEGMENTS: u32 = 14;

/// An arrow from `tail` to `tip`: a cylinder of `radius` and a head of 2.6 times that.
///
/// A zero-length arrow is an empty mesh.
pub(crate) fn arrow(tail: [f64; 3], tip: [f64; 3], radius: f64) -> Mesh {
    let along = subtract(tip, tail);
    let length = norm(along);
    let mut mesh = Mesh::default();
    if length <= 0.0 {
        return mesh;
    }
    let axis = scale(along, 1.0 / length);
    let head_length = (7.0 * radius).min(0.6 * length);
    let neck = add(tip, scale(axis, -head_length));
    let frame = normal_frame(axis);
    let shaft_start = ring(&mut mesh, tail, frame, radius);
    let shaft_end = ring(&mut mesh, neck, frame, radius);
    bridge(&mut mesh, shaft_start, shaft_end);
    fan(&mut mesh, shaft_start, tail);
    let collar = ring(&mut mesh, neck, frame, 2.6 * radius);
    bridge(&mut mesh, shaft_end, collar);
    // The head has its own rim vertices, so that shading does not smooth the edge.
    let rim = ring(&mut mesh, neck, frame, 2.6 * radius);
    fan(&mut mesh, rim, tip);
    mesh
}

/// The side of a circular cone: apex, unit axis, height along the axis, rim radius.
pub(crate) fn cone(apex: [f64; 3], axis: [f64; 3], height: f64, rim_radius: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let centre = add(apex, scale(axis, height));
    let rim = ring(&mut mesh, centre, normal_frame(axis), rim_radius);
    fan(&mut mesh, rim, apex);
    mesh
}

/// Adds a circle and returns the position of its first vertex.
fn ring(mesh: &mut Mesh, centre: [f64; 3], frame: [[f64; 3]; 2], radius: f64) -> u32 {
    let first = mesh.vertices.len() as u32;
    for k in 0..SEGMENTS {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(SEGMENTS)).sin_cos();
        let offset = add(scale(frame[0], radius * cos), scale(frame[1], radius * sin));
        mesh.vertices.push(add(centre, offset));
    }
    first
}

/// Joins two circles by a band of triangles.
fn bridge(mesh: &mut Mesh, from: u32, to: u32) {
    for k in 0..SEGMENTS {
        let next = (k + 1) % SEGMENTS;
        mesh.triangles.push([from + k, from + next, to + k]);
        mesh.triangles.push([from + next, to + next, to + k]);
    }
}

/// Joins a circle to one point.
fn fan(mesh: &mut Mesh, rim: u32, point: [f64; 3]) {
    let hub = mesh.vertices.len() as u32;
    mesh.vertices.push(point);
    for k in 0..SEGMENTS {
        mesh.triangles
            .push([rim + k, rim + (k + 1) % SEGMENTS, hub]);
    }
}

/// Two unit vectors that span the plane normal to the unit vector `axis`.
fn normal_frame(axis: [f64; 3]) -> [[f64; 3]; 2] {
    // The cross product with the coordinate axis least aligned with `axis` is far from zero.
    let mut reference = [0.0; 3];
    let least = (0..3)
        .min_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs()))
        .unwrap_or(0);
    reference[least] = 1.0;
    let first = cross(axis, reference);
    let first = scale(first, 1.0 / norm(first));
    [first, cross(axis, first)]
}

pub(crate) fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

pub(crate) fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

pub(crate) fn scale(a: [f64; 3], factor: f64) -> [f64; 3] {
    a.map(|v| v * factor)
}

pub(crate) fn norm(a: [f64; 3]) -> f64 {
    a.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrow_reaches_from_tail_to_tip() {
        let mesh = arrow([0.0, 0.0, 1.0], [0.0, 0.0, 5.0], 0.1);
        mesh.check("arrow").unwrap();
        let heights = mesh.vertices.iter().map(|v| v[2]);
        assert!((heights.clone().fold(f64::INFINITY, f64::min) - 1.0).abs() <= 1e-12);
        assert!((heights.fold(0.0, f64::max) - 5.0).abs() <= 1e-12);
        let widest = mesh.vertices.iter().map(|v| v[0].hypot(v[1]));
        assert!((widest.fold(0.0, f64::max) - 0.26).abs() <= 1e-12);
    }

    #[test]
    fn arrow_without_length_is_empty() {
        assert_eq!(arrow([1.0; 3], [1.0; 3], 0.1), Mesh::default());
    }

    #[test]
    fn cone_has_the_given_half_angle() {
        let axis = [0.6, 0.0, 0.8];
        let mesh = cone([0.0; 3], axis, 2.0, 1.0);
        mesh.check("cone").unwrap();
        for rim in &mesh.vertices[..SEGMENTS as usize] {
            let along: f64 = (0..3).map(|i| rim[i] * axis[i]).sum();
            let across = norm(subtract(*rim, scale(axis, along)));
            assert!((along - 2.0).abs() <= 1e-12);
            assert!((across - 1.0).abs() <= 1e-12);
        }
    }
}
