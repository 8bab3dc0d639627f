//! A hierarchy of surface patches, each with a sphere and a slab around it.
//!
//! A patch lies in the sphere of radius ρ about one of its own vertices c, and below
//! the plane n·x = top, n being its mean outward normal. With d(c) the signed distance
//! of c from a convex piece K, dist(K, patch) is at most d(c), at least d(c) − ρ, and
//! at least min_K n·x − top. Where the surface is smooth the nearest patch has its
//! normal along the line to K, so the second bound is good to second order in the
//! patch's size and few patches survive.

use nalgebra::{Point3, Vector3};

use super::piece::direction_or_z;

/// Triangles in a leaf.
const LEAF_TRIANGLES: usize = 4;

/// What a node holds.
#[derive(Debug, Clone, Copy)]
pub(super) enum Content {
    /// Triangles of this range.
    Leaf { first: usize, end: usize },
    /// Two nodes.
    Inner { left: usize, right: usize },
}

/// A patch of the surface.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) centre: Vector3<f64>,
    pub(super) radius: f64,
    pub(super) normal: Vector3<f64>,
    pub(super) top: f64,
    pub(super) content: Content,
}

/// The triangles in the order of the leaves, and the nodes with the root first.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) triangles: Vec<[Vector3<f64>; 3]>,
}

impl Tree {
    /// Builds the hierarchy of a star-shaped surface about the origin.
    ///
    /// Triangles without area are dropped. O(n log n).
    pub(super) fn new(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> Self {
        let mut corners: Vec<[Vector3<f64>; 3]> = triangles
            .iter()
            .map(|t| t.map(|v| vertices[v as usize].coords))
            .filter(|t| double_area(t).norm() > 0.0)
            .collect();
        let mut nodes = Vec::with_capacity(corners.len());
        if !corners.is_empty() {
            let count = corners.len();
            build(&mut nodes, &mut corners, 0, count);
        }
        Tree {
            nodes,
            triangles: corners,
        }
    }
}

fn double_area(t: &[Vector3<f64>; 3]) -> Vector3<f64> {
    (t[1] - t[0]).cross(&(t[2] - t[0]))
}

/// Appends the node of triangles first..end and everything below it; returns its index.
fn build(
    nodes: &mut Vec<Node>,
    triangles: &mut [[Vector3<f64>; 3]],
    first: usize,
    end: usize,
) -> usize {
    let index = nodes.len();
    nodes.push(patch(&triangles[first..end], first, end));
    if end - first > LEAF_TRIANGLES {
        let axis = longest_axis(&triangles[first..end]);
        let middle = (end - first) / 2;
        triangles[first..end].select_nth_unstable_by(middle, |a, b| {
            let key = |t: &[Vector3<f64>; 3]| t[0][axis] + t[1][axis] + t[2][axis];
            key(a).total_cmp(&key(b))
        });
        let left = build(nodes, triangles, first, first + middle);
        let right = build(nodes, triangles, first + middle, end);
        nodes[index].content = Content::Inner { left, right };
    }
    index
}

fn patch(triangles: &[[Vector3<f64>; 3]], first: usize, end: usize) -> Node {
    let mut mean = Vector3::zeros();
    let mut normal = Vector3::zeros();
    for t in triangles {
        mean += t[0] + t[1] + t[2];
        let area = double_area(t);
        // The surface is star-shaped about the origin, so outward is away from it.
        normal += area * area.dot(&t[0]).signum();
    }
    mean /= 3.0 * triangles.len() as f64;
    let normal = direction_or_z(&normal).into_inner();
    let corners = || triangles.iter().flatten();
    let nearest = |best: Vector3<f64>, v: &Vector3<f64>| {
        if (v - mean).norm_squared() < (best - mean).norm_squared() {
            *v
        } else {
            best
        }
    };
    let centre = corners().fold(triangles[0][0], nearest);
    Node {
        radius: corners().map(|v| (v - centre).norm()).fold(0.0, f64::max),
        top: corners().map(|v| normal.dot(v)).fold(f64::NEG_INFINITY, f64::max),
        centre,
        normal,
        content: Content::Leaf { first, end },
    }
}

fn longest_axis(triangles: &[[Vector3<f64>; 3]]) -> usize {
    let start = triangles[0][0];
    let (low, high) = triangles
        .iter()
        .flatten()
        .fold((start, start), |(low, high), v| (low.inf(v), high.sup(v)));
    (high - low).imax()
}
