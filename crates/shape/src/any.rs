//! A surface of either kind: a member of M^rad or of M^sph.

use std::borrow::Cow;

use nalgebra::{Point3, UnitVector3};
use sph::Direction;

use crate::algebra::SpaceError;
use crate::closed_patch::ClosedPatch;
use crate::mass::MassProperties;
use crate::radial::RadialShape;
use crate::radial_field::RadialField;
use crate::spherical::SphericalShape;
use crate::spherical_field::SphericalField;
use crate::surface::{Differential, Surface};
use crate::triangle_mesh::TriangleMesh;

/// A surface whose validity is proved, of either kind.
#[derive(Clone, Debug)]
pub enum AnyShape {
    /// A member of M^rad.
    Radial(RadialShape),
    /// A member of M^sph.
    Spherical(SphericalShape),
}

/// The same prepared for being read at many points.
#[derive(Clone, Debug)]
pub enum AnyField {
    /// A member of M^rad.
    Radial(Box<RadialField>),
    /// A map of the sphere.
    Spherical(Box<SphericalField>),
}

/// A borrowed surface as collision tests read it.
#[derive(Clone, Copy, Debug)]
pub enum SurfaceRef<'a> {
    /// A member of M^rad.
    Radial(&'a RadialShape),
    /// A map of the sphere.
    Spherical(&'a SphericalField),
}

impl AnyShape {
    /// The degree L of the coefficients.
    pub fn degree(&self) -> usize {
        match self {
            Self::Radial(shape) => shape.degree(),
            Self::Spherical(shape) => shape.degree(),
        }
    }

    /// Volume, centroid and inertia of the enclosed solid.
    pub fn mass_properties(&self) -> &MassProperties {
        match self {
            Self::Radial(shape) => shape.mass_properties(),
            Self::Spherical(shape) => shape.mass_properties(),
        }
    }

    /// The regular (θ,φ) mesh, see [`RadialShape::mesh`].
    pub fn mesh(&self, rows: usize, columns: usize) -> TriangleMesh {
        match self {
            Self::Radial(shape) => shape.mesh(rows, columns),
            Self::Spherical(shape) => shape.mesh(rows, columns),
        }
    }

    /// The radial shape, if it is one.
    pub fn radial(&self) -> Option<&RadialShape> {
        match self {
            Self::Radial(shape) => Some(shape),
            Self::Spherical(_) => None,
        }
    }

    /// The spherical shape, if it is one.
    pub fn spherical(&self) -> Option<&SphericalShape> {
        match self {
            Self::Radial(_) => None,
            Self::Spherical(shape) => Some(shape),
        }
    }

    /// Where the surface closes a hole of the object, centred frame; a radial shape closes none.
    pub fn closed_patches(&self) -> &[ClosedPatch] {
        self.spherical().map_or(&[], |s| s.closed_patches())
    }

    /// Prepares the shape for being read at many points; milliseconds at L = 50.
    pub fn field(&self) -> AnyField {
        match self {
            Self::Radial(shape) => RadialField::new(shape.clone()).into(),
            Self::Spherical(shape) => SphericalField::new(shape).into(),
        }
    }

    fn surface(&self) -> &dyn Surface {
        match self {
            Self::Radial(surface) => surface,
            Self::Spherical(surface) => surface,
        }
    }
}

impl AnyField {
    /// γ(t) = (1−t) f₁ + t f₂: radii where both are radial, else coordinates of maps of the sphere.
    ///
    /// # Errors
    /// Two radial shapes cannot be combined.
    pub fn deformation(from: &Self, to: &Self, t: f64) -> Result<Self, SpaceError> {
        if let (Self::Radial(from), Self::Radial(to)) = (from, to) {
            return RadialField::deformation(from, to, t).map(Self::from);
        }
        let (from, to) = (from.spherical(), to.spherical());
        Ok(SphericalField::deformation(&from, &to, t).into())
    }

    /// The surface as a map of the sphere; for a radial one f = r p.
    pub fn spherical(&self) -> Cow<'_, SphericalField> {
        match self {
            Self::Radial(field) => Cow::Owned(SphericalField::from_radial(field.shape())),
            Self::Spherical(field) => Cow::Borrowed(field),
        }
    }

    /// The radial field, if it is one.
    pub fn radial(&self) -> Option<&RadialField> {
        match self {
            Self::Radial(field) => Some(field),
            Self::Spherical(_) => None,
        }
    }

    /// Where the surface closes a hole of the object, centred frame.
    pub fn closed_patches(&self) -> &[ClosedPatch] {
        match self {
            Self::Radial(_) => &[],
            Self::Spherical(field) => field.closed_patches(),
        }
    }

    /// The surface as collision tests read it.
    pub fn as_surface(&self) -> SurfaceRef<'_> {
        match self {
            Self::Radial(field) => SurfaceRef::Radial(field.shape()),
            Self::Spherical(field) => SurfaceRef::Spherical(field),
        }
    }

    fn surface(&self) -> &dyn Surface {
        match self {
            Self::Radial(surface) => &**surface,
            Self::Spherical(surface) => &**surface,
        }
    }
}

impl SurfaceRef<'_> {
    /// The regular (θ,φ) mesh, see [`RadialShape::mesh`].
    pub fn mesh(&self, rows: usize, columns: usize) -> TriangleMesh {
        match self {
            Self::Radial(shape) => shape.mesh(rows, columns),
            Self::Spherical(field) => field.mesh(rows, columns),
        }
    }

    /// Where the surface closes a hole of the object, centred frame.
    pub fn closed_patches(&self) -> &[ClosedPatch] {
        match self {
            Self::Radial(_) => &[],
            Self::Spherical(field) => field.closed_patches(),
        }
    }

    fn surface(&self) -> &dyn Surface {
        match self {
            Self::Radial(surface) => *surface,
            Self::Spherical(surface) => *surface,
        }
    }
}

impl From<RadialShape> for AnyShape {
    fn from(shape: RadialShape) -> Self {
        Self::Radial(shape)
    }
}

impl From<SphericalShape> for AnyShape {
    fn from(shape: SphericalShape) -> Self {
        Self::Spherical(shape)
    }
}

impl From<RadialField> for AnyField {
    fn from(field: RadialField) -> Self {
        Self::Radial(Box::new(field))
    }
}

impl From<SphericalField> for AnyField {
    fn from(field: SphericalField) -> Self {
        Self::Spherical(Box::new(field))
    }
}

impl<'a> From<&'a RadialShape> for SurfaceRef<'a> {
    fn from(shape: &'a RadialShape) -> Self {
        Self::Radial(shape)
    }
}

impl<'a> From<&'a SphericalField> for SurfaceRef<'a> {
    fn from(field: &'a SphericalField) -> Self {
        Self::Spherical(field)
    }
}

impl<'a> From<&'a AnyField> for SurfaceRef<'a> {
    fn from(field: &'a AnyField) -> Self {
        field.as_surface()
    }
}

impl Surface for AnyShape {
    fn point(&self, p: &Direction) -> Point3<f64> {
        self.surface().point(p)
    }

    fn contact(&self, p: &Direction) -> (Point3<f64>, UnitVector3<f64>) {
        self.surface().contact(p)
    }

    fn differential(&self, p: &Direction) -> Differential {
        self.surface().differential(p)
    }

    fn centre_of_mass(&self) -> Point3<f64> {
        self.surface().centre_of_mass()
    }
}

impl Surface for AnyField {
    fn point(&self, p: &Direction) -> Point3<f64> {
        self.surface().point(p)
    }

    fn contact(&self, p: &Direction) -> (Point3<f64>, UnitVector3<f64>) {
        self.surface().contact(p)
    }

    fn differential(&self, p: &Direction) -> Differential {
        self.surface().differential(p)
    }

    fn centre_of_mass(&self) -> Point3<f64> {
        self.surface().centre_of_mass()
    }
}

impl Surface for SurfaceRef<'_> {
    fn point(&self, p: &Direction) -> Point3<f64> {
        self.surface().point(p)
    }

    fn contact(&self, p: &Direction) -> (Point3<f64>, UnitVector3<f64>) {
        self.surface().contact(p)
    }

    fn differential(&self, p: &Direction) -> Differential {
        self.surface().differential(p)
    }

    fn centre_of_mass(&self) -> Point3<f64> {
        self.surface().centre_of_mass()
    }
}
