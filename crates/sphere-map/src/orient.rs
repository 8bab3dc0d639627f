//! The surface near the points: an implicit function from oriented normals.

use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use crate::carve::Carving;
use crate::lattice::Lattice;

/// Width of the Gaussian weights and their reach, in spacings.
const WIDTH: f64 = 0.8;
const REACH: f64 = 2.4;
/// Outside vertices up to this multiple of the distance of the nearest one decide about the sign.
const LEEWAY: f64 = 1.25;

/// Turns every normal towards the outside, and tells which points see it.
///
/// `probe` is the radius to which the outside came near the points. A point sees the outside if a
/// vertex of the outside is within `sight`.
pub(crate) fn orient(
    lattice: &Lattice,
    carving: &Carving,
    points: &[Point3<f64>],
    normals: &mut [Vector3<f64>],
    probe: f64,
    sight: f64,
) -> Vec<bool> {
    points
        .par_iter()
        .zip(normals)
        .map(|(p, normal)| {
            let mut reach = LEEWAY * (probe + lattice.step);
            loop {
                let (nearest, side) = outside(lattice, carving, p, normal, reach);
                if nearest * LEEWAY <= reach || reach >= sight {
                    if side < 0.0 {
                        *normal = -*normal;
                    }
                    return nearest <= sight;
                }
                reach = if nearest.is_finite() {
                    nearest * LEEWAY * (1.0 + 1e-12)
                } else {
                    2.0 * reach
                };
            }
        })
        .collect()
}

/// Distance of the nearest outside vertex, and on which side of the plane the nearest ones lie.
fn outside(
    lattice: &Lattice,
    carving: &Carving,
    p: &Point3<f64>,
    normal: &Vector3<f64>,
    reach: f64,
) -> (f64, f64) {
    let mut nearest = f64::INFINITY;
    lattice.visit(p, reach, |at, squared, _| {
        if !carving.inside[at] {
            nearest = nearest.min(squared);
        }
    });
    let limit = nearest * LEEWAY * LEEWAY;
    let mut side = 0.0;
    lattice.visit(p, reach, |at, squared, offset| {
        if !carving.inside[at] && squared <= limit {
            side += offset.dot(normal);
        }
    });
    (nearest.sqrt(), side)
}

/// Σ w nᵢ·(x − pᵢ) / Σ w at the vertices near the points; NaN elsewhere.
///
/// w is a Gaussian of the distance times max(0, nᵢ·n₀)², n₀ the normal of the point nearest to x, so
/// that the far side of a thin wall has no influence.
pub(crate) fn signed_distances(
    lattice: &Lattice,
    points: &[Point3<f64>],
    normals: &[Vector3<f64>],
    nearest: &[u32],
    seen: &[bool],
    spacing: f64,
) -> Vec<f32> {
    let mut sums = vec![[0.0_f32; 2]; lattice.len()];
    let scale = -0.5 / (WIDTH * spacing).powi(2);
    for ((p, n), _) in points.iter().zip(normals).zip(seen).filter(|(_, s)| **s) {
        lattice.visit(p, REACH * spacing, |at, squared, offset| {
            let Some(first) = normals.get(nearest[at] as usize) else {
                return;
            };
            let agreement = n.dot(first).max(0.0);
            let weight = (scale * squared).exp() * agreement * agreement;
            sums[at][0] += weight as f32;
            sums[at][1] += (weight * offset.dot(n)) as f32;
        });
    }
    sums.iter().map(|[w, sum]| sum / w).collect()
}
