//! Surfaces that touch or cross themselves by less than the eye sees, and such that just do not.

use nalgebra::{Rotation3, Vector3};
use shape::{Embedding, SphericalShape};
use sph::grid::{GridValues, RingGrid};

const DEGREE: usize = 24;

/// The map p ↦ f(p), cut off at the degree, in a pose of its own.
fn shape(case: usize, f: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> SphericalShape {
    let grid = RingGrid::gauss_legendre(2 * DEGREE, 4 * DEGREE);
    let turn = |k: f64| {
        let t = k * (case as f64 + 1.0);
        Rotation3::from_euler_angles(t.sin() * 3.0, (1.7 * t).sin() * 1.5, (2.3 * t).sin() * 3.0)
    };
    let (before, after) = (turn(0.7), turn(1.3));
    let values: Vec<Vector3<f64>> = grid
        .directions()
        .map(|p| after * f(&(before * p.into_inner())))
        .collect();
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let values = GridValues {
            longitudes: grid.longitudes(),
            values: values.iter().map(|v| v[axis]).collect(),
        };
        grid.analysis(&values, DEGREE)
    });
    SphericalShape::new(x, y, z).unwrap()
}

/// A bent rod whose ends are `gap` apart, or overlap.
fn horseshoe(case: usize, gap: f64) -> SphericalShape {
    let radius = 0.25 + 0.05 * (case as f64).sin();
    let angle = std::f64::consts::PI - (0.5 * gap).asin();
    shape(case, |p| {
        let (sin, cos) = (angle * p.z).sin_cos();
        let out = 1.0 + radius * p.x;
        Vector3::new(out * cos, radius * p.y, out * sin) * 0.05
    })
}

/// A cup whose wall is thinner by the share k on a ring half way down, where its two sides touch for k = 1
/// and cross for more.
fn cup(case: usize, thickness: f64, k: f64) -> SphericalShape {
    shape(case, |p| {
        let across = p.x.hypot(p.y);
        let (sin, cos) = (1.2 * across).sin_cos();
        let square = p.z * p.z;
        let wall = thickness * (1.0 - k * 4.0 * square * (1.0 - square));
        let radius = 1.0 - 0.5 * wall * p.z;
        let out = if across > 1e-9 { sin / across } else { 1.2 };
        Vector3::new(radius * out * p.x, radius * out * p.y, -radius * cos) * 0.05
    })
}

fn proved(shape: &SphericalShape) -> bool {
    matches!(shape.embedding(), Embedding::Proved { .. })
}

#[test]
fn near_misses_are_proved() {
    for case in 0..6 {
        let gap = 0.02 * 0.5_f64.powi(case as i32);
        assert!(proved(&horseshoe(case, gap)), "gap {gap}");
        let k = 0.9 - 0.1 * case as f64;
        assert!(proved(&cup(case, 0.02, k)), "cup {k}");
    }
}

#[test]
fn no_surface_that_crosses_itself_is_proved() {
    for case in 0..4 {
        let overlap = 0.03 * 0.6_f64.powi(case as i32);
        let found = horseshoe(case, -overlap).embedding();
        let Embedding::Undecided {
            first, second, gap, ..
        } = found
        else {
            panic!("overlap {overlap}: {found:?}");
        };
        // The ends of the rod are opposite on the sphere and at one place in space.
        assert!(first.angle(&second) > 1.0 && gap < 0.01, "{found:?}");
        let k = 1.02 + 0.02 * case as f64;
        let found = cup(case, 0.02, k).embedding();
        assert!(matches!(found, Embedding::Undecided { .. }), "cup {k}");
    }
}

#[test]
fn surfaces_that_only_just_touch_are_not_proved() {
    for case in 0..4 {
        assert!(!proved(&horseshoe(case, 0.0)));
    }
}
