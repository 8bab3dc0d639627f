//! Where lines cross the surface, and which points are inside it.

use nalgebra::{Point3, Vector3};
use shape::SurfaceRef;
use sph::Direction;

use super::object::CollisionObject;
use super::tree::{Content, Node, Tree};

/// A crossing this near to an edge of a triangle, as a share of it, is not counted for certain.
const EDGE: f64 = 1e-9;
/// Triangles whose height is below this share of their width have no inside.
const THIN: f64 = 1e-12;
/// Lines tried from one point.
const LINES: usize = 12;

/// A place where a line crosses the mesh of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing {
    /// Distance along the line, in lengths of its vector.
    pub(crate) along: f64,
    /// Whether the line goes out there.
    pub(crate) leaving: bool,
    /// The place on the sphere.
    pub(crate) direction: Direction,
}

/// The crossings of one line.
struct Line<'a> {
    tree: &'a Tree,
    start: Vector3<f64>,
    way: Vector3<f64>,
    longest: f64,
    found: Vec<Crossing>,
    /// Whether the line comes so near to an edge that a crossing may be counted twice or not at all.
    unsure: bool,
}

impl CollisionObject<'_> {
    /// Whether a point (centred frame, metres) is inside the surface.
    ///
    /// For a radial surface this is exact. Otherwise it is decided by the winding of the mesh about the
    /// point, and so certain for points farther than [`Self::mesh_error`] from the surface.
    pub fn contains(&self, p: &Point3<f64>) -> bool {
        let distance = p.coords.norm();
        if distance > self.outer_radius {
            return false;
        }
        match self.surface() {
            SurfaceRef::Radial(shape) => match Direction::try_new(p.coords, 0.0) {
                Some(direction) => distance < shape.radius(&direction),
                None => true,
            },
            SurfaceRef::Spherical(_) => self.winds_about(p),
        }
    }

    /// Lines from a point outside go in as often as out, those from a point inside go out once more.
    fn winds_about(&self, p: &Point3<f64>) -> bool {
        let longest = 2.0 * (self.outer_radius + p.coords.norm());
        let mut winding = 0;
        for way in sph::direction::even_directions(LINES) {
            let line = self.line(p, &way, longest);
            let sign = |c: &Crossing| if c.leaving { 1 } else { -1 };
            winding = line.found.iter().map(sign).sum();
            if !line.unsure && (winding == 0 || winding == 1) {
                break;
            }
        }
        winding > 0
    }

    /// The crossings of the mesh by the line p + t way for 0 < t < longest, in order.
    pub(crate) fn crossings(
        &self,
        p: &Point3<f64>,
        way: &Vector3<f64>,
        longest: f64,
    ) -> Vec<Crossing> {
        let mut found = self.line(p, way, longest).found;
        found.sort_by(|a, b| a.along.total_cmp(&b.along));
        found
    }

    fn line(&self, p: &Point3<f64>, way: &Vector3<f64>, longest: f64) -> Line<'_> {
        let mut line = Line {
            tree: &self.tree,
            start: p.coords,
            way: *way,
            longest,
            found: Vec::new(),
            unsure: false,
        };
        line.follow();
        line
    }
}

impl Line<'_> {
    fn follow(&mut self) {
        let tree = self.tree;
        let mut stack = Vec::with_capacity(64);
        stack.push(0);
        while let Some(index) = stack.pop() {
            let Some(node) = tree.nodes.get(index) else {
                continue;
            };
            if !self.may_meet(node) {
                continue;
            }
            match node.content {
                Content::Inner { left, right } => stack.extend([left, right]),
                Content::Leaf(block) => {
                    for (corners, vertex) in tree.triangles(block) {
                        let direction = || tree.direction(vertex);
                        self.cross(&corners, &direction);
                    }
                }
            }
        }
    }

    /// Whether the line comes into the ball about a patch.
    fn may_meet(&self, node: &Node) -> bool {
        let to = node.centre - self.start;
        let along = (to.dot(&self.way) / self.way.norm_squared()).clamp(0.0, self.longest);
        (to - self.way * along).norm_squared() <= node.radius * node.radius * (1.0 + 1e-9)
    }

    /// The crossing of one triangle by Cramer's rule (Möller and Trumbore 1997).
    fn cross(&mut self, [a, b, c]: &[Vector3<f64>; 3], direction: &dyn Fn() -> Direction) {
        let (first, second) = (b - a, c - a);
        let normal = first.cross(&second);
        let size = normal.norm();
        if !(size > THIN * (first.norm_squared() + second.norm_squared())) {
            return;
        }
        let arm = self.start - a;
        let facing = normal.dot(&self.way);
        let steep = facing.abs() > EDGE * size * self.way.norm();
        let side = arm.cross(&self.way);
        let u = -side.dot(&second) / facing;
        let v = side.dot(&first) / facing;
        let along = -normal.dot(&arm) / facing;
        if !steep {
            // Along the triangle; only one that the line meets matters.
            self.unsure |= (normal.dot(&arm) / size).abs() <= EDGE * first.norm();
            return;
        }
        if !(along > 0.0 && along < self.longest) {
            return;
        }
        let inside = u.min(v).min(1.0 - u - v);
        self.unsure |= inside.abs() <= EDGE;
        if inside >= 0.0 {
            self.found.push(Crossing {
                along,
                leaving: facing > 0.0,
                direction: direction(),
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shape::{RadialShape, SphericalField, SphericalShape};
    use sph::Coefficients;
    use sph::direction::even_directions;

    fn lump() -> RadialShape {
        let mut beta = Coefficients::constant(6, 0.12);
        for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
            *b = 0.02 * (i as f64 * 2.3).sin() / (1.0 + 0.2 * i as f64);
        }
        RadialShape::new(beta).unwrap()
    }

    #[test]
    fn a_copy_over_the_sphere_contains_the_same_points() {
        let radial = lump();
        let field = SphericalField::new(&SphericalShape::from_radial(&radial).unwrap());
        let (radial, copy) = (
            CollisionObject::new(&radial).unwrap(),
            CollisionObject::new(&field).unwrap(),
        );
        let mut inside = 0;
        for (k, p) in even_directions(3000).iter().enumerate() {
            let point = Point3::from(p.into_inner() * (0.06 + 0.12 * (k as f64 * 0.37).fract()));
            let surface = radial.surface();
            let shape::SurfaceRef::Radial(shape) = surface else {
                panic!("a radial surface")
            };
            if (shape.radius(p) - point.coords.norm()).abs() > 2.0 * copy.mesh_error() {
                assert_eq!(copy.contains(&point), radial.contains(&point), "{point:?}");
                inside += usize::from(radial.contains(&point));
            }
        }
        assert!((500..2800).contains(&inside), "{inside}");
        // Through vertices, edges and poles of the grid.
        assert!(copy.contains(&Point3::origin()));
        assert!(!copy.contains(&Point3::new(0.0, 0.0, 0.3)));
    }

    #[test]
    fn a_line_through_a_ball_goes_in_and_out() {
        let ball = RadialShape::sphere(3, 0.05).unwrap();
        let field = SphericalField::new(&SphericalShape::from_radial(&ball).unwrap());
        let object = CollisionObject::new(&field).unwrap();
        let start = Point3::new(-0.1, 0.011, 0.007);
        let found = object.crossings(&start, &Vector3::x(), 1.0);
        let leaving: Vec<bool> = found.iter().map(|c| c.leaving).collect();
        assert_eq!(leaving, [false, true]);
        let half = (0.05_f64.powi(2) - 0.011_f64.powi(2) - 0.007_f64.powi(2)).sqrt();
        for (crossing, along) in found.iter().zip([0.1 - half, 0.1 + half]) {
            assert!((crossing.along - along).abs() <= 2.0 * object.mesh_error());
            let place = start.coords + Vector3::x() * crossing.along;
            assert!((crossing.direction.into_inner() * 0.05 - place).norm() <= 3e-3);
        }
    }
}
