//! What several tests share: real objects, settings, shapes, and what holds for every surface.
#![allow(dead_code, unreachable_pub)]

use std::path::PathBuf;

use nalgebra::{Point3, Vector3};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use shape::{FitSettings, PointCloud, RadialShape, Surface};
use sph::direction::{even_directions, retract, tangent_frame};
use sph::{Coefficients, Direction};

/// The paper's degree, and the penalty that the data ask for.
pub const SETTINGS: FitSettings = FitSettings {
    degree: 50,
    lambda: None,
};

/// One line of `objects/index.tsv`.
pub struct Entry {
    /// Name of the object.
    pub name: String,
    /// `main` or `hard`.
    pub class: String,
    /// Share of directions in which the scan is crossed exactly once.
    pub star_once: f64,
}

/// The folder of scans. Tests that use it are ignored unless they are asked for.
pub fn objects() -> PathBuf {
    testkit::scans().join("objects")
}

/// Bytes of a file below `objects`.
pub fn bytes(path: &str) -> Vec<u8> {
    testkit::scan_bytes(&format!("objects/{path}"))
}

/// The list of clouds.
pub fn index() -> Vec<Entry> {
    let text = String::from_utf8(bytes("index.tsv")).unwrap();
    let mut lines = text.lines().map(|l| l.split('\t').collect::<Vec<_>>());
    let titles = lines.next().unwrap();
    let column = |title: &str| titles.iter().position(|t| *t == title).expect(title);
    let (name, class, star) = (column("name"), column("class"), column("star_once"));
    lines
        .map(|fields| Entry {
            name: fields[name].to_owned(),
            class: fields[class].to_owned(),
            star_once: fields[star].parse().unwrap(),
        })
        .collect()
}

/// A cloud of the list, in metres.
pub fn cloud(name: &str) -> PointCloud {
    let bytes = bytes(&format!("{name}.ply"));
    let points = shape::io::read_ply(&bytes).unwrap().points;
    PointCloud::new(points).unwrap()
}

/// The cloud with normal noise of a deviation in metres on every coordinate.
pub fn noisy(cloud: &PointCloud, sigma: f64) -> PointCloud {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let normal = Normal::new(0.0, sigma).unwrap();
    let mut move_by = || Vector3::from_fn(|_, _| normal.sample(&mut rng));
    let points = cloud.points().iter().map(|p| p + move_by()).collect();
    PointCloud::new(points).unwrap()
}

/// The points in a random order.
pub fn shuffled(cloud: &PointCloud, seed: u64) -> Vec<Point3<f64>> {
    let mut points = cloud.points().to_vec();
    points.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
    points
}

/// Some points of a cloud, drawn at random.
pub fn thinned(cloud: &PointCloud, count: usize) -> PointCloud {
    let mut points = shuffled(cloud, 1);
    points.truncate(count);
    PointCloud::new(points).unwrap()
}

/// A smooth shape of degree 8, some 5 cm in radius.
pub fn pebble() -> RadialShape {
    let mut beta = Coefficients::constant(8, 0.05);
    for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
        *b = 0.004 * (i as f64 * 1.9).sin() / (1.0 + 0.3 * i as f64);
    }
    RadialShape::new(beta).unwrap()
}

/// Directions all over the sphere, the poles among them.
pub fn with_poles() -> Vec<Direction> {
    let mut all = even_directions(40);
    all.extend([Vector3::z_axis(), -Vector3::z_axis()]);
    all
}

/// df and dn agree with central differences, have p in their kernel, and df is tangent.
pub fn assert_differentials_agree_with_differences(shape: &impl Surface) {
    let h = 1e-5;
    for p in with_poles() {
        let here = shape.differential(&p);
        let (u, v) = tangent_frame(&p);
        for w in [u, v] {
            let (up, down) = (retract(&p, &(w * h)), retract(&p, &(w * -h)));
            let ((c1, n1), (c0, n0)) = (shape.contact(&up), shape.contact(&down));
            let moved = (c1 - c0) / (2.0 * h) - here.position_slope * w;
            let turned = (n1.into_inner() - n0.into_inner()) / (2.0 * h) - here.normal_slope * w;
            assert!(moved.norm() <= 1e-9, "{moved}");
            assert!(turned.norm() <= 1e-7, "{turned}");
        }
        assert!((here.position_slope * p.into_inner()).norm() <= 1e-15);
        assert!((here.normal_slope * p.into_inner()).norm() <= 1e-13);
        let flat = here.position_slope.transpose() * here.inward_normal.into_inner();
        assert!(flat.norm() <= 1e-15);
        assert!(here.inward_normal.dot(&p) < 0.0, "the normal points inward");
    }
}
