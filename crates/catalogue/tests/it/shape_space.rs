//! Fig. 4 of the paper: the straight lines from S5 to other shapes pass near S7 and S8.

use catalogue::{by_id, library_objects};
use nalgebra::{Unit, Vector3};
use std::f64::consts::PI;

/// Midpoints of `rows` × `columns` cells of equal area on the sphere, row by row from −z.
fn equal_area_directions(rows: usize, columns: usize) -> impl Iterator<Item = Unit<Vector3<f64>>> {
    (0..rows).flat_map(move |row| {
        let z = -1.0 + 2.0 * (row as f64 + 0.5) / rows as f64;
        let ring = (1.0 - z * z).sqrt();
        (0..columns).map(move |column| {
            let (sin, cos) = (2.0 * PI * (column as f64 + 0.5) / columns as f64).sin_cos();
            Unit::new_normalize(Vector3::new(ring * cos, ring * sin, z))
        })
    })
}

/// The radial function about the centre on an equal-area grid of directions.
fn radial_function(id: &str) -> Vec<f64> {
    let object = by_id(id).expect("a known id");
    equal_area_directions(80, 120)
        .map(|d| object.radius(&d))
        .collect()
}

/// Root mean square over the sphere: the L² norm up to √(4π), by midpoint quadrature.
fn norm(f: &[f64]) -> f64 {
    (f.iter().map(|x| x * x).sum::<f64>() / f.len() as f64).sqrt()
}

fn minus(f: &[f64], g: &[f64]) -> Vec<f64> {
    f.iter().zip(g).map(|(x, y)| x - y).collect()
}

/// Distance of f from the straight segment between a and b, and the parameter of the nearest point
/// (0 at a).
fn distance_from_segment(f: &[f64], a: &[f64], b: &[f64]) -> (f64, f64) {
    let (along, from_a) = (minus(b, a), minus(f, a));
    let dot: f64 = along.iter().zip(&from_a).map(|(x, y)| x * y).sum();
    let t = (dot / along.iter().map(|x| x * x).sum::<f64>()).clamp(0.0, 1.0);
    let foot: Vec<f64> = a.iter().zip(&along).map(|(x, d)| x + t * d).collect();
    (norm(&minus(f, &foot)), t)
}

#[test]
fn s5_passes_near_s7_and_s8_when_it_is_deformed() {
    let start = radial_function("S5");
    for near in ["S7", "S8"] {
        let shape = radial_function(near);
        let (ratio, t) = ["S1", "S2", "S10", "S11"]
            .map(|target| {
                let end = radial_function(target);
                let (distance, t) = distance_from_segment(&shape, &start, &end);
                let ends = norm(&minus(&shape, &start)).min(norm(&minus(&shape, &end)));
                (distance / ends, t)
            })
            .into_iter()
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("four ways");
        assert!(ratio <= 0.55, "{near}: {ratio}");
        assert!((0.2..=0.8).contains(&t), "{near}: {t}");
    }
}

#[test]
fn no_two_library_objects_are_alike() {
    let shapes: Vec<_> = library_objects()
        .iter()
        .map(|o| radial_function(o.id))
        .collect();
    for (k, f) in shapes.iter().enumerate() {
        for g in &shapes[k + 1..] {
            assert!(norm(&minus(f, g)) >= 3e-3);
        }
    }
}
