//! Support functions: the farthest point of a set along a direction.

use super::cap::Touching;
use super::plane::{V6, add_scaled, dot, norm};

/// A set known by its farthest point along any direction.
pub(crate) trait Support {
    /// The farthest point along `direction`, and what the caller calls it.
    fn support(&mut self, direction: &V6) -> (V6, u32);

    /// Whether the set is curved, so that no polytope of its points can be exact.
    fn is_curved(&self) -> bool {
        false
    }

    /// The symmetries of the set, written to `out`; none where none are known.
    fn symmetries(&self, out: &mut Symmetries) {
        out.maps.clear();
    }

    /// The face that a ball around the origin touches near a facet of points of the set, given with
    /// the convex weights of the facet's point nearest to the origin; None where none is found.
    fn touching(&self, _normal: &V6, _shares: &[(u32, V6, f64)]) -> Option<Touching> {
        None
    }

    /// The same beside a minimum of the support function, where it hardly changes in some direction.
    fn beside(&self, _normal: &V6, _shares: &[(u32, V6, f64)]) -> Option<Touching> {
        None
    }

    /// The largest angle around the direction of a touching face within which the support function
    /// is proved to be `level` or more; 0 where nothing is proved.
    fn cap(&self, _touching: &Touching, _level: f64) -> f64 {
        0.0
    }
}

/// An orthogonal matrix of R³ and the permutation of contacts that it makes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpaceMap {
    pub(crate) matrix: nalgebra::Matrix3<f64>,
    pub(crate) image: [u8; 16],
    /// Whether its determinant is negative.
    pub(crate) mirrors: bool,
}

impl SpaceMap {
    /// What tells one map of a grasp from another.
    pub(crate) fn key(&self) -> ([u8; 16], bool) {
        (self.image, self.mirrors)
    }
}

/// Linear isometries of R⁶ that map a set to itself, up to an error.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symmetries {
    /// A group, without the identity.
    pub(crate) maps: Vec<[V6; 6]>,
    /// The matrices of R³ that they come from, with the permutations that they make.
    pub(crate) found: Vec<SpaceMap>,
    /// How far any point of an image may be from the set.
    pub(crate) error: f64,
    /// How far any product of two maps may be from a map.
    pub(crate) slack: f64,
}

/// How large a set is and how exactly it is known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// A direction in which points of the set lie.
    pub(crate) toward: V6,
    /// The length of the longest point, or a little more.
    pub(crate) reach: f64,
    /// How far a computed height along a unit vector may be from the exact one.
    pub(crate) rounding: f64,
}

/// The farthest of a list of points, the first on ties.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointList<'a>(pub(crate) &'a [V6]);

impl Support for PointList<'_> {
    fn support(&mut self, direction: &V6) -> (V6, u32) {
        let mut best = (0, f64::NEG_INFINITY);
        for (i, p) in self.0.iter().enumerate() {
            let h = dot(p, direction);
            if h > best.1 {
                best = (i, h);
            }
        }
        (self.0[best.0], best.0 as u32)
    }
}

/// Points stored coordinate by coordinate, in lanes that the compiler turns into vector code.
#[derive(Clone, Debug, Default)]
pub(crate) struct PointSet {
    lanes: Vec<[[f64; LANES]; 6]>,
    len: usize,
    sum: V6,
    reach: f64,
}

const LANES: usize = 4;

impl PointSet {
    pub(crate) fn clear(&mut self) {
        self.lanes.clear();
        self.len = 0;
        self.sum = [0.0; 6];
        self.reach = 0.0;
    }

    pub(crate) fn push(&mut self, point: &V6) {
        let lane = self.len % LANES;
        if lane == 0 {
            // Repeating the first point of a block in its empty lanes never makes a new winner.
            self.lanes.push(point.map(|x| [x; LANES]));
        } else if let Some(block) = self.lanes.last_mut() {
            for (row, &x) in block.iter_mut().zip(point) {
                row[lane] = x;
            }
        }
        self.len += 1;
        self.sum = add_scaled(&self.sum, 1.0, point);
        self.reach = self.reach.max(norm(point));
    }

    pub(crate) fn get(&self, index: usize) -> V6 {
        let block = &self.lanes[index / LANES];
        std::array::from_fn(|k| block[k][index % LANES])
    }

    /// The length of the longest point.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// The sum of all points.
    pub(crate) fn sum(&self) -> &V6 {
        &self.sum
    }
}

impl Support for &PointSet {
    fn support(&mut self, direction: &V6) -> (V6, u32) {
        let mut high = [f64::NEG_INFINITY; LANES];
        let mut at = [0u64; LANES];
        for (number, block) in self.lanes.iter().enumerate() {
            let mut h = [0.0; LANES];
            for (row, &u) in block.iter().zip(direction) {
                for lane in 0..LANES {
                    h[lane] += row[lane] * u;
                }
            }
            for lane in 0..LANES {
                let better = h[lane] > high[lane];
                high[lane] = if better { h[lane] } else { high[lane] };
                at[lane] = if better { number as u64 } else { at[lane] };
            }
        }
        let mut best = 0;
        for lane in 1..LANES {
            if high[lane] > high[best] {
                best = lane;
            }
        }
        let index = (at[best] as usize * LANES + best).min(self.len.saturating_sub(1));
        (self.get(index), index as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_set_agrees_with_the_list() {
        for len in 1..20 {
            let points: Vec<V6> = (0..len)
                .map(|i| std::array::from_fn(|k| ((i * 7 + k * 13 + i * i * k) as f64).sin()))
                .collect();
            let mut set = PointSet::default();
            points.iter().for_each(|p| set.push(p));
            for s in 0..50 {
                let u: V6 = std::array::from_fn(|k| ((s * 11 + k * 5) as f64).cos());
                let (p, i) = (&set).support(&u);
                let (q, j) = PointList(&points).support(&u);
                assert!((dot(&p, &u) - dot(&q, &u)).abs() <= 1e-14);
                assert_eq!((points[i as usize], i), (p, j));
            }
        }
    }
}
