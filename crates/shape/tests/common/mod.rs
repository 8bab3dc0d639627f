//! The folder of real objects that tests read.
#![allow(dead_code, unreachable_pub, clippy::print_stderr)]

use std::path::PathBuf;

use nalgebra::{Point3, Vector3};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use shape::PointCloud;

/// One line of `objects/index.tsv`.
pub struct Entry {
    /// Name of the object.
    pub name: String,
    /// `main` or `hard`.
    pub class: String,
    /// Share of directions in which the scan is crossed exactly once.
    pub star_once: f64,
}

/// `objects` in the folder named by MODULI_DATA; a test without it says so and has nothing to do.
pub fn objects() -> Option<PathBuf> {
    let folder = std::env::var_os("MODULI_DATA").map(|root| PathBuf::from(root).join("objects"));
    if folder.is_none() {
        eprintln!("MODULI_DATA is not set: real scans are not looked at");
    }
    folder
}

/// Bytes of a file below `objects`.
pub fn bytes(path: &str) -> Option<Vec<u8>> {
    Some(std::fs::read(objects()?.join(path)).expect(path))
}

/// The list of clouds.
pub fn index() -> Vec<Entry> {
    let Some(text) = bytes("index.tsv") else {
        return Vec::new();
    };
    let text = String::from_utf8(text).unwrap();
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
pub fn cloud(name: &str) -> Option<PointCloud> {
    let bytes = bytes(&format!("{name}.ply"))?;
    let points = shape::io::read_ply(&bytes).unwrap().points;
    Some(PointCloud::new(points).unwrap())
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
