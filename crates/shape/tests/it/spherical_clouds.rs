//! Fits over the sphere without given directions: what is no surface of its points is refused.

use nalgebra::{Point3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shape::{PointCloud, SphericalCloudError, SphericalSettings, fit_spherical_cloud};
use sph::direction::even_directions;

fn on_a_sphere(count: usize, keep: impl Fn(&Vector3<f64>) -> bool) -> Vec<Point3<f64>> {
    let all = even_directions(count).into_iter();
    let kept = all.map(|p| p.into_inner()).filter(|p| keep(p));
    kept.map(|p| Point3::from(0.05 * p)).collect()
}

#[test]
fn one_side_of_an_object_is_refused() {
    let settings = SphericalSettings::new(12);
    // Half of a ball, a ball with an opening, and one side of a flat plate.
    let half = on_a_sphere(4000, |p| p.z > 0.0);
    let open = on_a_sphere(4000, |p| p.z < 0.6);
    let plate = on_a_sphere(4000, |p| p.z > 0.0);
    let plate = plate.iter().map(|p| Point3::new(p.x, p.y, 0.2 * p.x * p.x));
    for points in [half, open, plate.collect()] {
        let cloud = PointCloud::new(points).unwrap();
        match fit_spherical_cloud(&cloud, &settings) {
            Err(SphericalCloudError::OneSide { share, thickness }) => {
                assert!(share > 0.8 && thickness > 0.0, "{share} {thickness}");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn the_same_is_kept_with_a_note_where_that_is_wanted() {
    let cloud = PointCloud::new(on_a_sphere(2000, |p| p.z > 0.0)).unwrap();
    let settings = SphericalSettings {
        accept_misfit: true,
        ..SphericalSettings::new(12)
    };
    let fit = fit_spherical_cloud(&cloud, &settings).unwrap();
    assert!(fit.walls.single_sheet_share > 0.8);
    let notes = fit.notes().join("; ");
    assert!(notes.contains("single sheet"), "{notes}");
}

#[test]
fn walls_with_two_sides_are_not_single_sheets() {
    // Half of a hollow ball with a wall of 3 mm.
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut place = |low: f64, high: f64, flat: bool| {
        let angle = std::f64::consts::TAU * rng.random::<f64>();
        let z = if flat { 0.0 } else { rng.random::<f64>() };
        let radius = (low * low + rng.random::<f64>() * (high * high - low * low)).sqrt();
        let across = (1.0 - z * z).sqrt();
        Point3::new(across * angle.cos(), across * angle.sin(), z) * radius
    };
    let mut points: Vec<_> = (0..5000).map(|_| place(0.05, 0.05, false)).collect();
    points.extend((0..4400).map(|_| place(0.047, 0.047, false)));
    points.extend((0..290).map(|_| place(0.047, 0.05, true)));
    let cloud = PointCloud::new(points).unwrap();
    let fit = fit_spherical_cloud(&cloud, &SphericalSettings::new(20)).unwrap();
    assert!(fit.walls.single_sheet_share < 0.1, "{:?}", fit.walls);
    assert!(fit.walls.thin_share > 0.9, "{:?}", fit.walls);
    assert!(fit.acceptance.unexplained_share < 0.02);
}

#[test]
fn points_that_fill_a_ball_are_not_a_surface() {
    let surface = on_a_sphere(3000, |_| true);
    let filled = (1_u32..).zip(&surface);
    let filled = filled.map(|(k, p)| p * (f64::from(k * 7919 % 3000) / 3000.0).cbrt());
    let cloud = PointCloud::new(filled.collect()).unwrap();
    match fit_spherical_cloud(&cloud, &SphericalSettings::new(8)) {
        Err(SphericalCloudError::Unexplained(acceptance)) => {
            assert!(acceptance.unexplained_share > 0.1, "{acceptance}");
        }
        other => panic!("{other:?}"),
    }
}
