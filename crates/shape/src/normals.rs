//! The normal f_u × f_v of a map S² → R³ as a function on the sphere.

use nalgebra::Vector3;
use sph::batch::values_and_gradients;
use sph::grid::RingGrid;
use sph::{Coefficients, Direction};

use crate::rotation_field::rotational_gradient;

/// Directions of a grid's points, ring after ring.
pub(crate) fn grid_directions(grid: &RingGrid) -> Vec<Vector3<f64>> {
    let step = std::f64::consts::TAU / grid.longitudes() as f64;
    let turns: Vec<(f64, f64)> = (0..grid.longitudes())
        .map(|k| (step * k as f64).sin_cos())
        .collect();
    let ring = |&(s, z): &(f64, f64)| turns.iter().map(move |(sin, cos)| [s * cos, s * sin, z]);
    grid.rings()
        .iter()
        .flat_map(ring)
        .map(Vector3::from)
        .collect()
}

/// f_u × f_v on a grid: N_x = p·(∇y × ∇z) = p·((p×∇y) × (p×∇z)), and cyclically for y and z.
///
/// Nine syntheses; exact, poles included.
pub(crate) fn normals(coordinates: &[Coefficients; 3], grid: &RingGrid) -> Vec<Vector3<f64>> {
    let fields = coordinates.each_ref().map(|c| {
        let parts = rotational_gradient(c);
        parts.map(|part| grid.synthesis(&part).values)
    });
    let at = |axis: usize, i: usize| {
        let [x, y, z] = &fields[axis];
        Vector3::new(x[i], y[i], z[i])
    };
    grid_directions(grid)
        .iter()
        .enumerate()
        .map(|(i, p)| normal(p, [at(0, i), at(1, i), at(2, i)]))
        .collect()
}

/// f_u × f_v at single points, by direct sums: 20 L² flops per point, accurate to rounding.
pub(crate) fn normals_at(
    coordinates: &[Coefficients; 3],
    directions: &[Direction],
) -> Vec<Vector3<f64>> {
    let [x, y, z] = coordinates
        .each_ref()
        .map(|c| values_and_gradients(c, directions));
    let gradients = x.iter().zip(&y).zip(&z).zip(directions);
    gradients
        .map(|(((x, y), z), p)| normal(p, [x.gradient, y.gradient, z.gradient]))
        .collect()
}

/// N from p and the (rotated) gradients of x, y, z there.
fn normal(p: &Vector3<f64>, [a, b, c]: [Vector3<f64>; 3]) -> Vector3<f64> {
    Vector3::new(
        p.dot(&b.cross(&c)),
        p.dot(&c.cross(&a)),
        p.dot(&a.cross(&b)),
    )
}
