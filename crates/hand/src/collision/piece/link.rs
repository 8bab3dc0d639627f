//! The pieces of one link, with a sphere around them.

use nalgebra::{Isometry3, Point3, Vector3};
use shape::TriangleMesh;

use super::{ConvexPiece, from_parry};

/// The pieces of one link and a sphere around them.
#[derive(Debug, Clone)]
pub(crate) struct LinkShape {
    pub(crate) pieces: Vec<ConvexPiece>,
    /// Centre of the sphere in the link frame.
    pub(crate) centre: Point3<f64>,
    pub(crate) radius: f64,
}

impl LinkShape {
    pub(crate) fn new(pieces: Vec<ConvexPiece>) -> Self {
        let count = pieces.len().max(1) as f64;
        let centre = pieces
            .iter()
            .map(|p| p.link_from_piece.translation.vector)
            .sum::<Vector3<f64>>()
            / count;
        let radius = pieces
            .iter()
            .map(|p| (p.link_from_piece.translation.vector - centre).norm() + p.radius)
            .fold(0.0, f64::max);
        LinkShape {
            pieces,
            centre: Point3::from(centre),
            radius,
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// The vector from the nearest point of any piece to `p`, in the frame of the pose; zero
    /// inside.
    pub(crate) fn offset_to(&self, pose: &Isometry3<f64>, p: &Point3<f64>) -> Vector3<f64> {
        let offsets = self.pieces.iter().map(|piece| {
            let placed = pose * piece.link_from_piece;
            let local = placed.inverse_transform_point(p).coords;
            placed * (local - piece.closest_point(&local))
        });
        offsets
            .min_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
            .unwrap_or_else(Vector3::zeros)
    }

    /// All pieces as one mesh in the frame of the pose.
    pub(crate) fn mesh(&self, pose: &Isometry3<f64>) -> TriangleMesh {
        let mut mesh = TriangleMesh {
            vertices: Vec::new(),
            triangles: Vec::new(),
        };
        for piece in &self.pieces {
            let placed = pose * piece.link_from_piece;
            let (vertices, triangles) = piece.triangles();
            let first = mesh.vertices.len() as u32;
            let moved = vertices
                .iter()
                .map(|v| placed * Point3::from(from_parry(*v)));
            mesh.vertices.extend(moved);
            mesh.triangles
                .extend(triangles.iter().map(|t| t.map(|v| v + first)));
        }
        mesh
    }

    /// A bound on the distance of any point of the link from the link's origin.
    pub(crate) fn reach(&self) -> f64 {
        self.pieces
            .iter()
            .map(|p| p.link_from_piece.translation.vector.norm() + p.radius)
            .fold(0.0, f64::max)
    }
}
