//! Volume, centroid and inertia of the solid that a surface encloses.

use nalgebra::{Matrix3, Point3, Vector3};
use sph::Coefficients;
use sph::grid::RingGrid;

use crate::normals::normals;

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
    from_moments(volume, first, second)
}

/// Integrals over the solid inside f = (x, y, z), by the divergence theorem with N = f_u × f_v:
/// ∫dV = ⅓∫f·N, ∫x dV = ½∫x²N_x, ∫x² dV = ⅓∫x³N_x, ∫xy dV = ½∫x²y N_x.
///
/// Gauss–Legendre quadrature exact for these, degree 5L+1; about 500 L³ flops.
pub fn spherical(coordinates: &[Coefficients; 3]) -> MassProperties {
    let exact = 5 * coordinates[0].degree() + 3;
    let grid = RingGrid::gauss_legendre(exact.div_ceil(2), exact);
    let [x, y, z] = coordinates.each_ref().map(|c| grid.synthesis(c).values);
    let cell = std::f64::consts::TAU / grid.longitudes() as f64;
    let mut volume = 0.0;
    let mut first = Vector3::zeros();
    let mut second = Matrix3::zeros();
    for (i, normal) in normals(coordinates, &grid).iter().enumerate() {
        let f = Vector3::new(x[i], y[i], z[i]);
        let area = normal * (cell * grid.weights()[i / grid.longitudes()]);
        volume += f.dot(&area) / 3.0;
        let flux = f.component_mul(&f).component_mul(&area) / 2.0;
        first += flux;
        // Off the diagonal both ways to write the integral are averaged.
        let mixed = flux * f.transpose();
        second += (mixed + mixed.transpose()) / 2.0;
        for axis in 0..3 {
            second[(axis, axis)] -= mixed[(axis, axis)] / 3.0;
        }
    }
    from_moments(volume, first, second)
}

/// Mass properties from ∫dV, ∫x dV and ∫xxᵀ dV.
fn from_moments(volume: f64, first: Vector3<f64>, second: Matrix3<f64>) -> MassProperties {
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
