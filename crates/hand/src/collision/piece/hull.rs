//! Convex hulls of points, and bounds on the distance of a point from one.

use nalgebra::{Point3, Vector3};
use parry3d_f64::shape::ConvexPolyhedron;
use thiserror::Error;

use super::{PointDistance, from_parry, to_parry};

/// Extents of a hull below this (metres) count as flat.
const LEAST_HULL_THICKNESS: f64 = 1e-6;
/// Of more points than this only the extreme ones in this many directions are kept.
const HULL_DIRECTIONS: usize = 96;
/// Directions are doubled until a hull is as tight as wanted, up to this many.
const MOST_DIRECTIONS: usize = 1536;
/// Number of supporting planes of a hull in addition to those of its faces.
const BOUND_DIRECTIONS: usize = 96;

/// Why geometry cannot take part in collision tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum GeometryError {
    /// A mesh without volume.
    #[error("the convex hull of the mesh is flat or empty")]
    FlatHull,
}

/// A convex hull in a frame whose origin is inside it.
#[derive(Debug, Clone)]
pub(in crate::collision) struct Hull {
    pub(in crate::collision) body: ConvexPolyhedron,
    /// Outward unit normals of supporting planes of the hull, those of its faces among them, and
    /// their distances from the origin.
    faces: Vec<(Vector3<f64>, f64)>,
    /// Radius of a sphere about the origin that is inside the hull.
    inner_radius: f64,
    /// A bound on how far the hull extends beyond that of all points, metres.
    pub(super) excess: f64,
}

impl Hull {
    /// The convex hull of points in a frame about a point inside it, and that point. The hull extends
    /// beyond that of all points by at most `excess` (metres) where [`MOST_DIRECTIONS`] allow.
    pub(super) fn of_points(
        points: &[Point3<f64>],
        excess: f64,
    ) -> Result<(Self, Point3<f64>), GeometryError> {
        let mut directions = HULL_DIRECTIONS;
        loop {
            let found = hull(points, directions)?;
            if found.excess <= excess || directions >= MOST_DIRECTIONS {
                return Ok((Hull::new(found.body, found.excess), found.centre));
            }
            directions *= 2;
        }
    }

    /// Radius of the sphere about the origin that contains the hull.
    pub(super) fn radius(&self) -> f64 {
        let norms = self.body.points().iter().map(|p| p.length());
        norms.fold(0.0, f64::max)
    }

    fn new(body: ConvexPolyhedron, excess: f64) -> Self {
        // Beyond an edge the planes of its two faces give a poor bound. Planes in even directions
        // improve it.
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
            excess,
        }
    }

    /// The lower bound is the largest distance from a plane, the upper bound the distance from the
    /// inner sphere.
    pub(super) fn distance(&self, p: &Vector3<f64>) -> PointDistance {
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

/// Checks that the vertices of a mesh span a convex hull with volume.
pub(crate) fn check_hull(points: &[Point3<f64>]) -> Result<(), GeometryError> {
    hull(points, HULL_DIRECTIONS).map(|_| ())
}

/// A hull that contains all points.
struct Simplified {
    body: ConvexPolyhedron,
    /// The origin of its frame, inside it.
    centre: Point3<f64>,
    /// A bound on how far it extends beyond the hull of all points, metres.
    excess: f64,
}

/// A convex hull of the points.
///
/// Of more points than `directions` only the extreme ones in that many even directions are
/// kept, and their hull is enlarged by a few percent until it contains all points.
fn hull(points: &[Point3<f64>], directions: usize) -> Result<Simplified, GeometryError> {
    let extreme = extreme_points(points, directions);
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
    let radius = extreme.iter().map(|p| (p - centre).norm());
    Ok(Simplified {
        excess: (scale - 1.0) * radius.fold(0.0, f64::max),
        body: build(scale)?,
        centre,
    })
}

fn extreme_points(points: &[Point3<f64>], directions: usize) -> Vec<Point3<f64>> {
    if points.len() <= directions {
        return points.to_vec();
    }
    let mut kept: Vec<usize> = sph::direction::even_directions(directions)
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
