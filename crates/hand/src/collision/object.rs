//! The object as the hand meets it: distances from convex pieces to a radial surface.

use nalgebra::{Isometry3, Matrix3, Point3, Vector3};
use shape::{RadialShape, TriangleMesh};
use sph::Direction;
use thiserror::Error;

use super::piece::{ConvexPiece, LinkShape};
use super::tree::{Content, Node, Tree};

/// Nodes on the way down a balanced tree never exceed this.
const STACK: usize = 64;
#[allow(missing_docs)]
pub static CNT:[std::sync::atomic::AtomicUsize;4]=[const{std::sync::atomic::AtomicUsize::new(0)};4];

/// Why an object cannot take part in collision tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum ObjectError {
    /// Too coarse or too fine a grid.
    #[error("a grid of {rows} x {columns} is not between 8 x 8 and 4096 x 4096")]
    Grid {
        /// Circles of latitude.
        rows: usize,
        /// Points on each.
        columns: usize,
    },
}

/// A radial surface prepared for distance queries.
///
/// Distances are those to the surface's regular (θ,φ) mesh, found by branch and bound
/// over a hierarchy of patches (bounds in closed form, parry at the few triangles left).
#[derive(Debug, Clone)]
pub struct CollisionObject<'a> {
    surface: &'a RadialShape,
    tree: Tree,
    outer_radius: f64,
    mesh_error: f64,
}

/// How exactly a distance is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Precision {
    /// Distances beyond this need not be told apart, metres.
    pub cutoff: f64,
    /// Upper and lower bound may differ by this, metres,
    pub absolute: f64,
    /// or by this share of the distance.
    pub relative: f64,
}

/// Bounds on a distance to the mesh, metres; 0 where bodies meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// The distance is at least this.
    pub lower: f64,
    /// The distance is at most this; infinite beyond the cutoff.
    pub upper: f64,
    /// A point of the mesh at distance `upper`, in the object frame, where there is one.
    pub on_object: Option<Point3<f64>>,
}

impl Gap {
    const TOUCHING: Gap = Gap {
        lower: 0.0,
        upper: 0.0,
        on_object: None,
    };
    const FAR: Gap = Gap {
        lower: f64::INFINITY,
        upper: f64::INFINITY,
        on_object: None,
    };

    /// The bounds on the smaller of two distances.
    fn min(self, other: Gap) -> Gap {
        Gap {
            lower: self.lower.min(other.lower),
            ..if other.upper < self.upper { other } else { self }
        }
    }
}

impl<'a> CollisionObject<'a> {
    /// Circles of latitude of the default grid.
    pub const ROWS: usize = 181;
    /// Points a circle of the default grid.
    pub const COLUMNS: usize = 360;

    /// Prepares a surface on the default grid, whose facets stay within 0.05 mm of the
    /// shapes of household objects ([`Self::mesh_error`] says how near).
    pub fn new(surface: &'a RadialShape) -> Result<Self, ObjectError> {
        Self::with_grid(surface, Self::ROWS, Self::COLUMNS)
    }

    /// Prepares a surface on a grid of `rows` circles of latitude with `columns` points each.
    pub fn with_grid(
        surface: &'a RadialShape,
        rows: usize,
        columns: usize,
    ) -> Result<Self, ObjectError> {
        if !(8..=4096).contains(&rows) || !(8..=4096).contains(&columns) {
            return Err(ObjectError::Grid { rows, columns });
        }
        let mesh = surface.mesh(rows, columns);
        Ok(CollisionObject {
            surface,
            tree: Tree::new(&mesh.vertices, &mesh.triangles),
            outer_radius: surface.radius_bounds().1,
            mesh_error: facet_error(&mesh, columns),
        })
    }

    /// The surface.
    pub fn surface(&self) -> &'a RadialShape {
        self.surface
    }

    /// An estimate of how far the facets are from the smooth surface, metres: an eighth
    /// of the largest second difference along the grid, normal to the surface.
    pub fn mesh_error(&self) -> f64 {
        self.mesh_error
    }

    /// Whether a point (object frame, metres) is inside the smooth surface.
    pub fn contains(&self, p: &Point3<f64>) -> bool {
        let distance = p.coords.norm();
        if distance > self.outer_radius {
            return false;
        }
        match Direction::try_new(p.coords, 0.0) {
            Some(direction) => distance < self.surface.radius(&direction),
            None => true,
        }
    }

    /// Bounds on the distance of a link to the object; a link wholly inside touches.
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
    /// The mesh is hollow: a piece wholly inside keeps a distance from it, and only this
    /// tells it from one outside.
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
        CNT[0].fetch_add(1,std::sync::atomic::Ordering::Relaxed);
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
            CNT[1].fetch_add(1,std::sync::atomic::Ordering::Relaxed);
            match self.tree.nodes[index].content {
                Content::Leaf { first, end } => {
                    for triangle in &self.tree.triangles[first..end] {
                        let least = frame.triangle_bound(triangle);
                        if least >= precision.settled(gap.upper) {
                            gap.lower = gap.lower.min(least);
                        } else {
                    CNT[2].fetch_add(1,std::sync::atomic::Ordering::Relaxed);
                            gap = gap.min(frame.triangle_gap(triangle));
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
    /// Patches farther than this cannot matter once a distance `upper` has been seen.
    fn settled(&self, upper: f64) -> f64 {
        let slack = self.absolute.max(self.relative * upper);
        self.cutoff.min(if upper.is_finite() { upper - slack } else { upper })
    }
}

/// A piece and the motion from the object frame to its own.
struct PieceFrame<'a> {
    piece: &'a ConvexPiece,
    object_from_piece: Isometry3<f64>,
    origin: Vector3<f64>,
    piece_from_object: Matrix3<f64>,
}

impl<'a> PieceFrame<'a> {
    fn new(piece: &'a ConvexPiece, object_from_piece: &Isometry3<f64>) -> Self {
        PieceFrame {
            piece,
            object_from_piece: *object_from_piece,
            origin: object_from_piece.translation.vector,
            piece_from_object: object_from_piece
                .rotation
                .to_rotation_matrix()
                .matrix()
                .transpose(),
        }
    }

    fn local(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.piece_from_object * (p - self.origin)
    }

    /// Lower and upper bound on the distance to a patch.
    fn bounds(&self, node: &Node) -> (f64, f64) {
        let (low, high) = self.piece.distance_bounds(&self.local(&node.centre));
        let normal = self.piece_from_object * node.normal;
        let least = node.normal.dot(&self.origin) - self.piece.support(&-normal);
        ((low - node.radius).max(least - node.top), high)
    }

    /// Both children with their lower bounds, the nearer first; the distance of a vertex
    /// of each is an upper bound.
    fn order(
        &self,
        nodes: &[Node],
        left: usize,
        right: usize,
        gap: &mut Gap,
    ) -> ((f64, usize), (f64, usize)) {
        let mut side = |index: usize| {
            let (low, high) = self.bounds(&nodes[index]);
            if high < gap.upper {
                gap.upper = high.max(0.0);
                gap.on_object = Some(Point3::from(nodes[index].centre));
            }
            (low, index)
        };
        let (a, b) = (side(left), side(right));
        if a.0 <= b.0 { (a, b) } else { (b, a) }
    }

    /// Lower bound on the distance to a triangle, from the plane that it lies in.
    fn triangle_bound(&self, corners: &[Vector3<f64>; 3]) -> f64 {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a));
        let normal = normal * (normal.dot(a).signum() / normal.norm());
        let local = self.piece_from_object * normal;
        normal.dot(&(self.origin - a)) - self.piece.support(&-local)
    }

    fn triangle_gap(&self, corners: &[Vector3<f64>; 3]) -> Gap {
        let local = corners.each_ref().map(|c| self.local(c));
        let (distance, on_triangle) = self.piece.triangle_distance(&local);
        Gap {
            lower: distance,
            upper: distance,
            on_object: on_triangle.map(|p| self.object_from_piece * Point3::from(p)),
        }
    }
}

/// Largest normal second difference of neighbouring vertices, over 8, both ways summed.
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
