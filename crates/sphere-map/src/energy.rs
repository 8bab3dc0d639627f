//! The energy of a map from the mesh to the sphere, one star of triangles at a time.

use nalgebra::Vector3;

/// How shape and area are weighed against each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weights {
    /// Distortion of angles (MIPS).
    pub(crate) angle: f64,
    /// Distortion of areas.
    pub(crate) area: f64,
    /// Unevenness of the triangles on the sphere themselves: keeps the places of vertices that are yet
    /// to come open.
    pub(crate) barrier: f64,
}

/// A triangle (v, a, b) at a vertex v that moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    /// Images of a and b.
    pub(crate) a: Vector3<f64>,
    pub(crate) b: Vector3<f64>,
    /// Squared edges on the mesh, opposite to v, a and b.
    edges: [f64; 3],
    /// Area on the mesh.
    area: f64,
    /// Squared edge from a to b on the sphere.
    base: f64,
    /// a × b.
    normal: Vector3<f64>,
}

/// Least area of a triangle of the mesh, of a sphere's 4π.
const LEAST_AREA: f64 = 1e-12;
/// Least determinant and least squared area on the sphere that count as positive.
const LEAST_DETERMINANT: f64 = 1e-14;
const LEAST_SQUARE: f64 = 1e-28;

impl Corner {
    /// From the corners on the mesh (scaled to an area of 4π) and the images of a and b.
    pub(crate) fn new(mesh: [Vector3<f64>; 3], a: Vector3<f64>, b: Vector3<f64>) -> Self {
        let [pv, pa, pb] = mesh;
        Self {
            edges: [
                (pb - pa).norm_squared(),
                (pv - pb).norm_squared(),
                (pa - pv).norm_squared(),
            ],
            area: (0.5 * (pa - pv).cross(&(pb - pv)).norm()).max(LEAST_AREA),
            base: (b - a).norm_squared(),
            normal: a.cross(&b),
            a,
            b,
        }
    }

    /// det(x, a, b): positive where x sees the edge on the right side.
    pub(crate) fn determinant(&self, x: &Vector3<f64>) -> f64 {
        x.dot(&self.normal)
    }

    /// det / |a × b|: the height of x above the great circle through a and b.
    pub(crate) fn height(&self, x: &Vector3<f64>) -> f64 {
        self.determinant(x) / self.normal.norm().max(1e-300)
    }

    /// E = A (t/d + w (d + 1/d)/2) + barrier (s₀+s₁+s₂)/(2A′) with v at x; infinite when the triangle
    /// is turned over.
    ///
    /// d = A/A′ is the ratio of areas, t = ½ Σ lᵢ (sⱼ+s_k−sᵢ) / (8A′²) half the squared norm of the
    /// map's derivative from the sphere to the mesh; l and s are squared edges on mesh and sphere.
    #[inline]
    pub(crate) fn energy(&self, weights: &Weights, x: &Vector3<f64>) -> f64 {
        if self.determinant(x) < LEAST_DETERMINANT {
            return f64::INFINITY;
        }
        let (e1, e2) = (x - self.b, self.a - x);
        // (2A′)².
        let square = e1.cross(&e2).norm_squared();
        if square < LEAST_SQUARE {
            return f64::INFINITY;
        }
        let (s0, s1, s2) = (self.base, e1.norm_squared(), e2.norm_squared());
        let [l0, l1, l2] = self.edges;
        let sum = l0 * (s1 + s2 - s0) + l1 * (s2 + s0 - s1) + l2 * (s0 + s1 - s2);
        let double = square.sqrt();
        let ratio = 2.0 * self.area / double;
        let angle = 0.25 * sum / (square * ratio);
        self.area * (weights.angle * angle + weights.area * 0.5 * (ratio + 1.0 / ratio))
            + weights.barrier * (s0 + s1 + s2) / double
    }
}

/// A point well inside the kernel of a star, the part of the sphere that sees the whole ring from the
/// right side: the mean of the kernel's corners.
pub(crate) fn kernel_point(star: &[Corner]) -> Option<Vector3<f64>> {
    let normals: Vec<Vector3<f64>> = star
        .iter()
        .map(|c| c.normal.try_normalize(0.0))
        .collect::<Option<_>>()?;
    let mut corners: Vec<Vector3<f64>> = Vec::new();
    for (i, n) in normals.iter().enumerate() {
        for m in &normals[i + 1..] {
            let Some(direction) = n.cross(m).try_normalize(1e-12) else {
                continue;
            };
            for x in [direction, -direction] {
                let seen = normals.iter().all(|k| k.dot(&x) > -1e-12);
                if seen && corners.iter().all(|c| (c - x).norm_squared() > 1e-24) {
                    corners.push(x);
                }
            }
        }
    }
    if corners.len() < 3 {
        return None;
    }
    let x = corners.iter().sum::<Vector3<f64>>().try_normalize(1e-300)?;
    normals.iter().all(|k| k.dot(&x) > 0.0).then_some(x)
}
