//! Scans: reproducible, uniform by area, with the requested noise.

use crate::common::all_objects;
use catalogue::{CatalogueObject, SCAN_POINTS, ScanNoise, by_id};
use nalgebra::{Point3, Unit, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

fn bits(cloud: &[Point3<f64>]) -> Vec<u64> {
    cloud
        .iter()
        .flat_map(|p| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()])
        .collect()
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    for object in all_objects() {
        let first = bits(&object.scan(42));
        assert!(first.len() == 3 * SCAN_POINTS);
        assert!(first == bits(&object.scan(42)), "{}", object.id);
        assert!(first != bits(&object.scan(43)), "{}", object.id);
    }
}

#[test]
fn a_scan_does_not_depend_on_the_thread_that_asks_first() {
    let object = by_id("S6").expect("a known id");
    let scans: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..3)
            .map(|_| scope.spawn(|| bits(&object.scan(9))))
            .collect();
        threads
            .into_iter()
            .map(|t| t.join().expect("a scan"))
            .collect()
    });
    assert!(scans[0] == scans[1] && scans[1] == scans[2]);
}

const ROWS: usize = 8;
const COLUMNS: usize = 8;

/// Area of each bin of directions (uniform in polar angle and azimuth) by the midpoint rule for dA
/// = r²/(n·p) sin θ dθ dφ, which does not use the sampler.
fn bin_areas(object: &CatalogueObject) -> Vec<f64> {
    let (rows, columns) = (ROWS * 80, COLUMNS * 20);
    let (d_theta, d_phi) = (PI / rows as f64, TAU / columns as f64);
    let mut areas = vec![0.0; ROWS * COLUMNS];
    for (row, column) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
        let (sin, cos) = (d_theta * (row as f64 + 0.5)).sin_cos();
        let (y, x) = (d_phi * (column as f64 + 0.5)).sin_cos();
        let direction = Unit::new_normalize(Vector3::new(sin * x, sin * y, cos));
        let hit = object.surface(&direction);
        let element = hit.radius.powi(2) / hit.normal.dot(&direction) * sin;
        areas[(row * ROWS / rows) * COLUMNS + column * COLUMNS / columns] +=
            element * d_theta * d_phi;
    }
    areas
}

fn bin_of(object: &CatalogueObject, point: &Point3<f64>) -> usize {
    let ray = (point - object.centre()).normalize();
    let row = (ray.z.acos() / PI * ROWS as f64) as usize;
    let column = (ray.y.atan2(ray.x).rem_euclid(TAU) / TAU * COLUMNS as f64) as usize;
    row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)
}

#[test]
fn points_are_uniform_by_area() {
    for object in all_objects() {
        let areas = bin_areas(object);
        let total: f64 = areas.iter().sum();
        assert!(
            (object.area() / total - 1.0).abs() <= 0.005,
            "{}",
            object.id
        );
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let cloud = object.sample(50_000, &ScanNoise::NONE, &mut rng);
        let mut counts = vec![0.0; areas.len()];
        for point in &cloud {
            counts[bin_of(object, point)] += 1.0;
        }
        let chi_square: f64 = counts
            .iter()
            .zip(&areas)
            .map(|(count, area)| {
                let expected = cloud.len() as f64 * area / total;
                (count - expected) * (count - expected) / expected
            })
            .sum();
        // 63 degrees of freedom: mean 63, standard deviation 11.2; the bound is five deviations
        // above the mean.
        assert!(chi_square <= 120.0, "{}: {chi_square}", object.id);
    }
}

#[test]
fn the_can_has_its_analytic_share_on_the_side() {
    let can = by_id("S2").expect("a known id");
    let (radius, height, round) = (0.034, 0.101, 0.003);
    let side = TAU * radius * (height - 2.0 * round);
    let lid = PI * (radius - round) * (radius - round);
    let rim = TAU * (0.5 * PI * round * (radius - round) + round * round);
    let share = side / (side + 2.0 * lid + 2.0 * rim);
    assert!((can.area() / (side + 2.0 * lid + 2.0 * rim) - 1.0).abs() <= 0.003);
    let count = 200_000;
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let cloud = can.sample(count, &ScanNoise::NONE, &mut rng);
    let on_side = cloud
        .iter()
        .filter(|p| p.z > round && p.z < height - round)
        .count();
    let error = (on_side as f64 / count as f64 - share).abs();
    // Five standard errors of a binomial proportion.
    assert!(
        error <= 5.0 * (share * (1.0 - share) / count as f64).sqrt(),
        "{error}"
    );
}

#[test]
fn the_mean_of_many_points_is_the_centre() {
    for object in all_objects() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let cloud = object.sample(60_000, &ScanNoise::NONE, &mut rng);
        let offsets: Vec<Vector3<f64>> = cloud.iter().map(|p| p - object.centre()).collect();
        let mean = offsets.iter().sum::<Vector3<f64>>() / offsets.len() as f64;
        let spread = offsets.iter().map(|o| o.norm_squared()).sum::<f64>();
        // Five standard errors, and the error of the quadrature behind the centre.
        let tolerance = 5.0 * spread.sqrt() / offsets.len() as f64 + 1e-4;
        assert!(mean.norm() <= tolerance, "{}: {}", object.id, mean.norm());
    }
}

fn rms(object: &CatalogueObject, cloud: &[Point3<f64>]) -> f64 {
    let squares: f64 = cloud
        .iter()
        .map(|p| object.signed_distance(p).powi(2))
        .sum();
    (squares / cloud.len() as f64).sqrt()
}

#[test]
fn the_noise_has_the_level_that_was_asked_for() {
    for object in all_objects() {
        let id = object.id;
        let scan = object.scan(4);
        let level = rms(object, &scan);
        assert!((0.35e-3..=0.5e-3).contains(&level), "{id}: {level}");
        let bias = scan.iter().map(|p| object.signed_distance(p)).sum::<f64>() / scan.len() as f64;
        assert!(bias.abs() <= 0.02e-3, "{id}: {bias}");
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let clean = object.sample(1_000, &ScanNoise::NONE, &mut rng);
        assert!(rms(object, &clean) <= 1e-10, "{id}");
        let even = ScanNoise {
            sigma: 1e-4,
            grazing: 0.0,
            elevation: 0.0,
        };
        let fine = rms(object, &object.sample(20_000, &even, &mut rng));
        assert!((fine / 1e-4 - 1.0).abs() <= 0.03, "{id}: {fine}");
    }
}
