use nalgebra::{Point3, Vector3};
use sphere_map::{MapSettings, SphereMap, Tree, Wrap, WrapError, WrapSettings, sphere_map, wrap};

use crate::clouds::{blob, branches, cup, torus};

const SMALL: WrapSettings = WrapSettings { vertices: 700 };

/// What must hold for every wrap and map, checked from the results alone.
pub(crate) fn wrapped_and_mapped(points: &[Point3<f64>]) -> (Wrap, SphereMap) {
    let wrap = wrap(points, &SMALL).unwrap();
    assert_eq!(wrap.mesh.euler_characteristic(), 2);
    let settings = MapSettings::default();
    let other = MapSettings {
        area_weight: 1.0,
        barrier: 0.1,
        ..settings
    };
    let map = sphere_map(&wrap.mesh, &settings)
        .or_else(|_| sphere_map(&wrap.mesh, &other))
        .unwrap();
    let mut angle = 0.0;
    for triangle in &map.mesh.triangles {
        let [a, b, c] = triangle.map(|v| map.images[v as usize].into_inner());
        let determinant = a.dot(&b.cross(&c));
        assert!(determinant > 0.0);
        angle += 2.0 * determinant.atan2(1.0 + a.dot(&b) + b.dot(&c) + c.dot(&a));
    }
    assert!((angle / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-9);
    (wrap, map)
}

/// Root mean square distance of the points from the mesh.
fn rms(points: &[Point3<f64>], wrap: &Wrap) -> f64 {
    let tree = Tree::new(&wrap.mesh);
    let squares = points
        .iter()
        .map(|p| tree.closest(p).unwrap().distance.powi(2));
    (squares.sum::<f64>() / points.len() as f64).sqrt()
}

#[test]
fn a_branched_shape_is_wrapped_tightly() {
    let o = Point3::origin();
    let rods = [
        (o, Point3::new(3.0, 0.0, 0.0), 0.5),
        (o, Point3::new(0.0, 2.5, 0.5), 0.4),
        (o, Point3::new(-1.0, -1.0, 2.0), 0.6),
        (Point3::new(3.0, 0.0, 0.0), Point3::new(3.5, 1.5, 1.0), 0.35),
    ];
    let points = branches(250.0, &rods);
    let (wrap, _) = wrapped_and_mapped(&points);
    assert!(wrap.closed_holes.is_empty() && wrap.hidden < points.len() / 100);
    let residual = rms(&points, &wrap);
    assert!(residual < 0.3 * wrap.spacing, "{residual} {}", wrap.spacing);
}

#[test]
fn the_handle_of_a_torus_is_closed_and_reported() {
    let points = torus(7000, 1.0, 0.35);
    let (wrap, _) = wrapped_and_mapped(&points);
    let [hole] = wrap.closed_holes.as_slice() else {
        panic!("{:?}", wrap.closed_holes);
    };
    assert!(hole.centre.coords.norm() < 0.1, "{hole:?}");
    let disc = std::f64::consts::PI * 0.65 * 0.65;
    assert!(hole.area > 0.5 * disc && hole.area < 1.3 * disc, "{hole:?}");
    assert!(hole.radius < 0.75);
}

#[test]
fn a_thin_wall_keeps_both_sides() {
    // The wall is 1.6 spacings thick.
    let points = cup(3500, 0.07);
    let (wrap, map) = wrapped_and_mapped(&points);
    let volume = 2.0 / 3.0 * std::f64::consts::PI * (1.0 - 0.93_f64.powi(3));
    assert!(
        (wrap.mesh.volume() / volume - 1.0).abs() < 0.25,
        "{}",
        wrap.mesh.volume()
    );
    assert!(wrap.closed_holes.is_empty());
    // Points of the two sides, 0.07 apart, are far apart on the sphere.
    let tree = Tree::new(&map.mesh);
    let down = Vector3::new(0.1, 0.1, -1.0).normalize();
    let sides = [(1.0, down), (0.93, -down)].map(|(r, n)| {
        let at = tree.closest_facing(&Point3::from(down * r), &n).unwrap();
        map.image(&at)
    });
    assert!(sides[0].angle(&sides[1]) > 1.0);
}

#[test]
fn inner_shells_are_hidden() {
    let outer = blob(4000, |_| 1.0);
    let inner = blob(2000, |_| 0.6);
    let all: Vec<Point3<f64>> = outer.iter().chain(&inner).copied().collect();
    let (wrap, _) = wrapped_and_mapped(&all);
    assert_eq!(wrap.hidden, inner.len());
    let ball = 4.0 / 3.0 * std::f64::consts::PI;
    assert!((wrap.mesh.volume() / ball - 1.0).abs() < 0.02);
}

#[test]
fn the_same_cloud_gives_the_same_bits() {
    let points = blob(1500, |p| 1.0 + 0.2 * (3.0 * p.x).sin());
    let (first, second) = (wrapped_and_mapped(&points), wrapped_and_mapped(&points));
    assert_eq!(first.0.mesh, second.0.mesh);
    assert_eq!(first.1.images, second.1.images);
    // Repeated points change nothing.
    let twice: Vec<Point3<f64>> = points.iter().chain(&points).copied().collect();
    assert_eq!(wrap(&twice, &SMALL).unwrap().mesh, first.0.mesh);
}

#[test]
fn clouds_without_a_surface_are_refused() {
    let bad = vec![Point3::new(0.0, f64::NAN, 0.0); 100];
    assert_eq!(
        wrap(&bad, &SMALL).err(),
        Some(WrapError::NotFinite { index: 0 })
    );
    let one = vec![Point3::origin(); 100];
    assert_eq!(
        wrap(&one, &SMALL).err(),
        Some(WrapError::TooFew { count: 1 })
    );
    let flat: Vec<Point3<f64>> = blob(500, |_| 1.0)
        .iter()
        .map(|p| Point3::new(p.x, p.y, 0.0))
        .collect();
    assert!(matches!(wrap(&flat, &SMALL), Err(WrapError::Flat { .. })));
}
