//! Gaussian noise on a band of coefficients (Sec. IV-B of the paper).

use std::ops::Range;

use rand::Rng;
use rand_distr::{Distribution, Normal};
use sph::Coefficients;

/// Adds independent N(0, sigma²) noise to the coefficients at positions `band`.
///
/// The paper perturbs positions 0…9 and 499…599. Positions beyond the degree are ignored; sigma is
/// in metres and its sign does not matter. A sigma that is not finite changes nothing.
pub fn perturb_band(
    beta: &Coefficients,
    band: Range<usize>,
    sigma: f64,
    rng: &mut impl Rng,
) -> Coefficients {
    let mut noisy = beta.clone();
    let Ok(normal) = Normal::new(0.0, sigma.abs()) else {
        return noisy;
    };
    let values = noisy.as_mut_slice();
    let end = band.end.min(values.len());
    for value in &mut values[band.start.min(end)..end] {
        *value += normal.sample(rng);
    }
    noisy
}
