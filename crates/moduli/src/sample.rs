//! Random points of the moduli space (Sec. IV-B).

use std::ops::Range;

use nalgebra::Vector3;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};
use shape::noise::perturb_band;
use shape::{RadialError, RadialShape};
use sph::Direction;

use crate::point::ModuliPoint;

/// A direction uniform on the sphere.
pub fn uniform_direction(rng: &mut impl Rng) -> Direction {
    loop {
        let mut normal = || -> f64 { StandardNormal.sample(rng) };
        let v = Vector3::new(normal(), normal(), normal());
        if let Some(direction) = Direction::try_new(v, 1e-9) {
            return direction;
        }
    }
}

/// A shape with Gaussian noise of standard deviation `sigma` (metres) on a band of β, and uniform
/// contacts on it.
///
/// The noisy shape is certified like any other; a sample that leaves M^rad is the error, so callers
/// can count such samples and draw again.
pub fn perturbed(
    shape: &RadialShape,
    band: Range<usize>,
    sigma: f64,
    contacts: usize,
    rng: &mut impl Rng,
) -> Result<ModuliPoint<RadialShape>, RadialError> {
    let noisy = perturb_band(shape.coefficients(), band, sigma, rng);
    let contacts = (0..contacts).map(|_| uniform_direction(rng)).collect();
    Ok(ModuliPoint {
        surface: RadialShape::new(noisy)?,
        contacts,
    })
}
