//! Repeated points count once.

use std::hash::Hasher;

use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use nalgebra::Point3;

use crate::voxel_grid::KeyHasher;

/// A point of a cloud, and how often it is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Distinct {
    /// Index of its first row.
    pub index: u32,
    /// Number of its rows.
    pub count: u32,
}

/// The distinct points in the order of their first rows. Points are the same if all bits of their
/// coordinates are, but for the sign of zero. At most 2³² points.
pub fn distinct(points: &[Point3<f64>]) -> Vec<Distinct> {
    let bits = |index: u32| {
        let p = &points[index as usize];
        [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits())
    };
    let hash = |index: u32| {
        let mut hasher = KeyHasher::default();
        bits(index).iter().for_each(|x| hasher.write_u64(*x));
        hasher.finish()
    };
    let mut rows: Vec<Distinct> = Vec::with_capacity(points.len());
    // The table holds positions in `rows`, a sixth of the memory of a map of coordinates.
    let mut known: HashTable<u32> = HashTable::with_capacity(points.len());
    for index in 0..points.len() as u32 {
        let same = |row: &u32| bits(rows[*row as usize].index) == bits(index);
        let rehash = |row: &u32| hash(rows[*row as usize].index);
        match known.entry(hash(index), same, rehash) {
            Entry::Occupied(row) => {
                let row = *row.get() as usize;
                rows[row].count += 1;
            }
            Entry::Vacant(place) => {
                place.insert(rows.len() as u32);
                rows.push(Distinct { index, count: 1 });
            }
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
