//! Objects that several tests use.

use moduli::nalgebra::Point3;
use moduli::{FitSettings, Object, PointCloud};

/// An ellipsoid of these half axes about a centre, fitted at degree 8.
pub(crate) fn ellipsoid(axes: [f64; 3], centre: [f64; 3]) -> Object {
    let at = |p: &sph::Direction, k: usize| centre[k] + axes[k] * p[k];
    let directions = sph::direction::even_directions(1200);
    let points = directions
        .iter()
        .map(|p| Point3::new(at(p, 0), at(p, 1), at(p, 2)));
    let settings = FitSettings {
        degree: 8,
        lambda: None,
    };
    let cloud = PointCloud::new(points.collect()).unwrap();
    Object::from_cloud("egg", &cloud, &settings).unwrap()
}
