//! The space of shapes: convexity, cones, the isometry with coefficients, mass, meshes.

use crate::common::{assert_differentials_agree_with_differences, pebble};
use nalgebra::{Matrix3, Point3, Vector3};
use proptest::prelude::*;
use shape::{RadialShape, Surface, TriangleMesh, algebra};
use sph::Coefficients;
use sph::direction::even_directions;
use sph::grid::RingGrid;

/// A member of M^rad: |Σ β Y| of the waves stays below the constant.
fn shapes() -> impl Strategy<Value = RadialShape> {
    (2_usize..7, 0.01_f64..0.2, 0.0_f64..0.9)
        .prop_flat_map(|(degree, radius, waviness)| {
            let count = (degree + 1) * (degree + 1);
            let waves = proptest::collection::vec(-1.0_f64..1.0, count - 1);
            (Just((degree, radius, waviness)), waves)
        })
        .prop_map(|((degree, radius, waviness), waves)| {
            // |Y_{l,m}| ≤ √((2l+1)/4π).
            let bound = |i: usize| (((2 * (i + 1).isqrt() + 1) as f64) / 12.0).sqrt();
            let reach: f64 = waves
                .iter()
                .enumerate()
                .map(|(i, w)| bound(i) * w.abs())
                .sum();
            let mut beta = Coefficients::constant(degree, radius);
            let scale = waviness * radius / reach.max(1e-12);
            for (b, w) in beta.as_mut_slice()[1..].iter_mut().zip(&waves) {
                *b = scale * w;
            }
            RadialShape::new(beta).expect("positive by construction")
        })
}

/// Volume, ∫x dV and ∫xxᵀ dV of a closed mesh, tetrahedron by tetrahedron from the origin.
fn moments(mesh: &TriangleMesh) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let mut sums = (0.0, Vector3::zeros(), Matrix3::zeros());
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize].coords);
        let volume = a.dot(&b.cross(&c)) / 6.0;
        let sum = a + b + c;
        let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
        sums.0 += volume;
        sums.1 += sum * (volume / 4.0);
        sums.2 += (squares + sum * sum.transpose()) * (volume / 20.0);
    }
    sums
}

#[test]
fn differentials_agree_with_differences_also_at_the_poles() {
    assert_differentials_agree_with_differences(&pebble());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Lemma 3.2 of the paper: M^rad is convex, and what is inherited is true.
    #[test]
    fn convex_combinations_stay_inside(a in shapes(), b in shapes(), t in 0.0_f64..=1.0) {
        let between = algebra::deformation(&a, &b, t).unwrap();
        let (low, high) = between.radius_bounds();
        prop_assert!(low > 0.0);
        prop_assert!(low >= (1.0 - t) * a.radius_bounds().0 + t * b.radius_bounds().0 - 1e-15);
        prop_assert!(RadialShape::new(between.coefficients().clone()).is_ok());
        for p in even_directions(30) {
            let r = between.radius(&p);
            prop_assert!(low <= r && r <= high);
            let mixed = (1.0 - t) * a.radius(&p) + t * b.radius(&p);
            prop_assert!((r - mixed).abs() <= 1e-14);
        }
    }

    /// M^rad is a cone: sums with weights that are not negative stay inside.
    #[test]
    fn cones_stay_inside(
        parts in proptest::collection::vec((shapes(), 0.0_f64..10.0), 1..5),
        first in 1e-6_f64..10.0,
    ) {
        let mut weights: Vec<f64> = parts.iter().map(|p| p.1).collect();
        weights[0] = first;
        let members: Vec<&RadialShape> = parts.iter().map(|p| &p.0).collect();
        let sum = algebra::cone(&weights, &members).unwrap();
        let (low, high) = sum.radius_bounds();
        prop_assert!(low > 0.0);
        let certified = RadialShape::new(sum.coefficients().clone()).unwrap();
        prop_assert!(certified.radius_bounds().0 > 0.0);
        for p in even_directions(30) {
            prop_assert!(low <= sum.radius(&p) && sum.radius(&p) <= high);
        }
    }

    #[test]
    fn weights_outside_the_cone_are_refused(a in shapes(), b in shapes(), w in -5.0_f64..-1e-9) {
        prop_assert!(algebra::cone(&[1.0, w], &[&a, &b]).is_err());
        prop_assert!(algebra::cone(&[f64::NAN, 1.0], &[&a, &b]).is_err());
        prop_assert!(algebra::cone(&[0.0, 0.0], &[&a, &b]).is_err());
        prop_assert!(algebra::convex_combination(&[0.5, 0.6], &[&a, &b]).is_err());
    }

    /// (∫|r₁−r₂|²)^½ by quadrature is ‖β₁−β₂‖ (Sec. III-B).
    #[test]
    fn the_distance_is_that_of_the_functions(a in shapes(), b in shapes()) {
        let degree = a.degree().max(b.degree());
        let grid = RingGrid::gauss_legendre(degree + 1, 2 * degree + 1);
        let values = |s: &RadialShape| grid.synthesis(s.coefficients()).values;
        let (ra, rb) = (values(&a), values(&b));
        let cell = std::f64::consts::TAU / grid.longitudes() as f64;
        let square: f64 = ra
            .iter()
            .zip(&rb)
            .enumerate()
            .map(|(i, (x, y))| grid.weights()[i / grid.longitudes()] * cell * (x - y).powi(2))
            .sum();
        let distance = algebra::distance(&a, &b);
        prop_assert!((square.sqrt() - distance).abs() <= 1e-12 * (1.0 + distance));
        prop_assert_eq!(distance, algebra::distance(&b, &a));
    }

    /// γ is a geodesic: distances along it add up.
    #[test]
    fn deformations_are_straight(a in shapes(), b in shapes(), s in 0.0_f64..1.0, t in 0.0_f64..1.0) {
        let at = |t| algebra::deformation(&a, &b, t).unwrap();
        let found = algebra::distance(&at(s), &at(t));
        prop_assert!((found - (s - t).abs() * algebra::distance(&a, &b)).abs() <= 1e-13);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn mass_agrees_with_a_fine_mesh(shape in shapes()) {
        let (volume, first, second) = moments(&shape.mesh(300, 600));
        let mass = shape.mass_properties();
        let size = shape.radius_bounds().1;
        prop_assert!((mass.volume / volume - 1.0).abs() <= 1e-3);
        prop_assert!((mass.centroid - Point3::from(first / volume)).norm() <= 1e-3 * size);
        let centroid = first / volume;
        let central = second - centroid * centroid.transpose() * volume;
        let inertia = Matrix3::identity() * central.trace() - central;
        prop_assert!((mass.inertia - inertia).norm() <= 2e-3 * inertia.norm());
        prop_assert!((shape.centre_of_mass() - mass.centroid).norm() == 0.0);
    }

    /// ∫ r √(r² + |∇r|²) is the area of the surface, and the mesh comes close to it.
    #[test]
    fn mesh_area_and_volume_agree_with_quadrature(shape in shapes()) {
        let grid = RingGrid::gauss_legendre(60, 120);
        let cell = std::f64::consts::TAU / 120.0;
        let (mut area, mut volume) = (0.0, 0.0);
        for (&(sin, z), weight) in grid.rings().iter().zip(grid.weights()) {
            for k in 0..120 {
                let (s, c) = (cell * f64::from(k)).sin_cos();
                let p = sph::Direction::new_normalize(Vector3::new(sin * c, sin * s, z));
                let (r, gradient) = shape.radius_and_gradient(&p);
                area += weight * cell * r * r.hypot(gradient.norm());
                volume += weight * cell * r.powi(3) / 3.0;
            }
        }
        let mesh = shape.mesh(300, 600);
        prop_assert!((mesh.area() / area - 1.0).abs() <= 2e-3);
        prop_assert!((mesh.volume() / volume - 1.0).abs() <= 1e-3);
        prop_assert!((shape.mass_properties().volume / volume - 1.0).abs() <= 1e-9);
    }
}
