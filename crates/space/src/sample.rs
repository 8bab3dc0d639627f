//! Random points of the moduli space (Sec. IV-B).

use std::ops::Range;

use nalgebra::Vector3;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};
use shape::noise::perturb_band;
use shape::{RadialError, RadialShape, SphericalError, SphericalShape};
use sph::Direction;
use sph::direction::{retract, tangent_frame};

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
/// The noisy shape is certified like any other.
///
/// # Errors
/// The sample is not in M^rad, so that callers can count such samples and draw again.
pub fn perturbed(
    shape: &RadialShape,
    band: Range<usize>,
    sigma: f64,
    contacts: usize,
    rng: &mut impl Rng,
) -> Result<ModuliPoint<RadialShape>, RadialError> {
    let noisy = perturb_band(shape.coefficients(), band, sigma, rng);
    let directions = (0..contacts).map(|_| uniform_direction(rng)).collect();
    Ok(ModuliPoint {
        surface: RadialShape::new(noisy)?,
        directions,
    })
}

/// The distribution of contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactSampling<'a> {
    /// This many contacts, uniform on the sphere.
    Uniform(usize),
    /// One contact around each of these directions, displaced by a tangent vector whose two
    /// coordinates have this standard deviation, radians.
    Around(&'a [Direction], f64),
}

impl ContactSampling<'_> {
    /// Draws contacts.
    pub fn draw(&self, rng: &mut impl Rng) -> Vec<Direction> {
        match *self {
            Self::Uniform(count) => (0..count).map(|_| uniform_direction(rng)).collect(),
            Self::Around(directions, deviation) => directions
                .iter()
                .map(|p| {
                    let (e1, e2) = tangent_frame(p);
                    let mut normal = || -> f64 { StandardNormal.sample(rng) };
                    retract(p, &((e1 * normal() + e2 * normal()) * deviation))
                })
                .collect(),
        }
    }
}

/// A point of M^sph × (S²)^m, with noise on the same band of all three coordinates.
///
/// The noisy surface is proved an immersion ([`SphericalShape::immersion`]).
///
/// # Errors
/// The sample is not proved an immersion.
pub fn perturbed_spherical(
    shape: &SphericalShape,
    band: Range<usize>,
    sigma: f64,
    contacts: &ContactSampling,
    rng: &mut impl Rng,
) -> Result<ModuliPoint<SphericalShape>, SphericalError> {
    let [x, y, z] = shape
        .coordinates()
        .each_ref()
        .map(|c| perturb_band(c, band.clone(), sigma, rng));
    Ok(ModuliPoint {
        directions: contacts.draw(rng),
        surface: SphericalShape::new(x, y, z)?,
    })
}
