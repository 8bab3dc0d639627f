//! Metrics, curves and samples of the moduli space.

use grasp::Grasp;
use nalgebra::Point3;
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use shape::{RadialShape, Surface};
use space::sample::{perturbed, uniform_direction};
use space::{MetricError, ModuliPoint, Path, metric};
use sph::Coefficients;
use sph::direction::{angle, even_directions};

/// A random member of M^rad with three uniform contacts.
fn random_point(seed: u64) -> ModuliPoint<RadialShape> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let ball = RadialShape::new(Coefficients::constant(6, 0.05)).unwrap();
    loop {
        if let Ok(point) = perturbed(&ball, 1..49, 0.003, 3, &mut rng) {
            return point;
        }
    }
}

fn realise(point: &ModuliPoint<RadialShape>) -> Grasp {
    point.grasp(point.surface.centre_of_mass())
}

fn distance(w: f64, a: &ModuliPoint<RadialShape>, b: &ModuliPoint<RadialShape>) -> f64 {
    metric::distance(w, (&a.surface, &realise(a)), (&b.surface, &realise(b))).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_weighted_metric_is_a_metric(seed in 0_u64..1000, w in 0.0..=1.0_f64) {
        let [a, b, c] = [seed, seed + 7919, seed + 104_729].map(random_point);
        prop_assert!(distance(w, &a, &a) <= 1e-15);
        prop_assert_eq!(distance(w, &a, &b), distance(w, &b, &a));
        prop_assert!(distance(w, &a, &b) > 0.0);
        prop_assert!(distance(w, &a, &c) <= distance(w, &a, &b) + distance(w, &b, &c) + 1e-15);
    }

    #[test]
    fn the_curve_stays_in_the_space(seed in 0_u64..1000, t in 0.0..=1.0_f64) {
        let (from, to) = (random_point(seed), random_point(seed + 31));
        let here = Path { from: &from, to: &to }.at(t).unwrap();
        prop_assert!(here.surface.radius_bounds().0 > 0.0);
        let (low, high) = here.surface.radius_bounds();
        for p in even_directions(50) {
            let r = here.surface.radius(&p);
            let mixed = (1.0 - t) * from.surface.radius(&p) + t * to.surface.radius(&p);
            prop_assert!((r - mixed).abs() <= 1e-14);
            prop_assert!(low <= r && r <= high);
        }
        for (p, (a, b)) in here.directions.iter().zip(from.directions.iter().zip(&to.directions)) {
            prop_assert!((angle(a, p) - t * angle(a, b)).abs() <= 1e-12);
        }
    }
}

#[test]
fn the_weight_must_be_in_the_unit_interval() {
    let a = random_point(1);
    let g = realise(&a);
    for weight in [-0.1, 1.1, f64::NAN] {
        let d = metric::distance(weight, (&a.surface, &g), (&a.surface, &g));
        assert!(matches!(d, Err(MetricError::Weight { .. })));
    }
    let mut two = g.clone();
    two.contacts.pop();
    let d = metric::distance(0.5, (&a.surface, &g), (&a.surface, &two));
    assert!(matches!(d, Err(MetricError::Contacts(_))));
}

#[test]
fn samples_outside_the_space_are_errors_not_shapes() {
    let ball = RadialShape::sphere(6, 0.03).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let drawn: Vec<_> = (0..40)
        .map(|_| perturbed(&ball, 0..10, 0.06, 3, &mut rng))
        .collect();
    let valid = drawn.iter().flatten().count();
    assert!(valid > 0 && valid < 40, "{valid} of 40 are surfaces");
    for point in drawn.into_iter().flatten() {
        for p in even_directions(300) {
            assert!(point.surface.radius(&p) > 0.0);
        }
    }
}

#[test]
fn a_grasp_has_contacts_on_the_surface_and_inward_normals() {
    let point = random_point(11);
    let grasp = point.grasp(Point3::origin());
    for (contact, p) in grasp.contacts.iter().zip(&point.directions) {
        assert!((contact.position.coords.norm() - point.surface.radius(p)).abs() <= 1e-15);
        assert!(contact.inward_normal.dot(p) < 0.0);
    }
}

#[test]
fn uniform_directions_have_no_preferred_side() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let count = 20_000;
    let mean = (0..count)
        .map(|_| uniform_direction(&mut rng).into_inner())
        .sum::<nalgebra::Vector3<f64>>()
        / f64::from(count);
    // Each coordinate of the mean has standard deviation √(1/3N).
    assert!(mean.norm() <= 5.0 / f64::from(count).sqrt());
}
