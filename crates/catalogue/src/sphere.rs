//! Perfect spheres, which the paper adds to its shape space (Sec. IV-A).

use crate::noise::ScanNoise;
use nalgebra::{Point3, Vector3};
use rand::{Rng, RngExt};
use rand_distr::UnitSphere;

/// `count` radii in equal steps from `smallest` to `largest`, both included; a single radius is
/// `smallest`.
///
/// The paper uses 30 from 0.03 m to 0.06 m.
pub fn sphere_radii(count: usize, smallest: f64, largest: f64) -> Vec<f64> {
    let steps = count.saturating_sub(1).max(1) as f64;
    (0..count)
        .map(|i| smallest + (largest - smallest) * (i as f64 / steps))
        .collect()
}

/// Area-uniform scan of a sphere of the given radius (metres) that stands on z = 0.
pub fn sphere_scan(
    radius: f64,
    points: usize,
    noise: &ScanNoise,
    rng: &mut impl Rng,
) -> Vec<Point3<f64>> {
    let centre = Point3::new(0.0, 0.0, radius);
    (0..points)
        .map(|_| {
            let normal = Vector3::from(rng.sample::<[f64; 3], _>(UnitSphere));
            noise.disturb(centre + normal * radius, &normal, rng)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn radii_span_the_range() {
        let radii = sphere_radii(30, 0.03, 0.06);
        assert!(radii.len() == 30 && radii[0] == 0.03);
        assert!((radii[29] - 0.06).abs() <= 1e-15);
        assert!(radii.windows(2).all(|w| w[1] > w[0]));
        assert!(sphere_radii(1, 0.03, 0.06) == [0.03]);
        assert!(sphere_radii(0, 0.03, 0.06).is_empty());
    }

    #[test]
    fn points_lie_around_the_radius() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let noise = ScanNoise::default();
        let cloud = sphere_scan(0.045, 20_000, &noise, &mut rng);
        let centre = Point3::new(0.0, 0.0, 0.045);
        let squares: f64 = cloud
            .iter()
            .map(|p| ((p - centre).norm() - 0.045).powi(2))
            .sum();
        let rms = (squares / cloud.len() as f64).sqrt();
        assert!((0.34e-3..=0.45e-3).contains(&rms), "rms {rms}");
        let mean = cloud.iter().map(|p| p - centre).sum::<Vector3<f64>>() / cloud.len() as f64;
        // Five standard errors of a mean of 20,000 points with standard deviation radius/√3 per
        // axis.
        assert!(mean.amax() <= 5.0 * 0.045 / (3.0f64 * 20_000.0).sqrt());
    }
}
