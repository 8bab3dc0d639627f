//! Rotation of functions on the sphere.

use nalgebra::{Rotation3, Vector3};

use crate::coefficients::Coefficients;
use crate::direction::Direction;
use crate::fft::smooth_length;
use crate::grid::{GridValues, RingGrid};
use crate::index;
use crate::scattered::Scattered;

/// The function rotated by R: (R f)(p) = f(R⁻¹ p).
///
/// A rotation keeps the degree, so the values of f at the rotated points of a Gauss–Legendre grid
/// determine the result exactly. The only error is rounding, about 1e-14 of the largest |f|, at any
/// degree. About 1200 L² + 60 L³ flops.
pub fn rotate(beta: &Coefficients, rotation: &Rotation3<f64>) -> Coefficients {
    let degree = beta.degree();
    let grid = RingGrid::gauss_legendre(degree + 1, smooth_length(2 * degree + 2));
    let inverse = rotation.inverse();
    let turned: Vec<Direction> = grid
        .directions()
        .map(|p| Direction::new_normalize(inverse * p.into_inner()))
        .collect();
    let values = GridValues {
        longitudes: grid.longitudes(),
        values: Scattered::new(&turned).evaluate(beta),
    };
    grid.analysis(&values, degree)
}

/// The rotation that takes the axes (y, z, x) to (x, y, z).
pub(crate) fn cyclic() -> Rotation3<f64> {
    Rotation3::from_basis_unchecked(&[Vector3::z(), Vector3::x(), Vector3::y()])
}

/// The solution of the heat equation after time σ ≥ 0: β_{lm} e^{−l(l+1)σ}.
///
/// These are the weighted spherical harmonics of the paper's reference 13. The smoothing damps the
/// ringing of a truncated series. It keeps the mean, and maxima never grow. Smoothing by σ₁ and then by
/// σ₂ is smoothing by σ₁ + σ₂.
pub fn heat_flow(beta: &Coefficients, sigma: f64) -> Coefficients {
    let mut out = beta.clone();
    for (i, b) in out.as_mut_slice().iter_mut().enumerate() {
        let (l, _) = index::degree_order(i);
        *b *= (-((l * (l + 1)) as f64) * sigma).exp();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch;
    use crate::coefficients::tests::some_coefficients;
    use crate::direction::even_directions;

    #[test]
    fn the_turned_function_has_the_turned_values() {
        let rotation = Rotation3::from_euler_angles(0.7, -1.1, 2.9);
        for degree in [0, 1, 2, 9, 50] {
            let beta = some_coefficients(degree);
            let turned = rotate(&beta, &rotation);
            let points = even_directions(200);
            let back: Vec<Direction> = points
                .iter()
                .map(|p| Direction::new_normalize(rotation.inverse() * p.into_inner()))
                .collect();
            let scale = beta.distance(&Coefficients::zeros(0));
            let expected = batch::evaluate(&beta, &back);
            for (a, b) in batch::evaluate(&turned, &points).iter().zip(&expected) {
                assert!((a - b).abs() <= 1e-12 * scale * (1.0 + degree as f64));
            }
            let home = rotate(&turned, &rotation.inverse());
            assert!(home.distance(&beta) <= 1e-12 * scale);
            for (a, b) in beta.power_spectrum().iter().zip(turned.power_spectrum()) {
                assert!((a - b).abs() <= 1e-11 * scale * scale);
            }
        }
    }

    #[test]
    fn the_cyclic_rotation_renames_the_axes() {
        let p = cyclic() * Vector3::new(1.0, 2.0, 3.0);
        assert_eq!(p, Vector3::new(2.0, 3.0, 1.0));
        assert!((cyclic().matrix().determinant() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn heat_flows_add_up_and_lower_the_maximum() {
        let beta = some_coefficients(12);
        let once = heat_flow(&beta, 0.03);
        assert!(heat_flow(&once, 0.02).distance(&heat_flow(&beta, 0.05)) <= 1e-13);
        assert_eq!(once.get(0, 0), beta.get(0, 0));
        let top = |b: &Coefficients| {
            let values = batch::evaluate(b, &even_directions(4000));
            values.into_iter().fold(f64::NEG_INFINITY, f64::max)
        };
        assert!(top(&once) < top(&beta));
    }
}
