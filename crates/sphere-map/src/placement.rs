//! Images of the vertices on the sphere, moved one at a time and never through an edge.

use nalgebra::Vector3;

use crate::energy::{Corner, Weights, kernel_point};
use crate::rings::Rings;

/// Step of the differences, as a share of the nearest neighbour's distance and of the least height.
const STEP: f64 = 1e-3;
const HEIGHT_SHARE: f64 = 0.2;
/// Below this share of the nearest neighbour's distance the vertex moves to the middle of its kernel.
const THIN: f64 = 0.1;
/// Steps are shortened by this factor until the energy falls, at most so often.
const SHORTENING: f64 = 0.4;
const TRIES: usize = 8;

/// The images of the vertices that a mesh has at the moment.
pub(crate) struct Placement<'a> {
    /// The mesh, scaled to an area of 4π.
    pub(crate) mesh: &'a [Vector3<f64>],
    pub(crate) images: Vec<Vector3<f64>>,
    pub(crate) rings: Rings,
    star: Vec<Corner>,
}

impl<'a> Placement<'a> {
    pub(crate) fn new(mesh: &'a [Vector3<f64>], rings: Rings) -> Self {
        Self {
            images: vec![Vector3::zeros(); mesh.len()],
            mesh,
            rings,
            star: Vec::new(),
        }
    }

    /// Fills the star of a vertex.
    fn gather(&mut self, v: u32) {
        let star = star(self.mesh, &self.images, v, self.rings.ring(v));
        self.star.clear();
        self.star.extend(star);
    }

    /// A point of the kernel of the ring of a vertex, which need not be there yet, and how thick the
    /// kernel is there: the least height over the length of its edge.
    pub(crate) fn kernel(&self, v: u32, ring: &[u32]) -> Option<(Vector3<f64>, f64)> {
        let star: Vec<Corner> = star(self.mesh, &self.images, v, ring).collect();
        let x = kernel_point(&star)?;
        let thickness = star
            .iter()
            .map(|c| c.height(&x) / (c.a - c.b).norm())
            .fold(f64::INFINITY, f64::min);
        Some((x, thickness))
    }

    /// Moves a vertex to a place of less energy in its star, if it finds one: a step of Newton in the
    /// tangent plane. Returns by how much the energy fell.
    pub(crate) fn relax(&mut self, v: u32, weights: &Weights) -> f64 {
        self.gather(v);
        let star = &self.star;
        let here = self.images[v as usize];
        let energy = |x: &Vector3<f64>| -> f64 { star.iter().map(|c| c.energy(weights, x)).sum() };
        let before = energy(&here);
        let nearest = star
            .iter()
            .map(|c| (c.a - here).norm_squared())
            .fold(f64::INFINITY, f64::min)
            .sqrt();
        let height = star
            .iter()
            .map(|c| c.height(&here))
            .fold(f64::INFINITY, f64::min);
        if (height < THIN * nearest || !before.is_finite())
            && let Some(x) = kernel_point(star)
        {
            let after = energy(&x);
            if after < before {
                self.images[v as usize] = x;
                return if before.is_finite() {
                    before - after
                } else {
                    1.0
                };
            }
        }
        if !(height > 0.0 && before.is_finite()) {
            return 0.0;
        }
        let (e1, e2) = tangents(&here);
        let at = |x: f64, y: f64| (here + e1 * x + e2 * y).normalize();
        let d = (STEP * nearest).min(HEIGHT_SHARE * height);
        let Some((mut x, mut y)) = newton_step(|x, y| energy(&at(x, y)), before, d, nearest) else {
            return 0.0;
        };
        for _ in 0..TRIES {
            let place = at(x, y);
            let after = energy(&place);
            if after < before {
                self.images[v as usize] = place;
                return before - after;
            }
            x *= SHORTENING;
            y *= SHORTENING;
        }
        0.0
    }

    /// The energy of all triangles, every triangle once.
    pub(crate) fn total(&mut self, weights: &Weights) -> f64 {
        let mut sum = 0.0;
        for v in 0..self.images.len() as u32 {
            if self.rings.ring(v).is_empty() {
                continue;
            }
            self.gather(v);
            let x = self.images[v as usize];
            sum += self.star.iter().map(|c| c.energy(weights, &x)).sum::<f64>();
        }
        sum / 3.0
    }
}

/// The triangles of a vertex and its ring.
fn star<'a>(
    mesh: &'a [Vector3<f64>],
    images: &'a [Vector3<f64>],
    v: u32,
    ring: &'a [u32],
) -> impl Iterator<Item = Corner> + 'a {
    let place = |w: u32| mesh[w as usize];
    ring.iter().enumerate().map(move |(k, &a)| {
        let b = ring[(k + 1) % ring.len()];
        Corner::new(
            [place(v), place(a), place(b)],
            images[a as usize],
            images[b as usize],
        )
    })
}

/// Newton's step from differences of width d, or one downhill; at most `most` long.
fn newton_step(f: impl Fn(f64, f64) -> f64, f0: f64, d: f64, most: f64) -> Option<(f64, f64)> {
    let (right, left, up, down) = (f(d, 0.0), f(-d, 0.0), f(0.0, d), f(0.0, -d));
    let corner = f(d, d);
    if !(right + left + up + down + corner).is_finite() {
        return None;
    }
    let (gx, gy) = ((right - left) / (2.0 * d), (up - down) / (2.0 * d));
    let hxx = (right + left - 2.0 * f0) / (d * d);
    let hyy = (up + down - 2.0 * f0) / (d * d);
    let hxy = (corner - right - up + f0) / (d * d);
    let determinant = hxx * hyy - hxy * hxy;
    let convex = determinant > 1e-8 * (hxx * hxx + hyy * hyy) && hxx > 0.0;
    let (x, y) = if convex {
        (
            -(hyy * gx - hxy * gy) / determinant,
            -(hxx * gy - hxy * gx) / determinant,
        )
    } else {
        let size = 0.3 * most / gx.hypot(gy).max(1e-300);
        (-gx * size, -gy * size)
    };
    let shorten = (most / x.hypot(y)).min(1.0);
    Some((x * shorten, y * shorten))
}

/// Two unit vectors that are orthogonal to a unit vector and to each other.
fn tangents(p: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let axis = if p.x.abs() < 0.6 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let e1 = p.cross(&axis).normalize();
    (e1, p.cross(&e1))
}
