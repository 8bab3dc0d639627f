//! A map of the sphere into space prepared for being read at many scattered points.

use std::sync::Arc;

use nalgebra::{Point3, Rotation3, UnitVector3};
use sph::rotation::rotate;
use sph::{Coefficients, Direction, Field, Jet};

use crate::closed_patch::ClosedPatch;
use crate::crossing::crossing;
use crate::mass;
use crate::radial::RadialShape;
use crate::spherical::{SphericalShape, contact_of, differential_of, mesh_of, radial_coordinates};
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

    /// A radial surface as a map of the sphere: f = r p, of one degree more.
    pub fn from_radial(shape: &RadialShape) -> Self {
        let coordinates = radial_coordinates(shape);
        Self {
            fields: coordinates.each_ref().map(Field::new),
            coordinates,
            centroid: shape.centre_of_mass(),
            closed: Arc::default(),
        }
    }

    /// The same surface with its parameters turned: p ↦ f(R p).
    #[must_use]
    pub fn turned(&self, rotation: &Rotation3<f64>) -> Self {
        let back = rotation.inverse();
        let coordinates = self.coordinates.each_ref().map(|c| rotate(c, &back));
        Self {
            fields: coordinates.each_ref().map(Field::new),
            coordinates,
            ..self.clone()
        }
    }

    /// d(f₁,f₂) = (∫_{S²} |f₁−f₂|²)^{1/2}: the L² distance of the maps, metres.
    pub fn distance(&self, other: &Self) -> f64 {
        let pairs = self.coordinates.iter().zip(&other.coordinates);
        let squares = pairs.map(|(a, b)| a.distance(b).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// γ(t) = (1−t) f₁ + t f₂, coordinate by coordinate. It closes no hole.
    ///
    /// M^sph is not convex: whether γ(t) is an immersion is another question, see
    /// [`SphericalField::crossing`].
    #[must_use]
    pub fn deformation(from: &Self, to: &Self, t: f64) -> Self {
        let pair = |axis: usize| {
            let terms = [
                (1.0 - t, &from.coordinates[axis]),
                (t, &to.coordinates[axis]),
            ];
            Coefficients::combination(terms)
        };
        let coordinates = [pair(0), pair(1), pair(2)];
        let fields = [0, 1, 2].map(|axis: usize| {
            let terms = [(1.0 - t, &from.fields[axis]), (t, &to.fields[axis])];
            // Fields of different degrees share no grid.
            Field::combine(&terms).unwrap_or_else(|_| Field::new(&coordinates[axis]))
        });
        Self {
            fields,
            centroid: mass::spherical(&coordinates).centroid,
            coordinates,
            closed: Arc::default(),
        }
    }

    /// A place, centred frame, where a fine mesh of the surface cuts itself or its area element nearly
    /// vanishes; none is no proof that the surface is embedded. Some tens of milliseconds at L = 50.
    pub fn crossing(&self) -> Option<Point3<f64>> {
        crossing(&self.coordinates)
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
