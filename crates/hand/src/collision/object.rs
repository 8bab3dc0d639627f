//! The object as the hand meets it: distances from convex pieces to a surface.

use std::sync::Arc;

use nalgebra::{Isometry3, Point3};
use shape::closed_patch::patch_at;
use shape::{SurfaceRef, TriangleMesh};
use sph::Direction;
use thiserror::Error;

use super::gap::Gap;
use super::piece::{ConvexPiece, LinkShape};
use super::piece_frame::PieceFrame;
use super::surroundings::Surroundings;
use super::tree::{Content, Tree};

/// Capacity of the stack of nodes; the depth of a balanced tree never exceeds it.
const STACK: usize = 64;

/// Why an object cannot take part in collision tests.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ObjectError {
    /// Too coarse or too fine a grid.
    #[error("a grid of {rows} x {columns} is not between 8 x 8 and 4096 x 4096")]
    Grid {
        /// Circles of latitude.
        rows: usize,
        /// Points on each.
        columns: usize,
    },
    /// The object is so large or rough that no grid is near enough to it.
    #[error(
        "the finest collision mesh is {:.3} mm off the surface (limit {:.3} mm): the object is too large or too rough for a hand; is its unit right?",
        1e3 * error,
        1e3 * limit
    )]
    Coarse {
        /// How far the facets are from the surface, metres.
        error: f64,
        /// How far they may be, metres.
        limit: f64,
    },
}

/// A surface prepared for distance queries.
///
/// Distances are those to the surface's regular (θ,φ) mesh, found by branch and bound
/// over a hierarchy of patches (bounds in closed form, parry at the few triangles left).
#[derive(Debug, Clone)]
pub struct CollisionObject<'a> {
    surface: SurfaceRef<'a>,
    pub(super) tree: Tree,
    pub(super) outer_radius: f64,
    inner_radius: f64,
    mesh_error: f64,
    surroundings: Arc<Surroundings>,
}

/// How exactly a distance is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Precision {
    /// Distances beyond this are not resolved, metres.
    pub cutoff: f64,
    /// Upper and lower bound may differ by this, metres,
    pub absolute: f64,
    /// or by this share of the distance.
    pub relative: f64,
}

impl<'a> CollisionObject<'a> {
    /// Wanted distance of the facets from the surface, metres; the finest grid may miss it.
    pub const FACET_TOLERANCE: f64 = 5e-5;
    /// [`Self::new`] refuses facets farther from the surface than this, metres: a quarter of the
    /// gap at which a tip counts as arrived.
    pub const FACET_LIMIT: f64 = 2.5e-4;
    /// The coarsest grid that [`Self::new`] tries. Its spacing is halved at most twice.
    const COARSE_GRID: (usize, usize) = (121, 240);

    /// Prepares a surface on the coarsest of three grids whose facets stay within
    /// [`Self::FACET_TOLERANCE`] of it. [`Self::mesh_error`] is the distance reached. More than
    /// [`Self::FACET_LIMIT`] on the finest grid is an error.
    pub fn new(surface: impl Into<SurfaceRef<'a>>) -> Result<Self, ObjectError> {
        let surface = surface.into();
        let (mut rows, mut columns) = Self::COARSE_GRID;
        let mut mesh = surface.mesh(rows, columns);
        for _ in 0..2 {
            if facet_error(&mesh, columns) <= Self::FACET_TOLERANCE {
                break;
            }
            (rows, columns) = (2 * rows - 1, 2 * columns);
            mesh = surface.mesh(rows, columns);
        }
        let object = Self::of_mesh(surface, &mesh, columns);
        if object.mesh_error <= Self::FACET_LIMIT {
            Ok(object)
        } else {
            Err(ObjectError::Coarse {
                error: object.mesh_error,
                limit: Self::FACET_LIMIT,
            })
        }
    }

    /// Prepares a surface on a grid of `rows` circles of latitude with `columns` points each.
    pub fn with_grid(
        surface: impl Into<SurfaceRef<'a>>,
        rows: usize,
        columns: usize,
    ) -> Result<Self, ObjectError> {
        let surface = surface.into();
        if !(8..=4096).contains(&rows) || !(8..=4096).contains(&columns) {
            return Err(ObjectError::Grid { rows, columns });
        }
        Ok(Self::of_mesh(
            surface,
            &surface.mesh(rows, columns),
            columns,
        ))
    }

    fn of_mesh(surface: SurfaceRef<'a>, mesh: &TriangleMesh, columns: usize) -> Self {
        let (inner_radius, outer_radius) = match surface {
            SurfaceRef::Radial(shape) => shape.radius_bounds(),
            SurfaceRef::Spherical(_) => {
                let squared = mesh.vertices.iter().map(|v| v.coords.norm_squared());
                let outer = squared.fold(0.0, f64::max).sqrt();
                (3.0 * mesh.volume() / mesh.area(), outer)
            }
        };
        let star_shaped = matches!(surface, SurfaceRef::Radial(_));
        CollisionObject {
            surface,
            tree: Tree::new(&mesh.vertices, columns, star_shaped),
            outer_radius,
            inner_radius,
            mesh_error: facet_error(mesh, columns),
            surroundings: Arc::default(),
        }
    }

    /// The same object among obstacles and with the points of its scan: hands stay away from both.
    #[must_use]
    pub fn with_surroundings(self, surroundings: Arc<Surroundings>) -> Self {
        CollisionObject {
            surroundings,
            ..self
        }
    }

    /// What is around the object and on it besides its surface.
    pub fn surroundings(&self) -> &Surroundings {
        &self.surroundings
    }

    /// The surface.
    pub fn surface(&self) -> SurfaceRef<'a> {
        self.surface
    }

    /// How far the surface reaches from the origin, metres.
    pub fn outer_radius(&self) -> f64 {
        self.outer_radius
    }

    /// Radius of a ball that is about as thick as the object, metres: the least radius of a radial
    /// surface, else three times volume over area.
    pub(crate) fn inner_radius(&self) -> f64 {
        self.inner_radius
    }

    /// Whether a point of the surface is on a part that closes a hole of the object.
    pub fn is_closed_hole(&self, p: &Point3<f64>) -> bool {
        patch_at(self.surface.closed_patches(), p).is_some()
    }

    /// Circles of latitude, poles included, and points on each of the mesh.
    pub fn grid(&self) -> (usize, usize) {
        self.tree.grid()
    }

    /// An estimate of how far the facets are from the smooth surface, metres: an eighth
    /// of the largest second difference along the grid, normal to the surface.
    pub fn mesh_error(&self) -> f64 {
        self.mesh_error
    }

    /// The place on the sphere at which a distance was found: exact for a radial surface, the next vertex
    /// of the grid otherwise.
    pub(crate) fn direction_at(&self, gap: &Gap) -> Option<Direction> {
        match self.surface {
            SurfaceRef::Radial(_) => Direction::try_new(gap.on_object?.coords, 0.0),
            SurfaceRef::Spherical(_) => Some(self.tree.direction(gap.near?)),
        }
    }

    /// Bounds on the distance of a link to the object. A link that is wholly inside has the
    /// distance 0.
    pub(crate) fn link_gap(
        &self,
        link: &LinkShape,
        object_from_link: &Isometry3<f64>,
        mut precision: Precision,
    ) -> Gap {
        let centre = (object_from_link * link.centre).coords.norm();
        let clear = centre - link.radius - self.outer_radius;
        if clear >= precision.cutoff {
            return Gap {
                lower: clear,
                ..Gap::FAR
            };
        }
        let mut gap = Gap::FAR;
        for piece in &link.pieces {
            let object_from_piece = object_from_link * piece.link_from_piece;
            gap = gap.min(self.piece_gap(piece, &object_from_piece, precision));
            precision.cutoff = precision.cutoff.min(gap.upper);
            if gap.upper <= 0.0 {
                break;
            }
        }
        gap
    }

    /// Whether the origin of any piece of the link is inside the object.
    ///
    /// The mesh is a surface without an interior, so a piece wholly inside has a positive distance
    /// from it. This test distinguishes such a piece from one outside.
    pub(crate) fn holds_piece_of(&self, link: &LinkShape, pose: &Isometry3<f64>) -> bool {
        link.pieces.iter().any(|piece| {
            let origin = pose * Point3::from(piece.link_from_piece.translation.vector);
            self.contains(&origin)
        })
    }

    /// Branch and bound over the patches.
    pub(crate) fn piece_gap(
        &self,
        piece: &ConvexPiece,
        object_from_piece: &Isometry3<f64>,
        precision: Precision,
    ) -> Gap {
        let frame = PieceFrame::new(piece, object_from_piece);
        let mut gap = Gap::FAR;
        let mut stack = [(0.0, 0usize); STACK];
        let mut height = 0;
        if let Some(root) = self.tree.nodes.first() {
            stack[0] = (frame.bounds(root).0, 0);
            height = 1;
        }
        while height > 0 {
            height -= 1;
            let (bound, index) = stack[height];
            if bound >= precision.settled(gap.upper) {
                gap.lower = gap.lower.min(bound);
                continue;
            }
            match self.tree.nodes[index].content {
                Content::Leaf(block) => {
                    for (triangle, near) in self.tree.triangles(block) {
                        let least = frame.triangle_bound(&triangle);
                        if least >= precision.settled(gap.upper) {
                            gap.lower = gap.lower.min(least);
                        } else {
                            gap = gap.min(frame.triangle_gap(&triangle, near));
                        }
                    }
                }
                Content::Inner { left, right } => {
                    let (near, far) = frame.order(&self.tree.nodes, left, right, &mut gap);
                    stack[height] = far;
                    stack[height + 1] = near;
                    height += 2;
                }
            }
            if gap.upper <= 0.0 {
                return Gap::TOUCHING;
            }
        }
        gap
    }
}

impl Precision {
    /// The distance beyond which patches are pruned when the least distance found is `upper`.
    fn settled(&self, upper: f64) -> f64 {
        let slack = self.absolute.max(self.relative * upper);
        self.cutoff.min(if upper.is_finite() {
            upper - slack
        } else {
            upper
        })
    }
}

/// Largest normal second difference of neighbouring vertices, divided by 8; the sum over both
/// directions of the grid.
fn facet_error(mesh: &TriangleMesh, columns: usize) -> f64 {
    let rows = mesh.vertices.len() / columns;
    let at = |row: usize, column: usize| mesh.vertices[row * columns + column % columns].coords;
    let mut largest: f64 = 0.0;
    for row in 1..rows.saturating_sub(1) {
        for column in 0..columns {
            let here = at(row, column);
            let (up, down) = (at(row - 1, column), at(row + 1, column));
            let (west, east) = (at(row, column + columns - 1), at(row, column + 1));
            let normal = (down - up).cross(&(east - west));
            if let Some(normal) = normal.try_normalize(0.0) {
                let along = normal.dot(&(up - here + down - here)).abs();
                let across = normal.dot(&(west - here + east - here)).abs();
                largest = largest.max((along + across) / 8.0);
            }
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::piece::to_parry;
    use crate::model::{Geometry, LinkGeometry};
    use nalgebra::Vector3;
    use parry3d_f64::shape::TriMesh;
    use shape::RadialShape;
    use sph::Coefficients;

    const EXACT: Precision = Precision {
        cutoff: f64::INFINITY,
        absolute: 0.0,
        relative: 0.0,
    };

    fn lump() -> RadialShape {
        let mut beta = Coefficients::constant(6, 0.12);
        for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
            *b = 0.02 * (i as f64 * 2.3).sin() / (1.0 + 0.2 * i as f64);
        }
        RadialShape::new(beta).unwrap()
    }

    fn pieces() -> Vec<ConvexPiece> {
        let corner = |k: usize| {
            let side = |bit: usize| if k >> bit & 1 == 0 { -0.01 } else { 0.014 };
            Point3::new(side(0), 2.0 * side(1), side(2))
        };
        let geometries = [
            Geometry::Box {
                half_extents: Vector3::new(0.01, 0.02, 0.03),
            },
            Geometry::Cylinder {
                radius: 0.012,
                half_length: 0.02,
            },
            Geometry::Capsule {
                radius: 0.01,
                half_length: 0.02,
            },
            Geometry::Sphere { radius: 0.015 },
            Geometry::Hull {
                file: String::new(),
                points: (0..8).map(corner).collect(),
            },
        ];
        geometries
            .into_iter()
            .map(|geometry| {
                ConvexPiece::new(&LinkGeometry {
                    link_from_geometry: Isometry3::identity(),
                    geometry,
                })
                .unwrap()
            })
            .collect()
    }

    fn places(count: usize) -> impl Iterator<Item = Isometry3<f64>> {
        (0..count).map(|k| {
            let k = k as f64;
            let away = 0.06 + 0.04 * (k * 0.7).sin().abs();
            let p = Vector3::new((k * 1.1).sin(), (k * 1.7).cos(), (k * 0.9).sin());
            Isometry3::new(
                p.normalize() * away,
                Vector3::new(k * 0.3, k * 0.5, (k * 0.2).cos()),
            )
        })
    }

    #[test]
    fn gaps_agree_with_parry_on_the_same_mesh() {
        let surface = lump();
        let object = CollisionObject::with_grid(&surface, 61, 120).unwrap();
        let mesh = surface.mesh(61, 120);
        let vertices = mesh.vertices.iter().map(|v| to_parry(&v.coords)).collect();
        let mesh = TriMesh::new(vertices, mesh.triangles).unwrap();
        let mut apart = 0;
        for piece in pieces() {
            for place in places(60) {
                let gap = object.piece_gap(&piece, &place, EXACT);
                let expected = piece.shape_distance(&place, &mesh);
                assert!((gap.lower - expected).abs() <= 1e-7, "{gap:?} {expected}");
                assert!((gap.upper - expected).abs() <= 1e-7, "{gap:?} {expected}");
                apart += usize::from(expected > 0.0);
                let loose = Precision {
                    cutoff: 0.03,
                    absolute: 1e-4,
                    relative: 0.2,
                };
                let rough = object.piece_gap(&piece, &place, loose);
                assert!(rough.lower <= expected + 1e-7 && rough.upper >= expected - 1e-7);
                assert!(rough.lower >= (0.8 * expected - 1e-4).min(0.03));
            }
        }
        assert!(apart > 200);
    }

    #[test]
    fn a_piece_wholly_inside_is_seen_although_the_mesh_is_hollow() {
        let surface = RadialShape::sphere(4, 0.2).unwrap();
        let object = CollisionObject::new(&surface).unwrap();
        for piece in pieces() {
            let link = LinkShape::new(vec![piece]);
            let pose = Isometry3::translation(0.01, 0.02, 0.0);
            assert!(object.link_gap(&link, &pose, EXACT).lower > 0.1);
            assert!(object.holds_piece_of(&link, &pose));
            assert!(!object.holds_piece_of(&link, &Isometry3::translation(0.0, 0.0, 0.3)));
        }
        assert!(object.contains(&Point3::origin()));
    }

    #[test]
    fn a_sphere_keeps_its_distance_from_a_sphere() {
        let surface = RadialShape::sphere(2, 0.05).unwrap();
        let object = CollisionObject::new(&surface).unwrap();
        let ball = &pieces()[3];
        for place in places(40) {
            let expected = place.translation.vector.norm() - 0.05 - 0.015;
            let gap = object.piece_gap(ball, &place, EXACT);
            let expected = expected.max(0.0);
            assert!(gap.lower >= expected - 1e-9);
            assert!(gap.upper <= expected + object.mesh_error() + 1e-9);
        }
        assert!(object.mesh_error() <= 2e-5);
    }

    #[test]
    fn grids_out_of_range_are_refused() {
        let surface = RadialShape::sphere(2, 0.05).unwrap();
        assert!(CollisionObject::with_grid(&surface, 2, 100).is_err());
        assert!(CollisionObject::with_grid(&surface, 100, 100_000).is_err());
    }
}
