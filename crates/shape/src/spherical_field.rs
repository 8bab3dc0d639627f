//! A map of the sphere into space prepared for being read at many scattered points.

use std::sync::Arc;

use nalgebra::{Point3, UnitVector3};
use sph::{Coefficients, Direction, Field, Jet};

use crate::closed_patch::ClosedPatch;
use crate::spherical::{SphericalShape, contact_of, differential_of, mesh_of};
use crate::surface::{Differential, Surface};
use crate::triangle_mesh::TriangleMesh;

/// A [`SphericalShape`] whose f, ∇f and ∇²f come from three [`Field`]s that are read at once.
///
/// The same surface to about 1e-12 of its size; a read of all derivatives takes less than a
/// microsecond at L = 50.
#[derive(Clone, Debug)]
pub struct SphericalField {
    coordinates: [Coefficients; 3],
    fields: [Field; 3],
    centroid: Point3<f64>,
    closed: Arc<[ClosedPatch]>,
}

impl SphericalField {
    /// Prepares a shape; some ten milliseconds at L = 50.
    pub fn new(shape: &SphericalShape) -> Self {
        Self {
            coordinates: shape.coordinates().clone(),
            fields: shape.coordinates().each_ref().map(Field::new),
            centroid: shape.centre_of_mass(),
            closed: shape.shared_closed_patches(),
        }
    }

    /// The coefficients β of x, y and z, all of one degree.
    pub fn coordinates(&self) -> &[Coefficients; 3] {
        &self.coordinates
    }

    /// Where the surface closes a hole of the object, centred frame.
    pub fn closed_patches(&self) -> &[ClosedPatch] {
        &self.closed
    }

    /// The regular (θ,φ) mesh, as [`SphericalShape::mesh`].
    pub fn mesh(&self, rows: usize, columns: usize) -> TriangleMesh {
        mesh_of(&self.coordinates, rows, columns)
    }

    fn jets(&self, p: &Direction) -> [Jet; 3] {
        let fields = self.fields.each_ref();
        // All three have one degree.
        Field::jets(fields, p).unwrap_or_else(|_| fields.map(|f| f.jet(p)))
    }
}

impl Surface for SphericalField {
    fn point(&self, p: &Direction) -> Point3<f64> {
        let fields = self.fields.each_ref();
        let values = Field::values(fields, p).unwrap_or_else(|_| fields.map(|f| f.value(p)));
        Point3::from(values)
    }

    fn contact(&self, p: &Direction) -> (Point3<f64>, UnitVector3<f64>) {
        contact_of(p, &self.jets(p))
    }

    fn differential(&self, p: &Direction) -> Differential {
        differential_of(p, &self.jets(p))
    }

    fn centre_of_mass(&self) -> Point3<f64> {
        self.centroid
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use sph::direction::even_directions;

    #[test]
    fn the_field_is_the_shape() {
        let coordinates = [0, 1, 2].map(|axis| {
            let mut beta = Coefficients::zeros(30);
            for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(4) {
                let (l, _) = sph::index::degree_order(i);
                *b = 0.004 * (i as f64 * 1.9 + axis as f64).sin() / (1.0 + l as f64).powi(3);
            }
            beta.as_mut_slice()[[3, 1, 2][axis]] = 0.08;
            beta
        });
        let [x, y, z] = coordinates;
        let shape = SphericalShape::new(x, y, z).unwrap();
        let field = SphericalField::new(&shape);
        let mut points = even_directions(200);
        points.extend([Vector3::z_axis(), -Vector3::z_axis(), Vector3::x_axis()]);
        for p in points {
            let (a, b) = (field.differential(&p), shape.differential(&p));
            assert!((field.point(&p) - shape.point(&p)).norm() <= 1e-12);
            assert!((a.position - b.position).norm() <= 1e-12);
            assert!((a.inward_normal.into_inner() - b.inward_normal.into_inner()).norm() <= 1e-9);
            assert!((a.position_slope - b.position_slope).norm() <= 1e-10);
            assert!((a.normal_slope - b.normal_slope).norm() <= 1e-7);
            assert_eq!(field.contact(&p), (a.position, a.inward_normal));
        }
        assert_eq!(field.mesh(9, 16), shape.mesh(9, 16));
    }
}
