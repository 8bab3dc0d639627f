//! Properties of the solids: star-shaped, of graspable size, round or non-convex where claimed.

use crate::common::all_objects;
use catalogue::{CatalogueObject, SCAN_POINTS, ScanNoise, by_id};
use nalgebra::{Point3, Unit, Vector3, center};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn clean_sample(object: &CatalogueObject, points: usize) -> Vec<Point3<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    object.sample(points, &ScanNoise::NONE, &mut rng)
}

/// `count` nearly even directions along a golden spiral.
fn spiral(count: usize) -> impl Iterator<Item = Unit<Vector3<f64>>> {
    let golden = std::f64::consts::PI * (3.0 - 5.0f64.sqrt());
    (0..count).map(move |k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let ring = (1.0 - z * z).sqrt();
        let (sin, cos) = (golden * k as f64).sin_cos();
        Unit::new_normalize(Vector3::new(ring * cos, ring * sin, z))
    })
}

#[test]
fn every_object_is_star_shaped_from_the_mean_of_its_samples() {
    for object in all_objects() {
        let cloud = object.scan(5);
        let sum: Vector3<f64> = cloud.iter().map(|p| p.coords).sum();
        let mean = Point3::from(sum / SCAN_POINTS as f64);
        assert!(object.implicit(&mean) < -0.005, "{}", object.id);
        for ray in spiral(2_500) {
            let step = 0.5e-3;
            let inside: Vec<bool> = (0..500)
                .map(|k| object.implicit(&(mean + ray.scale(step * k as f64))) < 0.0)
                .collect();
            let changes = inside.windows(2).filter(|w| w[0] != w[1]).count();
            assert!(changes == 1, "{} crosses {changes} times", object.id);
            // The crossing lies within the step, and the facing there differs by less than the margin.
            let last = inside.iter().filter(|i| **i).count() as f64 - 0.5;
            let crossing = mean + ray.scale(step * last);
            let towards = Unit::new_normalize(crossing - object.centre());
            let facing = object.surface(&towards).normal.dot(&ray);
            assert!(facing >= 0.15, "{} faces {facing} at {crossing}", object.id);
        }
    }
}

#[test]
fn surface_points_lie_on_the_surface() {
    for object in all_objects() {
        for direction in spiral(1_600) {
            let hit = object.surface(&direction);
            assert!(object.implicit(&hit.point).abs() <= 1e-12, "{}", object.id);
            assert!((hit.normal.norm() - 1.0).abs() <= 1e-12);
            assert!(object.radius(&direction) == hit.radius);
            let by_radius = object.centre() + direction.scale(hit.radius);
            assert!((by_radius - hit.point).norm() <= 1e-15);
        }
    }
}

#[test]
fn sizes_suit_the_hand_and_objects_stand_on_the_table() {
    for object in all_objects() {
        let cloud = clean_sample(object, 40_000);
        let low = cloud.iter().fold(cloud[0].coords, |m, p| m.inf(&p.coords));
        let high = cloud.iter().fold(cloud[0].coords, |m, p| m.sup(&p.coords));
        let extent = high - low;
        let id = object.id;
        assert!(low.z >= -2e-4 && low.z <= 3e-4, "{id} starts at {}", low.z);
        assert!((high.z - object.height).abs() <= 5e-4, "{id} to {}", high.z);
        for width in [extent.x, extent.y] {
            assert!((0.05..=0.11).contains(&width), "{id} is {width} wide");
        }
        assert!(extent.z <= 0.24, "{id} is {} high", extent.z);
    }
}

/// Largest distance from the solid of the midpoint of two surface points, metres.
fn hollow(object: &CatalogueObject) -> f64 {
    let cloud = clean_sample(object, 500);
    let mut deepest = f64::NEG_INFINITY;
    for (k, a) in cloud.iter().enumerate() {
        for b in &cloud[k + 1..] {
            deepest = deepest.max(object.implicit(&center(a, b)));
        }
    }
    deepest
}

#[test]
fn at_least_four_objects_are_clearly_not_convex() {
    for id in ["S1", "S3", "S4", "S5", "S6", "S7", "S9", "U1", "U2"] {
        let object = by_id(id).expect("a known id");
        let depth = hollow(object);
        assert!(depth >= 1.5e-3, "{id}: {depth}");
    }
    for id in ["S2", "S8", "S10"] {
        let object = by_id(id).expect("a known id");
        let depth = hollow(object);
        assert!(depth <= 1e-9, "{id}: {depth}");
    }
}

#[test]
fn orange_and_softball_are_nearly_spheres() {
    for id in ["S11", "S12"] {
        let object = by_id(id).expect("a known id");
        let radii: Vec<f64> = spiral(1_600).map(|d| object.radius(&d)).collect();
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        assert!((0.03..=0.06).contains(&mean));
        for r in radii {
            assert!((r / mean - 1.0).abs() <= 0.08, "{id}: {r} of {mean}");
        }
    }
}

#[test]
fn ids_and_names_are_unique() {
    let mut ids: Vec<_> = all_objects().map(|o| o.id).collect();
    let mut names: Vec<_> = all_objects().map(|o| o.name).collect();
    ids.sort_unstable();
    ids.dedup();
    names.sort_unstable();
    names.dedup();
    assert!(ids.len() == 14 && names.len() == 14);
    assert!(by_id("S13").is_none());
    assert!(all_objects().all(|o| by_id(o.id).is_some_and(|found| std::ptr::eq(found, o))));
}
