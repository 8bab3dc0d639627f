//! The noise of a laser scan.

use nalgebra::{Point3, Vector3};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

/// Gaussian noise along the surface normal, larger at grazing incidence.
///
/// The scanner looks at a turntable from a fixed elevation, and scans the object a second time
/// upside down. A point with outward unit normal n is seen best when its side of the turntable
/// faces the scanner, at an incidence angle a with cos a = |n_xy| cos e + |n_z| sin e. Its noise
/// has the standard deviation σ(n) = sigma (1 + grazing (1 − cos a)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanNoise {
    /// Standard deviation at normal incidence, metres.
    pub sigma: f64,
    /// Relative increase from normal incidence to fully grazing incidence.
    pub grazing: f64,
    /// Elevation e of the scanner above the turntable, radians.
    pub elevation: f64,
}

impl ScanNoise {
    /// No noise: every point is on the true surface.
    pub const NONE: Self = Self {
        sigma: 0.0,
        grazing: 0.0,
        elevation: 0.0,
    };

    /// A laser scanner for household objects: 0.35 mm at normal incidence, up to 0.52 mm at grazing
    /// angles.
    pub const LASER_SCANNER: Self = Self {
        sigma: 0.35e-3,
        grazing: 1.0,
        elevation: std::f64::consts::FRAC_PI_6,
    };

    /// Standard deviation on a surface with outward unit normal n, metres.
    pub fn deviation(&self, normal: &Vector3<f64>) -> f64 {
        let (sin, cos) = self.elevation.sin_cos();
        let incidence = normal.x.hypot(normal.y) * cos + normal.z.abs() * sin;
        self.sigma * (1.0 + self.grazing * (1.0 - incidence))
    }

    /// The surface point with noise along its normal.
    pub(crate) fn disturb(
        &self,
        point: Point3<f64>,
        normal: &Vector3<f64>,
        rng: &mut impl Rng,
    ) -> Point3<f64> {
        let draw: f64 = rng.sample(StandardNormal);
        point + normal * (draw * self.deviation(normal))
    }
}

impl Default for ScanNoise {
    fn default() -> Self {
        Self::LASER_SCANNER
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_view_has_the_least_noise() {
        let noise = ScanNoise::default();
        let (sin, cos) = noise.elevation.sin_cos();
        let facing = noise.deviation(&Vector3::new(0.0, cos, sin));
        assert!((facing - noise.sigma).abs() <= 1e-15);
        for normal in [Vector3::x(), Vector3::z(), -Vector3::z()] {
            let deviation = noise.deviation(&normal);
            assert!(deviation > noise.sigma && deviation <= 0.53e-3);
        }
    }
}
