//! One convex piece of a hand: bounds in closed form, and parry's shape for exact queries.

use nalgebra::{Isometry3, Point3, UnitQuaternion, UnitVector3, Vector3};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::{Ball, Capsule, ConvexPolyhedron, Cuboid, Cylinder, Shape, Triangle};
use shape::TriangleMesh;
use thiserror::Error;

use crate::model::{Geometry, LinkGeometry};

/// Extents of a hull below this (metres) count as flat.
const LEAST_HULL_THICKNESS: f64 = 1e-6;
/// Hulls of more points are simplified to the extreme ones in this many directions.
const HULL_DIRECTIONS: usize = 96;
/// Planes that bound a hull besides those of its faces.
const BOUND_DIRECTIONS: usize = 96;

/// Why geometry cannot take part in collision tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum GeometryError {
    /// A mesh without volume.
    #[error("the convex hull of the mesh is flat or empty")]
    FlatHull,
}

#[derive(Debug, Clone)]
pub(super) enum Form {
    Cuboid(Cuboid),
    /// Along y, as parry has it.
    Cylinder(Cylinder),
    /// Along y.
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

/// A convex hull about a point inside it.
#[derive(Debug, Clone)]
pub(super) struct Hull {
    pub(super) body: ConvexPolyhedron,
    /// Outward unit normals of planes that touch the hull, its faces among them, and their heights
    /// over that point.
    faces: Vec<(Vector3<f64>, f64)>,
    /// Radius of a sphere about that point inside the hull.
    inner_radius: f64,
}

impl Hull {
    fn new(body: ConvexPolyhedron) -> Self {
        // Beyond an edge the planes of its two faces are a poor bound: planes all around help.
        let around = sph::direction::even_directions(BOUND_DIRECTIONS);
        let normals = body.faces().iter().map(|face| from_parry(face.normal));
        let faces: Vec<_> = normals
            .chain(around.iter().map(|n| n.into_inner()))
            .map(|normal| (normal, support_of(&body, &normal)))
            .collect();
        let least = faces.iter().map(|f| f.1).fold(f64::INFINITY, f64::min);
        Hull {
            body,
            faces,
            inner_radius: if least.is_finite() {
                least.max(0.0)
            } else {
                0.0
            },
        }
    }

    /// The farthest plane gives the lower bound, the inner sphere the upper one.
    fn distance(&self, p: &Vector3<f64>) -> PointDistance {
        let mut best = PointDistance {
            lower: 0.0,
            upper: p.norm() - self.inner_radius,
            slope: Vector3::zeros(),
        };
        for (normal, height) in &self.faces {
            let above = normal.dot(p) - height;
            if above > best.lower {
                best.lower = above;
                best.slope = *normal;
            }
        }
        best.upper = best.upper.max(best.lower);
        if self.inner_radius <= 0.0 {
            best.upper = f64::INFINITY;
        }
        best
    }
}

fn support_of(body: &ConvexPolyhedron, n: &Vector3<f64>) -> f64 {
    let n = to_parry(n);
    let heights = body.points().iter().map(|p| n.dot(*p));
    heights.fold(f64::NEG_INFINITY, f64::max)
}

/// A convex piece in its own frame, placed in a link.
#[derive(Debug, Clone)]
pub(crate) struct ConvexPiece {
    pub(crate) link_from_piece: Isometry3<f64>,
    pub(super) form: Form,
    /// Radius of a sphere about the origin of the piece that holds it.
    pub(crate) radius: f64,
}

impl ConvexPiece {
    pub(crate) fn new(placed: &LinkGeometry) -> Result<Self, GeometryError> {
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
                let (hull, centre) = hull(points)?;
                link_from_piece *= nalgebra::Translation3::from(centre.coords);
                let radius = hull.points().iter().map(|p| p.length()).fold(0.0, f64::max);
                (Form::Hull(Box::new(Hull::new(hull))), radius)
            }
        };
        Ok(ConvexPiece {
            link_from_piece,
            form,
            radius,
        })
    }

    /// The distance of a point (piece frame) from the piece and how it changes.
    ///
    /// Exact but for hulls, for which the face planes give the lower bound. Inside the
    /// piece both bounds are 0 (a hull: the lower one) and the slope vanishes.
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

    /// Exact distance to a triangle in the piece frame and the closest point of the
    /// triangle; (0, none) where they meet.
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

    /// Vertices (piece frame) and triangles, round parts with 24 sides.
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

    /// Distance to another piece, 0 where they meet.
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

    /// From the nearest point of any piece to `p`, both in the frame of the pose; zero inside.
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

/// Checks that the vertices of a mesh span a convex hull with volume.
pub(crate) fn check_hull(points: &[Point3<f64>]) -> Result<(), GeometryError> {
    hull(points).map(|_| ())
}

/// A convex hull of the points about a point inside it.
///
/// Of many points only those extreme in [`HULL_DIRECTIONS`] even directions are kept, and
/// their hull is enlarged until it holds all points (by some percent of its size).
fn hull(points: &[Point3<f64>]) -> Result<(ConvexPolyhedron, Point3<f64>), GeometryError> {
    let extreme = extreme_points(points);
    let count = extreme.len().max(1) as f64;
    let centre = Point3::from(extreme.iter().map(|p| p.coords).sum::<Vector3<f64>>() / count);
    if thickness(&extreme, &centre) < LEAST_HULL_THICKNESS {
        return Err(GeometryError::FlatHull);
    }
    let build = |scale: f64| {
        let centred: Vec<_> = extreme
            .iter()
            .map(|p| to_parry(&((p - centre) * scale)))
            .collect();
        ConvexPolyhedron::from_convex_hull(&centred).ok_or(GeometryError::FlatHull)
    };
    let tight = build(1.0)?;
    let outside = |normal: Vector3<f64>| {
        let reach = points
            .iter()
            .map(|p| normal.dot(&(p - centre)))
            .fold(0.0, f64::max);
        reach / support_of(&tight, &normal)
    };
    let normals = tight.faces().iter().map(|face| from_parry(face.normal));
    let scale = normals.map(outside).fold(1.0, f64::max);
    if !scale.is_finite() {
        return Err(GeometryError::FlatHull);
    }
    Ok((build(scale)?, centre))
}

fn extreme_points(points: &[Point3<f64>]) -> Vec<Point3<f64>> {
    if points.len() <= HULL_DIRECTIONS {
        return points.to_vec();
    }
    let mut kept: Vec<usize> = sph::direction::even_directions(HULL_DIRECTIONS)
        .iter()
        .filter_map(|d| {
            let height = |k: &usize| d.dot(&points[*k].coords);
            (0..points.len()).max_by(|a, b| height(a).total_cmp(&height(b)))
        })
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|k| points[k]).collect()
}

/// Root mean square extent along the thinnest principal axis.
fn thickness(points: &[Point3<f64>], centre: &Point3<f64>) -> f64 {
    let count = points.len().max(1) as f64;
    let mean = points.iter().map(|p| p - centre).sum::<Vector3<f64>>() / count;
    let mut covariance = nalgebra::Matrix3::zeros();
    for p in points {
        let d = p - centre - mean;
        covariance += d * d.transpose() / count;
    }
    let least = covariance.symmetric_eigenvalues().min();
    if least > 0.0 { least.sqrt() } else { 0.0 }
}

fn clamp_to_box(p: &Vector3<f64>, half: &Vector3<f64>) -> Vector3<f64> {
    p.zip_map(half, |c, h| c.clamp(-h, h))
}

/// parry's vector of a nalgebra one.
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

/// A direction with a fallback for vanishing vectors.
pub(crate) fn direction_or_z(v: &Vector3<f64>) -> UnitVector3<f64> {
    UnitVector3::try_new(*v, 0.0).unwrap_or(Vector3::z_axis())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Beyond edges and corners face planes alone are a third short, and searches that prune by
    /// them look at a large part of the object's mesh.
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
