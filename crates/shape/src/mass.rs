//! Volume, centroid and inertia of the solid that a radial surface encloses.

use nalgebra::{Matrix3, Point3, Vector3};
use sph::Coefficients;
use sph::grid::RingGrid;

/// Mass properties at unit density, in the frame of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// m³.
    pub volume: f64,
    /// Metres.
    pub centroid: Point3<f64>,
    /// Inertia about the centroid for a density of 1 kg/m³, kg·m².
    pub inertia: Matrix3<f64>,
}

/// Integrals over the solid r ≤ r(p): ∫dV = ∫r³/3, ∫x dV = ∫r⁴/4 p, ∫xxᵀ dV = ∫r⁵/5 ppᵀ.
///
/// Gauss–Legendre quadrature exact for r⁵ pᵢ pⱼ, degree 5L+2; about 60 L³ flops.
pub fn radial(beta: &Coefficients) -> MassProperties {
    let exact = 5 * beta.degree() + 3;
    let grid = RingGrid::gauss_legendre(exact.div_ceil(2), exact);
    let values = grid.synthesis(beta);
    let cell = std::f64::consts::TAU / grid.longitudes() as f64;
    let turns: Vec<(f64, f64)> = (0..grid.longitudes())
        .map(|k| (cell * k as f64).sin_cos())
        .collect();
    let mut volume = 0.0;
    let mut first = Vector3::zeros();
    let mut second = Matrix3::zeros();
    let rings = grid.rings().iter().zip(grid.weights());
    for ((&(sin_theta, cos_theta), weight), radii) in
        rings.zip(values.values.chunks(grid.longitudes()))
    {
        for (&(sin, cos), &r) in turns.iter().zip(radii) {
            let p = Vector3::new(sin_theta * cos, sin_theta * sin, cos_theta);
            let cube = weight * cell * r * r * r;
            volume += cube / 3.0;
            first += p * (cube * r / 4.0);
            second += p * p.transpose() * (cube * r * r / 5.0);
        }
    }
    let centroid = first / volume;
    let central = second - centroid * centroid.transpose() * volume;
    MassProperties {
        volume,
        centroid: Point3::from(centroid),
        inertia: Matrix3::identity() * central.trace() - central,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_has_its_volume_and_inertia() {
        let ball = radial(&Coefficients::constant(3, 0.05));
        let volume = 4.0 / 3.0 * std::f64::consts::PI * 0.05_f64.powi(3);
        assert!((ball.volume / volume - 1.0).abs() <= 1e-13);
        assert!(ball.centroid.coords.norm() <= 1e-16);
        let expected = Matrix3::identity() * (0.4 * volume * 0.05 * 0.05);
        assert!((ball.inertia - expected).norm() <= 1e-13 * expected.norm());
    }
}
