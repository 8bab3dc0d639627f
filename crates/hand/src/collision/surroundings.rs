//! Points that a hand must stay away from: other pieces of the scene, and the scan itself.

use nalgebra::{Isometry3, Point3, Vector3};

use super::piece::{ConvexPiece, LinkShape};

/// Groups of at most this many points are not divided.
const LEAF: usize = 8;

/// Points in a hierarchy of spheres.
#[derive(Clone, Debug, Default)]
pub struct PointTree {
    points: Vec<Point3<f64>>,
    nodes: Vec<Node>,
}

#[derive(Clone, Debug)]
struct Node {
    centre: Point3<f64>,
    radius: f64,
    /// The range of its points.
    first: usize,
    last: usize,
    /// The two halves; none for a leaf.
    halves: Option<(usize, usize)>,
}

impl PointTree {
    /// Sorts points, in the frame in which they are asked for. Costs N log N.
    pub fn new(mut points: Vec<Point3<f64>>) -> Self {
        let mut nodes = Vec::new();
        if !points.is_empty() {
            let count = points.len();
            divide(&mut points, 0, count, &mut nodes);
        }
        PointTree { points, nodes }
    }

    /// Whether it has no points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Whether a point is nearer than `clearance` to a link, or in it; metres.
    pub(crate) fn is_near(&self, link: &LinkShape, pose: &Isometry3<f64>, clearance: f64) -> bool {
        let near = |piece: &ConvexPiece, p: &Vector3<f64>| {
            let bounds = piece.distance(p);
            let exact = || (p - piece.closest_point(p)).norm();
            bounds.lower < clearance && (bounds.upper < clearance || exact() < clearance)
        };
        self.any(link, pose, clearance, near)
    }

    /// Whether a point is in a link, deeper than `depth` below its surface; metres.
    pub(crate) fn is_inside(&self, link: &LinkShape, pose: &Isometry3<f64>, depth: f64) -> bool {
        let inside = |piece: &ConvexPiece, p: &Vector3<f64>| piece.depth(p) > depth;
        self.any(link, pose, 0.0, inside)
    }

    /// Whether a test holds for one of the points that are nearer than `margin` to a piece.
    fn any(
        &self,
        link: &LinkShape,
        pose: &Isometry3<f64>,
        margin: f64,
        test: impl Fn(&ConvexPiece, &Vector3<f64>) -> bool,
    ) -> bool {
        let Some(root) = self.nodes.len().checked_sub(1) else {
            return false;
        };
        link.pieces.iter().any(|piece| {
            let placed = pose * piece.link_from_piece;
            let mut stack = vec![root];
            while let Some(index) = stack.pop() {
                let node = &self.nodes[index];
                let centre = placed.inverse_transform_point(&node.centre).coords;
                if piece.distance(&centre).lower > node.radius + margin {
                    continue;
                }
                match node.halves {
                    Some((left, right)) => stack.extend([left, right]),
                    None => {
                        let points = &self.points[node.first..node.last];
                        let local = |p: &Point3<f64>| placed.inverse_transform_point(p).coords;
                        if points.iter().any(|p| test(piece, &local(p))) {
                            return true;
                        }
                    }
                }
            }
            false
        })
    }
}

/// Adds the node of a range of points, after its halves; its index.
fn divide(points: &mut [Point3<f64>], first: usize, last: usize, nodes: &mut Vec<Node>) -> usize {
    let part = &mut points[first..last];
    let mut low = Vector3::repeat(f64::INFINITY);
    let mut high = Vector3::repeat(f64::NEG_INFINITY);
    for p in part.iter() {
        low = low.inf(&p.coords);
        high = high.sup(&p.coords);
    }
    let centre = Point3::from((low + high) / 2.0);
    let radius = part.iter().map(|p| (p - centre).norm()).fold(0.0, f64::max);
    let halves = if part.len() > LEAF {
        let axis = (high - low).imax();
        let middle = first + part.len() / 2;
        part.select_nth_unstable_by(middle - first, |a, b| a[axis].total_cmp(&b[axis]));
        let left = divide(points, first, middle, nodes);
        Some((left, divide(points, middle, last, nodes)))
    } else {
        None
    };
    nodes.push(Node {
        centre,
        radius,
        first,
        last,
        halves,
    });
    nodes.len() - 1
}

/// What is around and on the object besides its surface, in the centred frame.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// Points of other pieces of the scene.
    pub obstacles: PointTree,
    /// Points of the scan of the object.
    pub cloud: PointTree,
    /// The noise of the scan: how far its points may be outside of the object, metres.
    pub noise: f64,
}

impl Surroundings {
    /// How deep a point of the scan may be in a link, metres, besides its noise.
    pub const DEPTH: f64 = 1e-3;
    /// Links stay at least this far from obstacles, metres.
    pub const CLEARANCE: f64 = 3e-3;

    /// Whether a link is too near to an obstacle.
    pub(crate) fn meets_obstacle(&self, link: &LinkShape, pose: &Isometry3<f64>) -> bool {
        self.obstacles.is_near(link, pose, Self::CLEARANCE)
    }

    /// Whether a link is inside the scan.
    pub(crate) fn holds_scan(&self, link: &LinkShape, pose: &Isometry3<f64>) -> bool {
        self.cloud
            .is_inside(link, pose, Self::DEPTH + 3.0 * self.noise)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Geometry, LinkGeometry};

    fn link(geometry: Geometry) -> LinkShape {
        let placed = LinkGeometry {
            link_from_geometry: Isometry3::translation(0.01, 0.0, 0.0),
            geometry,
        };
        LinkShape::new(vec![ConvexPiece::new(&placed).unwrap()])
    }

    fn points(count: usize) -> Vec<Point3<f64>> {
        let part = |k: usize, step: f64| 0.06 * ((k + 1) as f64 * step).fract() - 0.03;
        let point = |k| Point3::new(part(k, 0.618), part(k, 0.414), part(k, 0.732));
        (0..count).map(point).collect()
    }

    #[test]
    fn the_tree_agrees_with_all_points() {
        let corner = |k: usize| {
            let side = |bit: usize| if k >> bit & 1 == 0 { -0.01 } else { 0.01 };
            Point3::new(side(0), side(1), side(2))
        };
        let forms = [
            Geometry::Box {
                half_extents: Vector3::new(0.01, 0.01, 0.01),
            },
            Geometry::Sphere { radius: 0.012 },
            Geometry::Hull {
                file: String::new(),
                points: (0..8).map(corner).collect(),
            },
        ];
        let mut found = [0; 4];
        for form in forms {
            let link = link(form);
            for k in 0..200 {
                let few = points(k % 40);
                let tree = PointTree::new(few.clone());
                let turn = Vector3::new(0.1 * k as f64, 0.3, 0.0);
                let pose = Isometry3::new(points(k + 1)[k].coords, turn);
                let piece = &link.pieces[0];
                let placed = pose * piece.link_from_piece;
                let local = |p: &Point3<f64>| placed.inverse_transform_point(p).coords;
                let distance = |p: &Point3<f64>| (local(p) - piece.closest_point(&local(p))).norm();
                let near = few.iter().any(|p| distance(p) < 4e-3);
                assert_eq!(tree.is_near(&link, &pose, 4e-3), near);
                let inside = few.iter().any(|p| piece.depth(&local(p)) > 1e-3);
                assert_eq!(tree.is_inside(&link, &pose, 1e-3), inside);
                found[usize::from(near)] += 1;
                found[2 + usize::from(inside)] += 1;
            }
        }
        assert!(found.iter().all(|count| *count > 20), "{found:?}");
    }

    #[test]
    fn depth_is_measured_from_the_nearest_face() {
        let link = link(Geometry::Box {
            half_extents: Vector3::new(0.01, 0.02, 0.03),
        });
        let piece = &link.pieces[0];
        let depth = |x, y, z| piece.depth(&Vector3::new(x, y, z));
        assert!((depth(0.008, 0.0, 0.0) - 0.002).abs() < 1e-12);
        assert!((depth(0.0, 0.0, 0.029) - 0.001).abs() < 1e-12);
        assert_eq!(depth(0.011, 0.0, 0.0), 0.0);
    }
}
