//! Triangle meshes, for collision tests and display.

use nalgebra::{Point3, Vector3};
use rand::{Rng, RngExt};

/// Vertices in metres and triangles, counter-clockwise seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    /// Corners, metres.
    pub vertices: Vec<Point3<f64>>,
    /// Indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// The surface r p over rings of (sin θ, cos θ) from pole to pole, `columns` longitudes each.
    ///
    /// `radii` has one value per point, ring after ring. Triangles without area, on rings of zero
    /// length, are omitted.
    pub fn from_rings(rings: &[(f64, f64)], columns: usize, radii: &[f64]) -> Self {
        let step = std::f64::consts::TAU / columns as f64;
        let mut vertices = Vec::with_capacity(radii.len());
        for (j, &(sin_theta, cos_theta)) in rings.iter().enumerate() {
            for k in 0..columns {
                let (sin, cos) = (step * k as f64).sin_cos();
                let p = Vector3::new(sin_theta * cos, sin_theta * sin, cos_theta);
                vertices.push(Point3::from(p * radii[j * columns + k]));
            }
        }
        Self::from_ring_points(rings.len(), columns, vertices)
    }

    /// The closed surface over `rows` rings of `columns` points each, from pole to pole.
    ///
    /// `vertices` has the points ring after ring. The first and the last ring are poles: triangles
    /// with an edge along them have no area and are left out.
    pub fn from_ring_points(rows: usize, columns: usize, vertices: Vec<Point3<f64>>) -> Self {
        let mut triangles = Vec::with_capacity(2 * rows * columns);
        for j in 0..rows.saturating_sub(1) {
            for k in 0..columns {
                let at = |row: usize, column: usize| (row * columns + column % columns) as u32;
                let (a, b) = (at(j, k), at(j + 1, k));
                let (c, d) = (at(j + 1, k + 1), at(j, k + 1));
                if j + 2 < rows {
                    triangles.push([a, b, c]);
                }
                if j > 0 {
                    triangles.push([a, c, d]);
                }
            }
        }
        Self {
            vertices,
            triangles,
        }
    }

    /// Signed volume by the divergence theorem, m³; positive when triangles face outward.
    pub fn volume(&self) -> f64 {
        let corner = |i: u32| self.vertices[i as usize].coords;
        self.triangles
            .iter()
            .map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0)
            .sum()
    }

    /// Total area, m².
    pub fn area(&self) -> f64 {
        self.triangles.iter().map(|t| self.triangle_area(t)).sum()
    }

    /// `count` points spread over the surface by area, independent and uniform.
    ///
    /// Empty if the mesh has no area, or none that is finite. Costs count · log(triangles).
    pub fn sample(&self, count: usize, rng: &mut impl Rng) -> Vec<Point3<f64>> {
        let mut total = 0.0;
        let mut cumulative = Vec::with_capacity(self.triangles.len());
        for triangle in &self.triangles {
            total += self.triangle_area(triangle);
            cumulative.push(total);
        }
        if !(total > 0.0 && total.is_finite()) {
            return Vec::new();
        }
        (0..count)
            .map(|_| {
                let at = rng.random::<f64>() * total;
                let index = cumulative.partition_point(|sum| *sum <= at);
                let index = index.min(self.triangles.len() - 1);
                let [a, b, c] = self.triangles[index].map(|i| self.vertices[i as usize]);
                // The square root makes the density uniform over the triangle.
                let (s, t) = (rng.random::<f64>().sqrt(), rng.random::<f64>());
                a + (b - a) * (s * (1.0 - t)) + (c - a) * (s * t)
            })
            .collect()
    }

    fn triangle_area(&self, triangle: &[u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| self.vertices[i as usize]);
        0.5 * (b - a).cross(&(c - a)).norm()
    }
}
