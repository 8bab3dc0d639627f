//! Repeated points count once.

use std::collections::HashMap;
use std::hash::BuildHasherDefault;

use nalgebra::Point3;

use crate::voxel_grid::KeyHasher;

/// A point of a cloud, and how often it is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Distinct {
    /// Index of its first row.
    pub index: usize,
    /// Number of its rows.
    pub count: usize,
}

/// The distinct points in the order of their first rows. Points are the same if all bits of their
/// coordinates are, but for the sign of zero.
pub fn distinct(points: &[Point3<f64>]) -> Vec<Distinct> {
    let hasher = BuildHasherDefault::<KeyHasher>::default();
    let mut known: HashMap<[u64; 3], usize, _> =
        HashMap::with_capacity_and_hasher(points.len(), hasher);
    let mut rows: Vec<Distinct> = Vec::with_capacity(points.len());
    for (index, p) in points.iter().enumerate() {
        let bits = [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits());
        let row = *known.entry(bits).or_insert(rows.len());
        match rows.get_mut(row) {
            Some(row) => row.count += 1,
            None => rows.push(Distinct { index, count: 1 }),
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_points_count_once() {
        let points = [0.0, 1.0, -0.0, 1.0, 1.0].map(|x| Point3::new(x, 2.0, 3.0));
        let rows = distinct(&points);
        assert_eq!(rows.len(), 2);
        assert_eq!((rows[0].index, rows[0].count), (0, 2));
        assert_eq!((rows[1].index, rows[1].count), (1, 3));
    }
}
