//! One convex piece of a hand: bounds in closed form, and parry's shape for exact queries.

use nalgebra::{Isometry3, UnitQuaternion, UnitVector3, Vector3};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::{Ball, Capsule, Cuboid, Cylinder, Shape, Triangle};

use crate::model::{Geometry, LinkGeometry};

mod hull;
mod link;

pub use hull::GeometryError;
use hull::Hull;
pub(crate) use hull::check_hull;
pub(crate) use link::LinkShape;

#[derive(Debug, Clone)]
pub(super) enum Form {
    Cuboid(Cuboid),
    /// With the axis y, as in parry.
    Cylinder(Cylinder),
    /// With the axis y.
    Capsule(Capsule),
    Ball(Ball),
    Hull(Box<Hull>),
}

/// Bounds on the distance of a point from a piece, with the slope of the lower one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointDistance {
    pub(crate) lower: f64,
    pub(crate) upper: f64,
    /// Gradient of the lower bound, a unit vector outside the piece.
    pub(crate) slope: Vector3<f64>,
}

/// A convex piece in its own frame, placed in a link.
#[derive(Debug, Clone)]
pub(crate) struct ConvexPiece {
    pub(crate) link_from_piece: Isometry3<f64>,
    pub(super) form: Form,
    /// Radius of the sphere about the origin of the piece that contains it.
    pub(crate) radius: f64,
}

impl ConvexPiece {
    pub(crate) fn new(placed: &LinkGeometry) -> Result<Self, GeometryError> {
        Self::within(placed, f64::INFINITY)
    }

    /// The piece with a hull that extends beyond its mesh by at most `excess`, metres, where the largest
    /// number of vertices allows.
    pub(crate) fn within(placed: &LinkGeometry, excess: f64) -> Result<Self, GeometryError> {
        let along_y =
            UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2);
        let mut link_from_piece = placed.link_from_geometry;
        let (form, radius) = match &placed.geometry {
            Geometry::Box { half_extents } => (
                Form::Cuboid(Cuboid::new(to_parry(half_extents))),
                half_extents.norm(),
            ),
            &Geometry::Cylinder {
                radius,
                half_length,
            } => {
                link_from_piece *= along_y;
                (
                    Form::Cylinder(Cylinder::new(half_length, radius)),
                    radius.hypot(half_length),
                )
            }
            &Geometry::Capsule {
                radius,
                half_length,
            } => {
                link_from_piece *= along_y;
                (
                    Form::Capsule(Capsule::new_y(half_length, radius)),
                    radius + half_length,
                )
            }
            &Geometry::Sphere { radius } => (Form::Ball(Ball::new(radius)), radius),
            Geometry::Hull { points, .. } => {
                let (hull, centre) = Hull::of_points(points, excess)?;
                link_from_piece *= nalgebra::Translation3::from(centre.coords);
                let radius = hull.radius();
                (Form::Hull(Box::new(hull)), radius)
            }
        };
        Ok(ConvexPiece {
            link_from_piece,
            form,
            radius,
        })
    }

    /// The distance of a point (piece frame) from the piece, with its gradient.
    ///
    /// Exact except for hulls, whose lower bound comes from their supporting planes. Inside the
    /// piece both bounds are 0 (for a hull the lower one) and the slope vanishes.
    pub(crate) fn distance(&self, p: &Vector3<f64>) -> PointDistance {
        let exact = |nearest: Vector3<f64>| {
            let away = p - nearest;
            let distance = away.norm();
            let slope = if distance > 0.0 {
                away / distance
            } else {
                away
            };
            PointDistance {
                lower: distance,
                upper: distance,
                slope,
            }
        };
        let rounded = |spine: Vector3<f64>, radius: f64| {
            let away = p - spine;
            let distance = away.norm();
            exact(if distance > radius {
                spine + away * (radius / distance)
            } else {
                *p
            })
        };
        match &self.form {
            Form::Cuboid(c) => exact(clamp_to_box(p, &from_parry(c.half_extents))),
            Form::Cylinder(c) => {
                let radial = (p.x * p.x + p.z * p.z).sqrt();
                let scale = if radial > c.radius {
                    c.radius / radial
                } else {
                    1.0
                };
                let axial = p.y.clamp(-c.half_height, c.half_height);
                exact(Vector3::new(p.x * scale, axial, p.z * scale))
            }
            Form::Capsule(c) => {
                let half = c.segment.b.y.abs();
                rounded(Vector3::new(0.0, p.y.clamp(-half, half), 0.0), c.radius)
            }
            Form::Ball(b) => rounded(Vector3::zeros(), b.radius),
            Form::Hull(hull) => hull.distance(p),
        }
    }

    fn shape(&self) -> &dyn Shape {
        match &self.form {
            Form::Cuboid(s) => s,
            Form::Cylinder(s) => s,
            Form::Capsule(s) => s,
            Form::Ball(s) => s,
            Form::Hull(s) => &s.body,
        }
    }

    /// Exact distance to a triangle in the piece frame and the closest point of the triangle; (0,
    /// `None`) where they overlap.
    pub(crate) fn triangle_distance(
        &self,
        corners: &[Vector3<f64>; 3],
    ) -> (f64, Option<Vector3<f64>>) {
        let [a, b, c] = corners.each_ref().map(to_parry);
        let triangle = Triangle::new(a, b, c);
        let found = query::closest_points(
            &Pose::IDENTITY,
            self.shape(),
            &Pose::IDENTITY,
            &triangle,
            f64::MAX,
        );
        match found {
            Ok(query::ClosestPoints::WithinMargin(p, q)) => ((p - q).length(), Some(from_parry(q))),
            _ => (0.0, None),
        }
    }

    /// The point of the piece closest to a point outside it, both in the piece frame.
    pub(crate) fn closest_point(&self, p: &Vector3<f64>) -> Vector3<f64> {
        from_parry(self.shape().project_local_point(to_parry(p), true).point)
    }

    /// A bound on how far the piece extends beyond the geometry that it stands for, metres.
    pub(crate) fn excess(&self) -> f64 {
        match &self.form {
            Form::Hull(hull) => hull.excess,
            _ => 0.0,
        }
    }

    /// How deep a point (piece frame) is below the surface of the piece; 0 outside.
    pub(super) fn depth(&self, p: &Vector3<f64>) -> f64 {
        let found = self.shape().project_local_point(to_parry(p), false);
        if found.is_inside {
            (from_parry(found.point) - p).norm()
        } else {
            0.0
        }
    }

    /// Vertices (piece frame) and triangles; round parts have 24 sides.
    fn triangles(&self) -> (Vec<Vector>, Vec<[u32; 3]>) {
        match &self.form {
            Form::Cuboid(s) => s.to_trimesh(),
            Form::Cylinder(s) => s.to_trimesh(24),
            Form::Capsule(s) => s.to_trimesh(24, 12),
            Form::Ball(s) => s.to_trimesh(24, 12),
            Form::Hull(s) => s.body.to_trimesh(),
        }
    }

    /// Distance to any shape of parry that is at rest in the world.
    #[cfg(test)]
    pub(crate) fn shape_distance(
        &self,
        world_from_self: &Isometry3<f64>,
        other: &dyn Shape,
    ) -> f64 {
        query::distance(&pose(world_from_self), self.shape(), &Pose::IDENTITY, other)
            .map_or(f64::NAN, |d| d.distance)
    }

    /// Distance to another piece, 0 where they overlap.
    pub(crate) fn piece_distance(
        &self,
        world_from_self: &Isometry3<f64>,
        other: &ConvexPiece,
        world_from_other: &Isometry3<f64>,
    ) -> f64 {
        query::distance(
            &pose(world_from_self),
            self.shape(),
            &pose(world_from_other),
            other.shape(),
        )
        .map_or(0.0, |d| d.distance)
    }
}

fn clamp_to_box(p: &Vector3<f64>, half: &Vector3<f64>) -> Vector3<f64> {
    p.zip_map(half, |c, h| c.clamp(-h, h))
}

/// Converts a vector of nalgebra to one of parry.
pub(crate) fn to_parry(v: &Vector3<f64>) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn from_parry(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

fn pose(p: &Isometry3<f64>) -> Pose {
    let q = p.rotation.coords;
    Pose::from_parts(
        to_parry(&p.translation.vector),
        parry3d_f64::math::Rotation::from_xyzw(q.x, q.y, q.z, q.w),
    )
}

/// The direction of a vector; z if it vanishes.
pub(crate) fn direction_or_z(v: &Vector3<f64>) -> UnitVector3<f64> {
    UnitVector3::try_new(*v, 0.0).unwrap_or(Vector3::z_axis())
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;

    /// Beyond edges and corners the planes of the faces alone underestimate the distance by a
    /// third, so that searches that prune by them visit a large part of the object's mesh.
    #[test]
    fn the_lower_bound_of_a_hull_is_tight_beyond_its_edges() {
        let corner = |k: usize| {
            let side = |bit: usize| if k >> bit & 1 == 0 { -0.01 } else { 0.01 };
            Point3::new(side(0), side(1), 2.0 * side(2))
        };
        let placed = LinkGeometry {
            link_from_geometry: Isometry3::identity(),
            geometry: Geometry::Hull {
                file: String::new(),
                points: (0..8).map(corner).collect(),
            },
        };
        let piece = ConvexPiece::new(&placed).unwrap();
        for direction in sph::direction::even_directions(200) {
            let p = direction.into_inner() * 0.06;
            let exact = (p - piece.closest_point(&p)).norm();
            let bound = piece.distance(&p);
            assert!(bound.lower <= exact + 1e-12 && exact <= bound.upper + 1e-12);
            assert!(bound.lower >= 0.92 * exact, "{} of {exact}", bound.lower);
        }
    }
}
