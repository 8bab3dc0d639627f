//! A convex piece at a pose, and its distances to patches and triangles of the object.

use nalgebra::{Isometry3, Matrix3, Point3, Vector3};

use super::gap::{Gap, Vertex};
use super::piece::ConvexPiece;
use super::tree::Node;

/// A piece and the motion from the centred frame to its own.
pub(super) struct PieceFrame<'a> {
    piece: &'a ConvexPiece,
    object_from_piece: Isometry3<f64>,
    origin: Vector3<f64>,
    piece_from_object: Matrix3<f64>,
}

impl<'a> PieceFrame<'a> {
    pub(super) fn new(piece: &'a ConvexPiece, object_from_piece: &Isometry3<f64>) -> Self {
        PieceFrame {
            piece,
            object_from_piece: *object_from_piece,
            origin: object_from_piece.translation.vector,
            piece_from_object: object_from_piece
                .rotation
                .to_rotation_matrix()
                .matrix()
                .transpose(),
        }
    }

    fn local(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.piece_from_object * (p - self.origin)
    }

    /// Lower and upper bound on the distance to a patch (see [`super::tree`]).
    pub(super) fn bounds(&self, node: &Node) -> (f64, f64) {
        let at = self.piece.distance(&self.local(&node.centre));
        let normal = self.piece_from_object * node.normal;
        let along = at.slope.dot(&normal);
        let across = (at.slope - normal * along).norm();
        let height = if along < 0.0 { node.above } else { -node.below };
        let fall = (along * height - across * node.radius).max(-node.radius);
        (at.lower + fall, at.upper)
    }

    /// Both children with their lower bounds, the nearer first; the distance of a vertex
    /// of each is an upper bound.
    pub(super) fn order(
        &self,
        nodes: &[Node],
        left: usize,
        right: usize,
        gap: &mut Gap,
    ) -> ((f64, usize), (f64, usize)) {
        let mut side = |index: usize| {
            let (low, high) = self.bounds(&nodes[index]);
            if high < gap.upper {
                gap.upper = high.max(0.0);
                gap.on_object = Some(Point3::from(nodes[index].centre));
                gap.near = Some(nodes[index].vertex);
            }
            (low, index)
        };
        let (a, b) = (side(left), side(right));
        if a.0 <= b.0 { (a, b) } else { (b, a) }
    }

    /// Lower bound on the distance to a triangle, from the slope at its middle.
    pub(super) fn triangle_bound(&self, corners: &[Vector3<f64>; 3]) -> f64 {
        let local = corners.each_ref().map(|c| self.local(c));
        let middle = (local[0] + local[1] + local[2]) / 3.0;
        let at = self.piece.distance(&middle);
        let fall = |c: &Vector3<f64>| at.slope.dot(&(c - middle));
        at.lower + local.iter().map(fall).fold(f64::INFINITY, f64::min)
    }

    /// The distance of a triangle next to a vertex of the grid.
    pub(super) fn triangle_gap(&self, corners: &[Vector3<f64>; 3], near: Vertex) -> Gap {
        let local = corners.each_ref().map(|c| self.local(c));
        let (distance, on_triangle) = self.piece.triangle_distance(&local);
        Gap {
            lower: distance,
            upper: distance,
            on_object: on_triangle.map(|p| self.object_from_piece * Point3::from(p)),
            near: Some(near),
        }
    }
}
