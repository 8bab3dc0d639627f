//! A surface that does not explain its points is not accepted; the scans of the tests are.

use nalgebra::{Point3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shape::acceptance::{Acceptance, Verdict, noise};
use shape::fit::{Fit, fit};
use shape::{PointCloud, RadialField};

use crate::common::{SETTINGS, cloud, index, shuffled};

/// How well a fit explains the points that it used.
fn accepted(cloud: &PointCloud, fit: &Fit) -> Acceptance {
    let mut used = vec![true; cloud.points().len()];
    fit.outliers.iter().for_each(|i| used[*i] = false);
    let points = cloud.points().iter().zip(&used).filter(|(_, used)| **used);
    let points: Vec<Point3<f64>> = points.map(|(p, _)| *p).collect();
    let centre = &fit.centre_in_cloud;
    let field = RadialField::new(fit.shape.clone());
    let direction = |i: usize| Some(sph::Direction::new_normalize(points[i] - centre));
    Acceptance::measure(&field, centre, &points, direction, noise(&points))
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn the_scans_are_accepted() {
    let main = index().into_iter().filter(|entry| entry.class == "main");
    let mut accepted_scans = 0;
    for entry in main {
        let cloud = cloud(&entry.name);
        let found = accepted(&cloud, &fit(&cloud, &SETTINGS).unwrap());
        // No radius describes the trigger of the spray flask; as a map of the sphere it is fitted.
        let expected = entry.name == "spray_flask";
        let refused = found.verdict() == Verdict::Unexplained;
        assert_eq!(refused, expected, "{}: {found}", entry.name);
        accepted_scans += 1;
    }
    assert_eq!(accepted_scans, 14);
}

/// An area, and a map of a pair of numbers in 0..1 to a place on it.
type Part<'a> = (f64, &'a dyn Fn(f64, f64) -> Vector3<f64>);

/// Points spread over parts by area.
fn spread(count: usize, parts: &[Part<'_>]) -> PointCloud {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let whole: f64 = parts.iter().map(|p| p.0).sum();
    let mut point = || {
        let mut place = whole * rng.random::<f64>();
        let part = parts.iter().find(|(area, _)| {
            place -= area;
            place <= 0.0
        });
        Point3::from(part.unwrap_or(&parts[0]).1(rng.random(), rng.random()))
    };
    PointCloud::new((0..count).map(|_| point()).collect()).unwrap()
}

/// A capsule-like spindle along an axis: half length and half width.
fn spindle(axis: Vector3<f64>, half: f64, width: f64) -> impl Fn(f64, f64) -> Vector3<f64> {
    let direction = sph::Direction::new_normalize(axis);
    let (u, v) = sph::direction::tangent_frame(&direction);
    move |a, b| {
        let z = 2.0 * a - 1.0;
        let (sin, cos) = (std::f64::consts::TAU * b).sin_cos();
        let r = width * (1.0 - z.powi(8)).max(0.0).sqrt();
        direction.into_inner() * (half * z) + (u * cos + v * sin) * r
    }
}

#[test]
fn needles_crosses_and_clouds_without_a_surface_are_not_accepted() {
    let needle = spindle(Vector3::x(), 0.2, 0.003);
    let across = spindle(Vector3::y(), 0.15, 0.004);
    let wing = |a: f64, b: f64| Vector3::new(0.05 * (a - 0.5), 0.3 * (b - 0.5), 0.0);
    let tail = |a: f64, b: f64| Vector3::new(0.17 + 0.02 * a, 0.0, 0.05 * b);
    let body = spindle(Vector3::x(), 0.2, 0.012);
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut filled = || loop {
        let p = Vector3::from_fn(|_, _| 0.1 * (rng.random::<f64>() - 0.5));
        if p.norm() <= 0.05 {
            return Point3::from(p);
        }
    };
    let clouds = [
        ("needle", spread(5000, &[(1.0, &needle)])),
        ("cross", spread(5000, &[(1.0, &needle), (1.0, &across)])),
        (
            "airplane",
            spread(8000, &[(2.0, &body), (2.0, &wing), (0.3, &tail)]),
        ),
        (
            "ball of 1,000 points",
            PointCloud::new((0..1000).map(|_| filled()).collect()).unwrap(),
        ),
        (
            "ball of 10,000 points",
            PointCloud::new((0..10_000).map(|_| filled()).collect()).unwrap(),
        ),
    ];
    for (name, cloud) in clouds {
        // A fit may refuse such a cloud before its residuals are looked at.
        if let Ok(fit) = fit(&cloud, &SETTINGS) {
            let found = accepted(&cloud, &fit);
            assert!(found.verdict() == Verdict::Unexplained, "{name}: {found}");
        }
    }
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn the_order_of_the_points_changes_no_verdict() {
    for name in ["toy_cat", "power_drill"] {
        let first = cloud(name);
        let second = PointCloud::new(shuffled(&first, 3)).unwrap();
        let [a, b] = [&first, &second].map(|c| accepted(c, &fit(c, &SETTINGS).unwrap()));
        assert_eq!(a.verdict(), b.verdict(), "{name}");
        // The noise is measured at some of the points, and these depend on the order.
        assert!(
            (a.noise_m / b.noise_m - 1.0).abs() <= 0.2,
            "{name}: {a} {b}"
        );
        let shares = [a.unexplained_share, b.unexplained_share];
        assert!((shares[0] - shares[1]).abs() <= 1e-2, "{name}: {shares:?}");
    }
}
