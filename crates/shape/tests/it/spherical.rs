//! Members of M^sph: geometry against differences, proofs, mass, regression.

use crate::common::{SETTINGS, assert_differentials_agree_with_differences, pebble, with_poles};
use nalgebra::{Matrix3, Point3, Vector3};
use proptest::prelude::*;
use shape::{FitSettings, PointCloud, SphericalError, SphericalShape, Surface, fit_spherical};
use sph::direction::{even_directions, tangent_frame};
use sph::{Coefficients, Direction};

/// (l, m) = (1, 1), (1, −1), (1, 0): the harmonics along x, y and z.
const AXES: [usize; 3] = [3, 1, 2];

fn unit() -> f64 {
    (4.0 * std::f64::consts::PI / 3.0).sqrt()
}

/// f(p) = A p + c.
fn ellipsoid(matrix: &Matrix3<f64>, centre: &Vector3<f64>) -> [Coefficients; 3] {
    std::array::from_fn(|row| {
        let mut beta = Coefficients::constant(1, centre[row]);
        for (axis, at) in AXES.iter().enumerate() {
            beta.as_mut_slice()[*at] = matrix[(row, axis)] * unit();
        }
        beta
    })
}

fn shape(coordinates: [Coefficients; 3]) -> Result<SphericalShape, SphericalError> {
    let [x, y, z] = coordinates;
    SphericalShape::new(x, y, z)
}

fn bent() -> SphericalShape {
    let matrix = Matrix3::new(0.05, 0.01, 0.0, -0.01, 0.03, 0.004, 0.0, 0.002, 0.08);
    let mut coordinates = ellipsoid(&matrix, &Vector3::new(0.01, -0.02, 0.005));
    for (axis, beta) in coordinates.iter_mut().enumerate() {
        *beta = beta.with_degree(5);
        for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(4) {
            *b += 2e-3 * ((i + 7 * axis) as f64 * 1.3).sin() / (1.0 + 0.2 * i as f64);
        }
    }
    shape(coordinates).unwrap()
}

#[test]
fn an_ellipsoid_has_its_normals_mass_and_bounds() {
    let (a, b, c) = (0.03, 0.05, 0.09);
    let centre = Vector3::new(0.01, 0.02, -0.03);
    let axes = Matrix3::from_diagonal(&Vector3::new(a, b, c));
    let shape = shape(ellipsoid(&axes, &centre)).unwrap();
    let mass = shape.mass_properties();
    let volume = 4.0 / 3.0 * std::f64::consts::PI * a * b * c;
    assert!((mass.volume / volume - 1.0).abs() <= 1e-13);
    assert!((shape.centre_of_mass().coords - centre).norm() <= 1e-15);
    let inertia = Vector3::new(b * b + c * c, a * a + c * c, a * a + b * b) * (volume / 5.0);
    let expected = Matrix3::from_diagonal(&inertia);
    assert!((mass.inertia - expected).norm() <= 1e-13 * expected.norm());
    // |f_u × f_v| runs from ab to bc.
    let proof = shape.immersion();
    assert!(0.0 < proof.lower && proof.lower <= a * b && a * b <= proof.seen_lower);
    assert!((proof.seen_upper - b * c).abs() <= 1e-3 * b * c);
    for p in with_poles() {
        let (point, normal) = shape.contact(&p);
        let outward = Vector3::new(p.x / a, p.y / b, p.z / c).normalize();
        assert!((normal.into_inner() + outward).norm() <= 1e-13);
        assert_eq!(point, shape.point(&p));
    }
}

#[test]
fn differentials_agree_with_differences_also_at_the_poles() {
    let shape = bent();
    assert_differentials_agree_with_differences(&shape);
    for p in even_directions(200) {
        // The bound holds where nobody looked.
        let area = area_element(&|p| shape.differential(p).position_slope, &p);
        assert!(area >= shape.immersion().lower);
    }
}

#[test]
fn a_radial_shape_is_the_same_surface_in_both_spaces() {
    let radial = pebble();
    let spherical = SphericalShape::from_radial(&radial).unwrap();
    assert_eq!(spherical.degree(), 9);
    for p in with_poles() {
        let (a, b) = (radial.differential(&p), spherical.differential(&p));
        assert!((a.position - b.position).norm() <= 1e-14);
        assert!((a.inward_normal.into_inner() - b.inward_normal.into_inner()).norm() <= 1e-12);
        assert!((a.position_slope - b.position_slope).norm() <= 1e-13);
        assert!((a.normal_slope - b.normal_slope).norm() <= 1e-9);
    }
    let (a, b) = (radial.mass_properties(), spherical.mass_properties());
    assert!((a.volume / b.volume - 1.0).abs() <= 1e-12);
    assert!((a.centroid - b.centroid).norm() <= 1e-14);
    assert!((a.inertia - b.inertia).norm() <= 1e-11 * a.inertia.norm());
    let mesh = spherical.mesh(200, 400);
    assert!((mesh.volume() / b.volume - 1.0).abs() <= 1e-3);
}

/// |f_u × f_v| at p.
fn area_element(shape: &impl Fn(&Direction) -> Matrix3<f64>, p: &Direction) -> f64 {
    let (u, v) = tangent_frame(p);
    let slope = shape(p);
    (slope * u).cross(&(slope * v)).norm()
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn real_shapes_of_degree_50_are_proved_immersions() {
    // The last two are long and lean: the area element varies by factors of 400 and 1,500.
    for name in ["apple", "sugar_box", "toy_cat", "spray_flask", "banana"] {
        let cloud = crate::common::cloud(name);
        let fit = shape::fit::fit(&cloud, &SETTINGS).unwrap();
        let radial = fit.shape;
        let spherical = SphericalShape::from_radial(&radial).unwrap();
        let proof = spherical.immersion();
        assert!(proof.lower >= 0.5 * proof.seen_lower, "{name}");
        assert!(proof.lower <= proof.seen_lower, "{name}");
        for p in even_directions(2000) {
            let (r, gradient) = radial.radius_and_gradient(&p);
            assert!(proof.lower <= r * r.hypot(gradient.norm()), "{name}");
        }
        let (a, b) = (radial.mass_properties(), spherical.mass_properties());
        assert!((a.volume / b.volume - 1.0).abs() <= 1e-10, "{name}");
    }
}

#[test]
fn thin_discs_are_proved_flat_ones_refused_and_hair_thin_ones_left_open() {
    let disc = |thickness: f64| {
        let axes = Vector3::new(0.05, 0.04, thickness);
        shape(ellipsoid(&Matrix3::from_diagonal(&axes), &Vector3::zeros()))
    };
    // Along the equator |f_u × f_v| is the thickness times the other half axis.
    for thickness in [1e-2, 1e-3, 1e-4] {
        let proof = disc(thickness).unwrap().immersion();
        let least = 0.04 * thickness;
        assert!(proof.lower <= least && proof.lower >= 0.5 * least);
    }
    let Err(SphericalError::NotImmersed { seen, z, .. }) = disc(1e-8) else {
        panic!("flat to one part in a million");
    };
    assert!(seen <= 1e-6 * 0.05 * 0.04 && z.abs() <= 1e-3);
    // The whole equator is nearly sharp: more places than the limit of work.
    let Err(SphericalError::Undecided { seen, z, open, .. }) = disc(1e-6) else {
        panic!("neither proved nor refuted");
    };
    assert!(seen <= 1e-4 * 0.05 * 0.04 && z.abs() <= 1e-2 && open > 0);
}

#[test]
fn the_place_of_a_pinch_is_named() {
    // x is turned back by a wave: where it stops growing, the surface has pinch points.
    let [x, y, z] = ellipsoid(&(Matrix3::identity() * 0.05), &Vector3::zeros());
    let mut x = x.with_degree(6);
    x.as_mut_slice()[6 * 6 + 6 + 1] = 0.06;
    let coordinates = [x, y.with_degree(6), z.with_degree(6)];
    let basis = sph::Basis::new(6);
    let slope = |p: &Direction| {
        let mut work = basis.workspace();
        let rows = coordinates
            .each_ref()
            .map(|c| basis.jet(c, p, &mut work).gradient.transpose());
        Matrix3::from_rows(&rows)
    };
    let Err(SphericalError::NotImmersed {
        x,
        y,
        z,
        seen,
        largest,
    }) = shape(coordinates.clone())
    else {
        panic!("no pinch found");
    };
    let there = Direction::new_normalize(Vector3::new(x, y, z));
    let area = area_element(&slope, &there);
    assert!(
        area <= 2e-6 * largest && seen <= 1e-6 * largest,
        "{area:.1e}"
    );
}

#[test]
fn flats_mirrors_and_points_are_refused() {
    let flat = Matrix3::from_diagonal(&Vector3::new(0.05, 0.05, 0.0));
    let origin = Vector3::zeros();
    assert!(matches!(
        shape(ellipsoid(&flat, &origin)),
        Err(SphericalError::NotImmersed { .. })
    ));
    let mirror = Matrix3::from_diagonal(&Vector3::new(-0.05, 0.05, 0.05));
    assert!(matches!(
        shape(ellipsoid(&mirror, &origin)),
        Err(SphericalError::InsideOut { .. })
    ));
    let point = || Coefficients::constant(2, 0.01);
    assert!(SphericalShape::new(point(), point(), point()).is_err());
}

#[test]
fn regression_finds_a_map_from_its_points() {
    let truth = bent();
    let directions = even_directions(3000);
    let shift = Vector3::new(0.3, -0.2, 0.1);
    let points = directions.iter().map(|p| truth.point(p) + shift).collect();
    let cloud = PointCloud::new(points).unwrap();
    let settings = FitSettings {
        degree: 6,
        lambda: Some(0.0),
    };
    let fit = fit_spherical(&directions, &cloud, &settings).unwrap();
    assert!(fit.rms <= 1e-14 && fit.max_abs <= 1e-13 && fit.condition < 3.0);
    for p in even_directions(50) {
        let back = fit.shape.point(&p) + fit.centre_in_cloud.coords;
        assert!((back - truth.point(&p) - shift).norm() <= 1e-13);
    }
    let chosen = FitSettings {
        degree: 6,
        lambda: None,
    };
    let fit = fit_spherical(&directions, &cloud, &chosen).unwrap();
    assert!(fit.rms <= 1e-6, "{:.1e}", fit.rms);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn affine_maps_move_mass_as_they_should(
        entries in proptest::array::uniform9(-0.02_f64..0.02),
        shift in proptest::array::uniform3(-0.1_f64..0.1),
    ) {
        let matrix = Matrix3::from_row_slice(&entries) + Matrix3::identity() * 0.06;
        let shift = Vector3::from(shift);
        let shape = shape(ellipsoid(&matrix, &shift)).unwrap();
        let mass = shape.mass_properties();
        let volume = 4.0 / 3.0 * std::f64::consts::PI * matrix.determinant();
        prop_assert!((mass.volume / volume - 1.0).abs() <= 1e-10);
        prop_assert!((mass.centroid - Point3::from(shift)).norm() <= 1e-12);
        let second = matrix * matrix.transpose() * (volume / 5.0);
        let inertia = Matrix3::identity() * second.trace() - second;
        prop_assert!((mass.inertia - inertia).norm() <= 1e-9 * inertia.norm());
    }
}
