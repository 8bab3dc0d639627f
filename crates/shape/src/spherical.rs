//! Members of M^sph: surfaces whose three coordinates are functions on the sphere.

use std::sync::Arc;

use nalgebra::{Matrix3, Point3, UnitVector3, Vector3};
use sph::grid::{GridValues, RingGrid};
use sph::{Basis, Coefficients, Direction, Jet};

use crate::closed_patch::ClosedPatch;
use crate::immersion::{self, Immersion, SphericalError};
use crate::injectivity::{self, Embedding};
use crate::mass::{self, MassProperties};
use crate::normals::grid_directions;
use crate::radial::RadialShape;
use crate::surface::{Differential, Surface};
use crate::triangle_mesh::TriangleMesh;

/// A proved immersion f = (x, y, z): S² → R³ with coordinates of degree ≤ L (the paper's M^sph).
///
/// Coordinates in metres, in the centred frame; the normal f_u × f_v points outward. An immersion
/// may touch itself; see [`SphericalShape::embedding`].
#[derive(Clone, Debug)]
pub struct SphericalShape {
    coordinates: [Coefficients; 3],
    basis: Basis,
    immersion: Immersion,
    mass: MassProperties,
    closed: Arc<[ClosedPatch]>,
}

impl SphericalShape {
    /// Proves that f_u × f_v vanishes nowhere ([`Immersion`]) and computes the mass properties.
    ///
    /// Degrees may differ; all are filled up to the highest. Cost: usually less than a second at L
    /// = 50, and a few seconds where the proof fails.
    pub fn new(x: Coefficients, y: Coefficients, z: Coefficients) -> Result<Self, SphericalError> {
        let degree = x.degree().max(y.degree()).max(z.degree());
        let coordinates = [x, y, z].map(|c| c.with_degree(degree));
        let immersion = immersion::certify(&coordinates)?;
        let mass = mass::spherical(&coordinates);
        if mass.volume > 0.0 {
            Ok(Self {
                basis: Basis::new(degree),
                coordinates,
                immersion,
                mass,
                closed: Arc::default(),
            })
        } else {
            Err(SphericalError::InsideOut {
                volume: mass.volume,
            })
        }
    }

    /// The same surface, of which these parts close holes of the object; centred frame.
    #[must_use]
    pub fn with_closed_patches(self, patches: Vec<ClosedPatch>) -> Self {
        Self {
            closed: patches.into(),
            ..self
        }
    }

    /// Where the surface closes a hole of the object, centred frame.
    pub fn closed_patches(&self) -> &[ClosedPatch] {
        &self.closed
    }

    pub(crate) fn shared_closed_patches(&self) -> Arc<[ClosedPatch]> {
        Arc::clone(&self.closed)
    }

    /// The same surface as a member of M^sph: f = r p, of one degree more.
    pub fn from_radial(shape: &RadialShape) -> Result<Self, SphericalError> {
        let [x, y, z] = radial_coordinates(shape);
        Self::new(x, y, z)
    }

    /// The coefficients β of x, y and z, all of one degree.
    pub fn coordinates(&self) -> &[Coefficients; 3] {
        &self.coordinates
    }

    /// The degree L of the coefficients.
    pub fn degree(&self) -> usize {
        self.basis.degree()
    }

    /// The proof that the surface is an immersion.
    pub fn immersion(&self) -> Immersion {
        self.immersion
    }

    /// Tries to prove that the surface does not touch itself; about a second at L = 50.
    pub fn embedding(&self) -> Embedding {
        injectivity::certify(&self.coordinates)
    }

    /// Volume, centroid and inertia of the enclosed solid.
    pub fn mass_properties(&self) -> &MassProperties {
        &self.mass
    }

    /// d(f₁,f₂) = (∫_{S²} |f₁−f₂|²)^{1/2}: the L² distance of the maps, metres.
    pub fn distance(&self, other: &Self) -> f64 {
        let pairs = self.coordinates.iter().zip(&other.coordinates);
        pairs
            .map(|(a, b)| a.distance(b).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// The regular (θ,φ) mesh, as [`RadialShape::mesh`].
    pub fn mesh(&self, rows: usize, columns: usize) -> TriangleMesh {
        mesh_of(&self.coordinates, rows, columns)
    }

    fn jets(&self, p: &Direction) -> [Jet; 3] {
        let mut work = self.basis.workspace();
        let coordinates = self.coordinates.each_ref();
        coordinates.map(|c| self.basis.jet(c, p, &mut work))
    }
}

/// The coordinates of f = r p, of one degree more than r.
pub(crate) fn radial_coordinates(shape: &RadialShape) -> [Coefficients; 3] {
    let degree = shape.degree() + 1;
    let grid = RingGrid::gauss_legendre(degree + 1, 2 * degree + 1);
    let radii = grid.synthesis(shape.coefficients());
    let directions = grid_directions(&grid);
    std::array::from_fn(|axis| {
        let values = radii.values.iter().zip(&directions);
        let values = GridValues {
            longitudes: radii.longitudes,
            values: values.map(|(r, p)| r * p[axis]).collect(),
        };
        grid.analysis(&values, degree)
    })
}

/// The regular (θ,φ) mesh of a map.
pub(crate) fn mesh_of(
    coordinates: &[Coefficients; 3],
    rows: usize,
    columns: usize,
) -> TriangleMesh {
    let grid = RingGrid::equiangular(rows, columns);
    let [x, y, z] = coordinates.each_ref().map(|c| grid.synthesis(c).values);
    let points = x.iter().zip(&y).zip(&z);
    let points = points.map(|((x, y), z)| Point3::new(*x, *y, *z)).collect();
    TriangleMesh::from_ring_points(rows, columns, points)
}

/// Rows of df at p from the three jets.
fn slope(jets: &[Jet; 3]) -> Matrix3<f64> {
    Matrix3::from_rows(&jets.each_ref().map(|j| j.gradient.transpose()))
}

fn position(jets: &[Jet; 3]) -> Point3<f64> {
    Point3::new(jets[0].value, jets[1].value, jets[2].value)
}

/// Inward unit normal −f_u × f_v / |f_u × f_v| and the length, over a frame (u, v, p).
fn inward_normal(
    slope: &Matrix3<f64>,
    (u, v): &(Vector3<f64>, Vector3<f64>),
) -> (UnitVector3<f64>, f64) {
    UnitVector3::new_and_get((slope * v).cross(&(slope * u)))
}

/// Position and inward normal from the three jets.
pub(crate) fn contact_of(p: &Direction, jets: &[Jet; 3]) -> (Point3<f64>, UnitVector3<f64>) {
    let frame = sph::direction::tangent_frame(p);
    (position(jets), inward_normal(&slope(jets), &frame).0)
}

/// The whole differential from the three jets.
pub(crate) fn differential_of(p: &Direction, jets: &[Jet; 3]) -> Differential {
    let slope = slope(jets);
    let frame = sph::direction::tangent_frame(p);
    let (normal, length) = inward_normal(&slope, &frame);
    // The frame (u, v) is parallel transported, so that along w the derivative of f_u is Hess f (w,
    // u), coordinate by coordinate.
    let bend = |w: &Vector3<f64>, u: &Vector3<f64>| {
        Vector3::from(jets.each_ref().map(|j| w.dot(&(j.hessian * u))))
    };
    let (u, v) = frame;
    let (fu, fv) = (slope * u, slope * v);
    let turn = |w: &Vector3<f64>| bend(w, &v).cross(&fu) + fv.cross(&bend(w, &u));
    let raw = turn(&u) * u.transpose() + turn(&v) * v.transpose();
    let unit = normal.into_inner();
    let across = Matrix3::identity() - unit * unit.transpose();
    Differential {
        position: position(jets),
        inward_normal: normal,
        position_slope: slope,
        normal_slope: across * raw / length,
    }
}

impl Surface for SphericalShape {
    fn point(&self, p: &Direction) -> Point3<f64> {
        let mut work = self.basis.workspace();
        let [x, y, z] = self.coordinates.each_ref();
        let mut sum = |c| self.basis.sum(c, p, &mut work);
        Point3::new(sum(x), sum(y), sum(z))
    }

    fn contact(&self, p: &Direction) -> (Point3<f64>, UnitVector3<f64>) {
        contact_of(p, &self.jets(p))
    }

    fn differential(&self, p: &Direction) -> Differential {
        differential_of(p, &self.jets(p))
    }

    fn centre_of_mass(&self) -> Point3<f64> {
        self.mass.centroid
    }
}
