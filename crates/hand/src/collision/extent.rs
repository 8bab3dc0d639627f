//! Support functions of pieces and links.

use nalgebra::Vector3;
use parry3d_f64::shape::SupportMap;

use super::piece::{ConvexPiece, Form, LinkShape, to_parry};

impl ConvexPiece {
    /// The largest value of `direction` · x over the points x of the piece, both in the link's frame.
    fn extent(&self, direction: &Vector3<f64>) -> f64 {
        let local = to_parry(&self.link_from_piece.inverse_transform_vector(direction));
        let farthest = match &self.form {
            Form::Cuboid(shape) => shape.local_support_point(local),
            Form::Cylinder(shape) => shape.local_support_point(local),
            Form::Capsule(shape) => shape.local_support_point(local),
            Form::Ball(shape) => shape.local_support_point(local),
            Form::Hull(hull) => hull.body.local_support_point(local),
        };
        local.dot(farthest) + direction.dot(&self.link_from_piece.translation.vector)
    }
}

impl LinkShape {
    /// The largest value of `direction` · x over the points x of the link, in its frame; minus infinity
    /// without geometry.
    pub(crate) fn extent(&self, direction: &Vector3<f64>) -> f64 {
        let pieces = self.pieces.iter().map(|piece| piece.extent(direction));
        pieces.fold(f64::NEG_INFINITY, f64::max)
    }
}
