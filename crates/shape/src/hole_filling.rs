//! Radii for directions without points: harmonic continuation over the holes of a cloud.

use std::borrow::Cow;

use sph::Direction;

use crate::point_cloud::RadialSamples;
use crate::sphere_partition::SpherePartition;

/// Number of Gauss–Seidel sweeps; holes are at most a few dozen cells wide.
const SWEEPS: usize = 200;

/// The samples, followed by one for every unobserved direction; borrowed where there is none.
///
/// Smoothness alone does not bound a surface over a hole as wide as half the sphere. The value for
/// an unobserved direction is the harmonic continuation of the radii around the hole (a discrete
/// Laplace equation on cells), so it stays between the least and the largest radius at the rim. It
/// has the weight of one point of the cloud.
pub(crate) fn fill_holes<'a>(
    samples: &'a RadialSamples,
    unobserved: &[Direction],
) -> Cow<'a, RadialSamples> {
    if unobserved.is_empty() || samples.radii.is_empty() {
        return Cow::Borrowed(samples);
    }
    let radii = membrane(samples);
    let cells = SpherePartition::for_views(samples.radii.len());
    let mut filled = samples.clone();
    filled.directions.extend_from_slice(unobserved);
    let new = unobserved.iter().map(|p| radii[cells.index(p)]);
    filled.radii.extend(new);
    Cow::Owned(filled)
}

/// Mean radius of every observed cell, and the mean of the neighbours for every other cell.
fn membrane(samples: &RadialSamples) -> Vec<f64> {
    let cells = SpherePartition::for_views(samples.radii.len());
    let mut sums = vec![(0.0, 0_usize); cells.count()];
    for (p, r) in samples.directions.iter().zip(&samples.radii) {
        let (sum, count) = &mut sums[cells.index(p)];
        *sum += r;
        *count += 1;
    }
    let mean = samples.radii.iter().sum::<f64>() / samples.radii.len() as f64;
    let value = |&(sum, count): &(f64, usize)| if count > 0 { sum / count as f64 } else { mean };
    let mut radii: Vec<f64> = sums.iter().map(value).collect();
    let holes: Vec<(usize, Vec<usize>)> = (0..cells.count())
        .filter(|cell| sums[*cell].1 == 0)
        .map(|cell| (cell, cells.neighbours(cell)))
        .collect();
    for _ in 0..SWEEPS {
        for (cell, around) in &holes {
            let sum: f64 = around.iter().map(|k| radii[*k]).sum();
            radii[*cell] = sum / around.len() as f64;
        }
    }
    radii
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::measure_visibility;
    use sph::direction::even_directions;

    #[test]
    fn a_hole_is_spanned_from_its_rim() {
        let directions: Vec<Direction> = even_directions(30_000)
            .into_iter()
            .filter(|p| p.x < 0.6)
            .collect();
        let samples = RadialSamples {
            radii: directions.iter().map(|p| 0.05 + 0.02 * p.x).collect(),
            directions,
        };
        let visibility = measure_visibility(&samples);
        let filled = fill_holes(&samples, &visibility.unobserved_directions);
        assert_eq!(
            filled.directions.len(),
            samples.radii.len() + visibility.unobserved_directions.len()
        );
        let new = &filled.radii[samples.radii.len()..];
        assert!(new.len() > 5);
        // The rim lies between x = 0.35 and x = 0.6.
        assert!(new.iter().all(|r| (0.055..=0.0625).contains(r)), "{new:?}");
    }
}
