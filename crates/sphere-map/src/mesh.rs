//! A closed triangle mesh.

use nalgebra::{Point3, Vector3};

/// A closed, oriented triangle mesh: every edge belongs to two triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Corners, in the unit of the cloud.
    pub vertices: Vec<Point3<f64>>,
    /// Indices into `vertices`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// χ = vertices − edges + triangles; 2 for a surface of genus zero.
    pub fn euler_characteristic(&self) -> i64 {
        let count = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
        count(self.vertices.len()) + count(self.triangles.len())
            - count(self.triangles.len() * 3 / 2)
    }

    /// Total area.
    pub fn area(&self) -> f64 {
        let area = |t: &[u32; 3]| self.area_vector(t).norm();
        self.triangles.iter().map(area).sum()
    }

    /// Enclosed volume by the divergence theorem; positive when triangles face outward.
    pub fn volume(&self) -> f64 {
        self.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = self.corners(t);
                a.coords.dot(&b.coords.cross(&c.coords)) / 6.0
            })
            .sum()
    }

    /// The three corners of a triangle.
    pub(crate) fn corners(&self, triangle: &[u32; 3]) -> [Point3<f64>; 3] {
        triangle.map(|i| self.vertices[i as usize])
    }

    /// Outward normal times area.
    pub(crate) fn area_vector(&self, triangle: &[u32; 3]) -> Vector3<f64> {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a)) * 0.5
    }
}
