//! Points by the cube they lie in, for searches of neighbours in a constant number of operations.

use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

use nalgebra::Point3;

/// Index of a cube along x, y and z.
pub(crate) type Key = [i64; 3];

/// A map from the indices of cubes.
pub(crate) type KeyMap<T> = HashMap<Key, T, BuildHasherDefault<KeyHasher>>;

/// A set of the indices of cubes.
pub(crate) type KeySet = HashSet<Key, BuildHasherDefault<KeyHasher>>;

/// A multiplicative hash of a few integers. It need not resist crafted collisions.
#[derive(Clone, Debug, Default)]
pub(crate) struct KeyHasher(u64);

impl Hasher for KeyHasher {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|b| self.write_u64(u64::from(*b)));
    }

    fn write_u64(&mut self, value: u64) {
        let mixed = (self.0 ^ value).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ (mixed >> 29);
    }

    fn write_i64(&mut self, value: i64) {
        self.write_u64(value.cast_unsigned());
    }

    fn write_usize(&mut self, value: usize) {
        self.write_u64(value as u64);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// Points by the cube they lie in.
pub(crate) struct VoxelGrid<'a> {
    points: &'a [Point3<f64>],
    side: f64,
    members: KeyMap<Vec<u32>>,
}

impl<'a> VoxelGrid<'a> {
    /// Sorts points into cubes of a side, metres.
    pub(crate) fn new(points: &'a [Point3<f64>], side: f64) -> Self {
        let mut members: KeyMap<Vec<u32>> = KeyMap::default();
        for (i, p) in points.iter().enumerate() {
            members.entry(key(p, side)).or_default().push(i as u32);
        }
        Self {
            points,
            side,
            members,
        }
    }

    /// The same with only the points that [`VoxelGrid::within`] may find around some places: of millions
    /// of points a few are kept.
    pub(crate) fn near<'b>(
        points: &'a [Point3<f64>],
        side: f64,
        places: impl Iterator<Item = &'b Point3<f64>>,
    ) -> Self {
        let cubes: KeySet = places.flat_map(|p| around(key(p, side))).collect();
        let mut members: KeyMap<Vec<u32>> = KeyMap::default();
        for (i, p) in points.iter().enumerate() {
            let at = key(p, side);
            if cubes.contains(&at) {
                members.entry(at).or_default().push(i as u32);
            }
        }
        Self {
            points,
            side,
            members,
        }
    }

    /// A point by its index.
    pub(crate) fn point(&self, index: usize) -> &'a Point3<f64> {
        &self.points[index]
    }

    /// Indices of the points within `radius` of a place with the squares of their distances. Finds all
    /// of them where the radius is at most the side of the cubes.
    pub(crate) fn within(
        &self,
        place: &Point3<f64>,
        radius: f64,
    ) -> impl Iterator<Item = (usize, f64)> {
        let place = *place;
        around(key(&place, self.side))
            .filter_map(|key| self.members.get(&key))
            .flatten()
            .map(move |i| {
                (
                    *i as usize,
                    (self.points[*i as usize] - place).norm_squared(),
                )
            })
            .filter(move |(_, square)| *square <= radius * radius)
    }

    /// Number of the points in the cube of each point.
    fn occupancy(&self) -> Vec<usize> {
        let counts = |members: &Vec<u32>| std::iter::repeat_n(members.len(), members.len());
        self.members.values().flat_map(counts).collect()
    }
}

/// A cube and the 26 cubes that touch it.
pub(crate) fn around([x, y, z]: Key) -> impl Iterator<Item = Key> {
    let near = |k: i64| k.saturating_sub(1)..=k.saturating_add(1);
    near(x).flat_map(move |x| near(y).flat_map(move |y| near(z).map(move |z| [x, y, z])))
}

/// The cube of a point.
pub(crate) fn key(p: &Point3<f64>, side: f64) -> Key {
    [p.x, p.y, p.z].map(|x| (x / side).floor() as i64)
}

/// Points that a cube should hold for [`spacing`] to count them.
const OCCUPANCY: (usize, usize) = (6, 20);
/// Points of a cloud of which the spacing is measured.
const MOST_COUNTED: usize = 200_000;
/// Most changes of the side until it does.
const ROUNDS: usize = 16;

/// Distance between neighbours, n^{−1/2} for n points on a unit of area; 0 for points without extent.
///
/// Cubes are made larger or smaller until the median point shares its cube with six to twenty; their
/// side and that number give the density where most points are. Costs a few passes over the points, or
/// over 200,000 of them.
pub(crate) fn spacing(points: &[Point3<f64>]) -> f64 {
    let share = MOST_COUNTED as f64 / points.len().max(1) as f64;
    spacing_of_part(points) * share.min(1.0).sqrt()
}

/// The same; of a cloud with more than 200,000 points the distance that so many would have.
pub(crate) fn spacing_of_part(points: &[Point3<f64>]) -> f64 {
    if points.len() > MOST_COUNTED {
        let part = subset(points, MOST_COUNTED);
        let part: Vec<Point3<f64>> = part.into_iter().map(|i| points[i]).collect();
        return spacing_of_part(&part);
    }
    let mut side = 3.0 * spacing_on_a_sphere(points);
    let mut count = 1;
    for _ in 0..ROUNDS {
        if !(side > 0.0 && side.is_finite()) {
            return 0.0;
        }
        let mut occupancy = VoxelGrid::new(points, side).occupancy();
        let middle = occupancy.len() / 2;
        count = *occupancy.select_nth_unstable(middle).1;
        if (OCCUPANCY.0..=OCCUPANCY.1).contains(&count) || count == points.len() {
            break;
        }
        side *= (11.0 / count as f64).sqrt().clamp(0.1, 3.0);
    }
    side / (count as f64).sqrt()
}

/// Distance between neighbours if the points were spread over the sphere of their median distance
/// from their middle.
pub(crate) fn spacing_on_a_sphere(points: &[Point3<f64>]) -> f64 {
    if points.is_empty() {
        return 0.0;
    }
    let middle = |axis: usize| median(points.iter().map(|p| p[axis]).collect());
    let centre = Point3::new(middle(0), middle(1), middle(2));
    let distances = points.iter().map(|p| (p - centre).norm()).collect();
    median(distances) * (4.0 * std::f64::consts::PI / points.len() as f64).sqrt()
}

/// The upper median; 0 of nothing.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// At most `count` indices of points, chosen pseudo-randomly. The choice does not depend on the
/// order of the points.
pub(crate) fn subset(points: &[Point3<f64>], count: usize) -> Vec<usize> {
    let rank = |i: &usize| {
        let mut hasher = KeyHasher::default();
        let bits = |x: f64| (x + 0.0).to_bits();
        points[*i].iter().for_each(|x| hasher.write_u64(bits(*x)));
        let [x, y, z] = [0, 1, 2].map(|axis| bits(points[*i][axis]));
        (hasher.finish(), x, y, z)
    };
    let mut indices: Vec<usize> = (0..points.len()).collect();
    if count < indices.len() {
        indices.select_nth_unstable_by_key(count, rank);
        indices.truncate(count);
    }
    indices.sort_unstable_by_key(rank);
    indices
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::even_directions;

    #[test]
    fn the_spacing_is_that_of_the_majority() {
        let mut points: Vec<Point3<f64>> = even_directions(5000)
            .iter()
            .map(|p| Point3::from(p.into_inner() * 0.05 + nalgebra::Vector3::repeat(0.3)))
            .collect();
        let expected = (4.0 * std::f64::consts::PI / 5000.0_f64).sqrt() * 0.05;
        for _ in 0..2 {
            let found = spacing(&points);
            assert!(
                (0.6..1.4).contains(&(found / expected)),
                "{found} {expected}"
            );
            // A few points far away change nothing.
            points.extend((0..9).map(|i| Point3::new(900.0, f64::from(i), 0.0)));
        }
        assert_eq!(spacing(&[]), 0.0);
        assert_eq!(spacing(&[Point3::origin(); 5]), 0.0);
    }

    #[test]
    fn a_subset_does_not_depend_on_the_order() {
        let points: Vec<Point3<f64>> = even_directions(100)
            .iter()
            .map(|p| Point3::from(p.into_inner()))
            .collect();
        let reversed: Vec<Point3<f64>> = points.iter().rev().copied().collect();
        let ours = subset(&points, 17).into_iter().map(|i| points[i]);
        let theirs = subset(&reversed, 17).into_iter().map(|i| reversed[i]);
        assert!(ours.eq(theirs));
        assert_eq!(subset(&points, 1000).len(), 100);
    }
}
