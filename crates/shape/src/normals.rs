//! The normal f_u × f_v of a map S² → R³ as a function on the sphere.

use nalgebra::Vector3;
use sph::field::Field;
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

/// f_u × f_v on a grid: N_x = p·(∇y × ∇z) = p·((p×∇y) × (p×∇z)), and so on round.
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
        .map(|(i, p)| {
            let [a, b, c] = [at(0, i), at(1, i), at(2, i)];
            Vector3::new(
                p.dot(&b.cross(&c)),
                p.dot(&c.cross(&a)),
                p.dot(&a.cross(&b)),
            )
        })
        .collect()
}

/// f_u × f_v at single points: three fields, a few microseconds a point.
pub(crate) struct NormalField {
    coordinates: [Field; 3],
}

impl NormalField {
    /// Good to about 1e-10 of the largest normal.
    pub(crate) fn new(coordinates: &[Coefficients; 3]) -> Self {
        Self {
            coordinates: coordinates.each_ref().map(Field::new),
        }
    }

    /// N(p), m².
    pub(crate) fn at(&self, p: &Direction) -> Vector3<f64> {
        let [a, b, c] = self
            .coordinates
            .each_ref()
            .map(|field| field.jet(p).gradient);
        Vector3::new(
            p.dot(&b.cross(&c)),
            p.dot(&c.cross(&a)),
            p.dot(&a.cross(&b)),
        )
    }
}
