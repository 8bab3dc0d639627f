//! Places spread evenly over a surface that need not be star-shaped, and points to aim at.

use nalgebra::{Point3, UnitVector3, Vector3};
use rand::{Rng, RngExt};
use shape::{RadialShape, SphericalField, Surface, SurfaceRef};
use sph::Direction;
use sph::direction::{even_directions, tangent_frame};

use crate::collision::{CollisionObject, Crossing};

/// Directions among which places are drawn.
const DIRECTIONS: usize = 4000;
/// Points to aim at are at most this far below the surface, metres.
const DEEPEST: f64 = 0.04;

/// What a hand is aimed at.
#[derive(Debug, Clone)]
pub(super) enum Target<'a> {
    /// The origin, seen from which the surface is star-shaped.
    Radial(&'a RadialShape),
    /// Any part of a surface.
    Spherical(Places<'a>),
}

impl<'a> Target<'a> {
    pub(super) fn of(object: &'a CollisionObject<'a>) -> Self {
        match object.surface() {
            SurfaceRef::Radial(shape) => Self::Radial(shape),
            SurfaceRef::Spherical(field) => Self::Spherical(Places::new(object, field)),
        }
    }

    /// A point to aim at from a direction, and how far from it that way the surface is.
    pub(super) fn aim<R: Rng + ?Sized>(&self, from: &Direction, rng: &mut R) -> (Point3<f64>, f64) {
        match self {
            Self::Radial(shape) => (Point3::origin(), shape.radius(from)),
            Self::Spherical(places) => {
                let aim = places.aim(rng);
                (aim, places.outside(&aim, from, rng))
            }
        }
    }
}

/// Places of a surface, drawn in proportion to the area around each.
#[derive(Debug, Clone)]
pub(super) struct Places<'a> {
    object: &'a CollisionObject<'a>,
    field: &'a SphericalField,
    places: Vec<(Point3<f64>, UnitVector3<f64>)>,
    /// Areas up to each place, added up.
    sums: Vec<f64>,
}

impl<'a> Places<'a> {
    /// Parts that close holes have no places.
    fn new(object: &'a CollisionObject<'a>, field: &'a SphericalField) -> Self {
        let (mut places, mut sums, mut sum) = (Vec::new(), Vec::new(), 0.0);
        for p in even_directions(DIRECTIONS) {
            let at = field.differential(&p);
            if object.is_closed_hole(&at.position) {
                continue;
            }
            let (u, v) = tangent_frame(&p);
            let slope = at.position_slope;
            sum += (slope * u).cross(&(slope * v)).norm();
            places.push((at.position, at.inward_normal));
            sums.push(sum);
        }
        Places {
            object,
            field,
            places,
            sums,
        }
    }

    /// A place and the inward normal there; none where all of the surface closes holes.
    pub(super) fn draw<R: Rng + ?Sized>(
        &self,
        rng: &mut R,
    ) -> Option<(Point3<f64>, UnitVector3<f64>)> {
        let share: f64 = rng.random_range(0.0..1.0);
        let wanted = share * self.sums.last()?;
        let index = self.sums.partition_point(|sum| *sum <= wanted);
        self.places.get(index).copied()
    }

    /// The surface.
    pub(super) fn field(&self) -> &'a SphericalField {
        self.field
    }

    /// The inward normal at a crossing; none on a part that closes a hole.
    pub(super) fn normal_at(&self, crossing: &Crossing) -> Option<UnitVector3<f64>> {
        let (place, inward) = self.field.contact(&crossing.direction);
        (!self.object.is_closed_hole(&place)).then_some(inward)
    }

    /// A point to aim at: the middle of the object as often as a point half-way through it below a place.
    pub(super) fn aim<R: Rng + ?Sized>(&self, rng: &mut R) -> Point3<f64> {
        let drawn = self.draw(rng);
        if rng.random_bool(0.5) {
            return Point3::origin();
        }
        let Some((place, inward)) = drawn else {
            return Point3::origin();
        };
        let through = self.exit(&place, &inward, 2.0 * DEEPEST);
        place + inward.into_inner() * through.map_or(DEEPEST, |c| 0.5 * c.along)
    }

    /// How far along a line from a point the surface is left, at one of the places where it is; 0 where
    /// the line meets nothing.
    pub(super) fn outside<R: Rng + ?Sized>(
        &self,
        from: &Point3<f64>,
        way: &Vector3<f64>,
        rng: &mut R,
    ) -> f64 {
        let longest = 2.0 * (self.object.outer_radius() + from.coords.norm());
        let mut crossings = self.object.crossings(from, way, longest);
        crossings.retain(|c| c.leaving);
        let which = rng.random_range(0..crossings.len().max(1));
        crossings.get(which).map_or(0.0, |c| c.along)
    }

    /// The first exit, within `longest`, of a line that starts on the surface or inside it.
    pub(super) fn exit(
        &self,
        start: &Point3<f64>,
        way: &Vector3<f64>,
        longest: f64,
    ) -> Option<Crossing> {
        // Facets are not quite where the surface is.
        let skipped = 4.0 * self.object.mesh_error();
        let mut crossings = self.object.crossings(start, way, longest);
        crossings.retain(|c| c.along > skipped);
        crossings.first().filter(|c| c.leaving).copied()
    }
}
