//! Orthonormality, values and Laplacians of all Y_{l,m}.

use nalgebra::{DMatrix, Vector3};
use rayon::prelude::*;
use sph::direction::{even_directions, retract, tangent_frame};
use sph::grid::RingGrid;
use sph::{Basis, Coefficients, Direction, SphericalCoords, index};

use super::findings::{Eigenfunctions, Settings};

/// Measures the errors of all functions up to the degree of the settings.
pub fn measure(settings: &Settings) -> Eigenfunctions {
    let basis = Basis::new(settings.degree);
    let mut directions = even_directions(settings.directions);
    directions.extend([Vector3::z_axis(), -Vector3::z_axis()]);
    let laplacian_error_by_degree: Vec<f64> = (0..=settings.degree)
        .into_par_iter()
        .map(|l| laplacian_error(&basis, l, &directions))
        .collect();
    let largest = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
    let differences: Vec<f64> = (0..=settings.degree)
        .into_par_iter()
        .map(|l| difference_error(l, &directions))
        .collect();
    Eigenfunctions {
        degree: settings.degree,
        functions: basis.len(),
        orthonormality_error: orthonormality_error(&basis),
        formula_error: formula_error(&basis, &directions),
        laplacian_error: largest(&laplacian_error_by_degree),
        difference_laplacian_error: largest(&differences),
        laplacian_error_by_degree,
    }
}

/// max |∫ Y_a Y_b − δ_ab| with Gauss–Legendre rings exact beyond degree 2L.
fn orthonormality_error(basis: &Basis) -> f64 {
    let grid = RingGrid::gauss_legendre(basis.degree() + 1, 2 * basis.degree() + 2);
    let cell = std::f64::consts::TAU / grid.longitudes() as f64;
    let points = grid.rings().len() * grid.longitudes();
    let mut table = DMatrix::zeros(basis.len(), points);
    let mut work = basis.workspace();
    let mut values = vec![0.0; basis.len()];
    for (j, (&(sin, cos), weight)) in grid.rings().iter().zip(grid.weights()).enumerate() {
        for k in 0..grid.longitudes() {
            let (y, x) = (cell * k as f64).sin_cos();
            let p = Direction::new_unchecked(Vector3::new(sin * x, sin * y, cos));
            basis.values(&p, &mut work, &mut values);
            let scale = (weight * cell).sqrt();
            let mut column = table.column_mut(j * grid.longitudes() + k);
            for (entry, value) in column.iter_mut().zip(&values) {
                *entry = scale * value;
            }
        }
    }
    let products = &table * table.transpose();
    (products - DMatrix::identity(basis.len(), basis.len())).amax()
}

/// √((2l+1)/4π), the largest value of any Y_{l,m}.
fn largest_value(l: usize) -> f64 {
    ((2 * l + 1) as f64 / (4.0 * std::f64::consts::PI)).sqrt()
}

fn eigenvalue(l: usize) -> f64 {
    -((l * (l + 1)) as f64)
}

fn orders(l: usize) -> impl Iterator<Item = isize> {
    let l = l as isize;
    -l..=l
}

fn laplacian_error(basis: &Basis, l: usize, directions: &[Direction]) -> f64 {
    let scale = largest_value(l) * eigenvalue(l).abs().max(1.0);
    let mut work = basis.workspace();
    let mut beta = Coefficients::zeros(basis.degree());
    let mut worst = 0.0_f64;
    for m in orders(l) {
        let position = index::position(l, m);
        beta.as_mut_slice()[position] = 1.0;
        for p in directions {
            let jet = basis.jet(&beta, p, &mut work);
            let error = jet.hessian.trace() - eigenvalue(l) * jet.value;
            worst = worst.max(error.abs() / scale);
        }
        beta.as_mut_slice()[position] = 0.0;
    }
    worst
}

fn formula_error(basis: &Basis, directions: &[Direction]) -> f64 {
    let mut work = basis.workspace();
    let mut values = vec![0.0; basis.len()];
    let mut worst = 0.0_f64;
    for p in directions {
        basis.values(p, &mut work, &mut values);
        for (position, value) in values.iter().enumerate() {
            let (l, m) = index::degree_order(position);
            worst = worst.max((value - paper_formula(l, m, p)).abs() / largest_value(l));
        }
    }
    worst
}

/// Fourth-order second differences along two great circles that cross at right angles.
fn difference_error(l: usize, directions: &[Direction]) -> f64 {
    let scale = largest_value(l) * eigenvalue(l).abs().max(1.0);
    let h = 0.01 / (l + 1) as f64;
    let mut worst = 0.0_f64;
    for p in directions {
        let (e1, e2) = tangent_frame(p);
        for m in orders(l) {
            let along = |v: &Vector3<f64>, s: f64| paper_formula(l, m, &retract(p, &(v * s)));
            let here = paper_formula(l, m, p);
            let second = |v: &Vector3<f64>| {
                let near = along(v, h) + along(v, -h);
                let far = along(v, 2.0 * h) + along(v, -2.0 * h);
                (16.0 * near - far - 30.0 * here) / (12.0 * h * h)
            };
            let error = second(&e1) + second(&e2) - eigenvalue(l) * here;
            worst = worst.max(error.abs() / scale);
        }
    }
    worst
}

/// Y_{l,m} as Sec. II-C writes it: c_{l,m}, P_l^{|m|}(cos θ) without phase, sin or cos of |m|φ.
///
/// A reference for tests: factorials and unnormalised Legendre polynomials overflow beyond about l
/// = 80.
pub fn paper_formula(l: usize, m: isize, p: &Direction) -> f64 {
    let SphericalCoords { theta, phi } = SphericalCoords::from_direction(p);
    let order = m.unsigned_abs();
    let factorials: f64 = (l - order + 1..=l + order).map(|k| k as f64).product();
    let c = ((2 * l + 1) as f64 / (std::f64::consts::TAU * factorials)).sqrt();
    let legendre = associated_legendre(l, order, theta);
    let angle = order as f64 * phi;
    match m.signum() {
        -1 => c * legendre * angle.sin(),
        0 => c / std::f64::consts::SQRT_2 * legendre,
        _ => c * legendre * angle.cos(),
    }
}

/// P_l^m(cos θ) by P_m^m = (2m−1)!! sinᵐθ and the upward recurrence in l.
fn associated_legendre(l: usize, m: usize, theta: f64) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let mut before = 0.0;
    let mut here: f64 = (0..m).map(|k| (2 * k + 1) as f64 * sin).product();
    for k in m + 1..=l {
        let next = ((2 * k - 1) as f64 * cos * here - (k + m - 1) as f64 * before) / (k - m) as f64;
        before = here;
        here = next;
    }
    here
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_errors_are_rounding() {
        let found = measure(&Settings {
            degree: 12,
            directions: 25,
        });
        assert_eq!(found.functions, 169);
        assert!(found.orthonormality_error <= 1e-13, "{found:?}");
        assert!(found.formula_error <= 1e-13, "{found:?}");
        assert!(found.laplacian_error <= 1e-13, "{found:?}");
        assert!(found.difference_laplacian_error <= 1e-8, "{found:?}");
    }
}
