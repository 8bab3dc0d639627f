//! Identities that hold for all functions: addition theorem, orthonormality, isometry, adjointness.

use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use sph::direction::even_directions;
use sph::grid::RingGrid;
use sph::rotation::{heat_flow, rotate};
use sph::scattered::Scattered;
use sph::{Basis, Coefficients, Direction, Field, batch, bounds, index};

fn coefficients(degree: usize) -> impl Strategy<Value = Coefficients> {
    prop::collection::vec(-1.0..1.0_f64, index::count(degree))
        .prop_map(|values| Coefficients::new(values).expect("finite and (L+1)² long"))
}

fn direction() -> impl Strategy<Value = Direction> {
    (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64)
        .prop_filter("away from the origin", |(x, y, z)| {
            x * x + y * y + z * z > 1e-3
        })
        .prop_map(|(x, y, z)| Direction::new_normalize(Vector3::new(x, y, z)))
}

fn inner(a: &Coefficients, b: &Coefficients) -> f64 {
    a.as_slice()
        .iter()
        .zip(b.as_slice())
        .map(|(a, b)| a * b)
        .sum()
}

fn norm(a: &Coefficients) -> f64 {
    inner(a, a).sqrt()
}

/// P_l(x) by its recurrence.
fn legendre(l: usize, x: f64) -> f64 {
    let (mut before, mut here) = (0.0, 1.0);
    for k in 0..l {
        let k = k as f64;
        (before, here) = (here, ((2.0 * k + 1.0) * x * here - k * before) / (k + 1.0));
    }
    here
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn addition_theorem(p in direction(), q in direction()) {
        let degree = 60;
        let basis = Basis::new(degree);
        let mut work = basis.workspace();
        let (mut at_p, mut at_q) = (vec![0.0; basis.len()], vec![0.0; basis.len()]);
        basis.values(&p, &mut work, &mut at_p);
        basis.values(&q, &mut work, &mut at_q);
        for l in 0..=degree {
            let sum: f64 = (l * l..(l + 1) * (l + 1)).map(|i| at_p[i] * at_q[i]).sum();
            let scale = (2 * l + 1) as f64 / (4.0 * std::f64::consts::PI);
            prop_assert!((sum - scale * legendre(l, p.dot(&q))).abs() <= 1e-12 * scale);
        }
    }

    #[test]
    fn the_norm_is_that_of_the_coefficients(a in coefficients(100), b in coefficients(100)) {
        // Orthonormality to degree 100, by quadrature of the product of two random functions.
        let grid = RingGrid::gauss_legendre(101, 216);
        let (fa, fb) = (grid.synthesis(&a), grid.synthesis(&b));
        let cell = std::f64::consts::TAU / 216.0;
        let weight = |i: usize| grid.weights()[i / 216] * cell;
        let product: f64 = (0..fa.values.len()).map(|i| weight(i) * fa.values[i] * fb.values[i]).sum();
        prop_assert!((product - inner(&a, &b)).abs() <= 1e-12 * norm(&a) * norm(&b));
        let square: f64 = (0..fa.values.len())
            .map(|i| weight(i) * (fa.values[i] - fb.values[i]).powi(2))
            .sum();
        prop_assert!((square.sqrt() - a.distance(&b)).abs() <= 1e-12 * a.distance(&b));
    }

    #[test]
    fn evaluation_and_moments_are_adjoint(a in coefficients(24), weights in prop::collection::vec(-1.0..1.0_f64, 700)) {
        let points = even_directions(weights.len());
        let scattered = Scattered::new(&points);
        for (values, moments) in [
            (batch::evaluate(&a, &points), batch::moments(&points, &weights, 24)),
            (scattered.evaluate(&a), scattered.moments(&weights, 24)),
        ] {
            let left: f64 = values.iter().zip(&weights).map(|(v, w)| v * w).sum();
            let scale: f64 = values.iter().zip(&weights).map(|(v, w)| (v * w).abs()).sum();
            prop_assert!((left - inner(&a, &moments)).abs() <= 1e-12 * scale);
        }
    }

    #[test]
    fn rotation_is_an_isometry(a in coefficients(20), b in coefficients(20), axis in direction(), angle in -3.0..3.0_f64) {
        let turn = Rotation3::from_axis_angle(&axis, angle);
        let (ra, rb) = (rotate(&a, &turn), rotate(&b, &turn));
        prop_assert!((ra.distance(&rb) - a.distance(&b)).abs() <= 1e-12 * a.distance(&b));
        prop_assert!(rotate(&ra, &turn.inverse()).distance(&a) <= 1e-12 * norm(&a));
        for (x, y) in a.power_spectrum().iter().zip(ra.power_spectrum()) {
            prop_assert!((x - y).abs() <= 1e-12 * norm(&a).powi(2));
        }
        // Heat flows the same way in every frame.
        prop_assert!(heat_flow(&ra, 0.01).distance(&rotate(&heat_flow(&a, 0.01), &turn)) <= 1e-12 * norm(&a));
    }

    #[test]
    fn certified_bounds_hold_and_combine(a in coefficients(12), b in coefficients(12), t in 0.0..1.0_f64) {
        let (ra, rb) = (bounds::tight_range(&a, 1e-2), bounds::tight_range(&b, 1e-2));
        let mix = Coefficients::combination([(1.0 - t, &a), (t, &b)]);
        let low = (1.0 - t) * ra.lower + t * rb.lower;
        let high = (1.0 - t) * ra.upper + t * rb.upper;
        for v in batch::evaluate(&mix, &even_directions(3000)) {
            prop_assert!(low <= v && v <= high);
        }
        for (beta, range) in [(&a, ra), (&b, rb)] {
            for v in batch::evaluate(beta, &even_directions(3000)) {
                prop_assert!(range.lower <= v && v <= range.upper);
            }
        }
    }

    #[test]
    fn fields_are_linear(a in coefficients(10), b in coefficients(10), t in -2.0..2.0_f64, p in direction()) {
        let mix = Coefficients::combination([(1.0 - t, &a), (t, &b)]);
        let field = Field::combine(&[(1.0 - t, &Field::new(&a)), (t, &Field::new(&b))]).expect("same grids");
        let exact = Basis::new(10).jet(&mix, &p, &mut Basis::new(10).workspace());
        let found = field.jet(&p);
        let scale = 11.0 * (norm(&a) + norm(&b)) * (1.0 + t.abs());
        prop_assert!((found.value - exact.value).abs() <= 1e-9 * scale);
        prop_assert!((found.gradient - exact.gradient).norm() <= 1e-8 * scale);
        prop_assert!((found.hessian - exact.hessian).norm() <= 1e-7 * scale);
    }
}
