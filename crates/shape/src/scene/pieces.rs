//! Connected parts of a cloud.

use nalgebra::Point3;

use crate::voxel_grid::{Key, KeyMap, key};

/// Cubes per linking distance.
const CUBES: i64 = 3;

/// The connected groups among some points, the largest first, and the groups that are too small.
///
/// Points are joined if the centres of their cubes, of a side of a third of `link` (metres), are at most
/// `link` apart. A group is too small with fewer points than `least.0` or than the share `least.1` of all
/// points. Costs a few operations per point and 61 look-ups per occupied cube.
pub(super) fn connected(
    places: &[Point3<f64>],
    members: &[usize],
    link: f64,
    least: (usize, f64),
) -> (Vec<Vec<usize>>, Vec<Vec<usize>>) {
    if !(link > 0.0 && link.is_finite()) {
        return (vec![members.to_vec()], Vec::new());
    }
    let side = link / CUBES as f64;
    let mut numbers: KeyMap<usize> = KeyMap::default();
    let mut cubes: Vec<(Key, Vec<usize>)> = Vec::new();
    for &i in members {
        let at = key(&places[i], side);
        let number = *numbers.entry(at).or_insert(cubes.len());
        match cubes.get_mut(number) {
            Some(cube) => cube.1.push(i),
            None => cubes.push((at, vec![i])),
        }
    }
    let mut forest = Forest::new(cubes.len());
    let offsets = half_ball();
    for (number, (at, _)) in cubes.iter().enumerate() {
        for offset in &offsets {
            let beside = [0, 1, 2].map(|k| at[k].saturating_add(offset[k]));
            if let Some(other) = numbers.get(&beside) {
                forest.join(number, *other);
            }
        }
    }
    let mut groups: Vec<Vec<usize>> = vec![Vec::new(); cubes.len()];
    for (number, (_, inside)) in cubes.into_iter().enumerate() {
        groups[forest.root(number)].extend(inside);
    }
    groups.retain(|group| !group.is_empty());
    // Ties are broken by the lowest point along x, then y, then z, so that the result does not
    // depend on the order of the points.
    let lowest = |group: &Vec<usize>| {
        let points = group.iter().map(|i| places[*i]);
        let before = |a: &Point3<f64>, b: &Point3<f64>| {
            let axes = (0..3).map(|k| a[k].total_cmp(&b[k]));
            axes.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
        };
        points.min_by(before).map(|p| [p.x, p.y, p.z])
    };
    let mut keyed: Vec<_> = groups.into_iter().map(|g| (lowest(&g), g)).collect();
    keyed.sort_by(|a, b| {
        let size = b.1.len().cmp(&a.1.len());
        size.then_with(|| a.0.partial_cmp(&b.0).unwrap_or(std::cmp::Ordering::Equal))
    });
    let needed = least
        .0
        .max((least.1 * members.len() as f64).ceil() as usize);
    // A small cloud may have no group of that size; then its largest is the object.
    let needed = needed.min(keyed.first().map_or(0, |g| g.1.len()));
    let groups = keyed.into_iter().map(|(_, group)| group);
    groups.partition(|group| group.len() >= needed)
}

/// Half of the steps between cubes whose centres are at most [`CUBES`] sides apart.
fn half_ball() -> Vec<Key> {
    let range = -CUBES..=CUBES;
    let all = range.clone().flat_map(|x| {
        let range = range.clone();
        let inner = range.clone();
        range.flat_map(move |y| inner.clone().map(move |z| [x, y, z]))
    });
    let near = |k: &Key| k.iter().map(|x| x * x).sum::<i64>() <= CUBES * CUBES;
    all.filter(|k| near(k) && *k > [0, 0, 0]).collect()
}

/// Disjoint sets.
struct Forest(Vec<usize>);

impl Forest {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_join_and_gaps_part() {
        let place = |x: f64| Point3::new(x, 0.1, -0.2);
        let mut points: Vec<Point3<f64>> = (0..40).map(|i| place(f64::from(i))).collect();
        points.extend((0..20).map(|i| place(100.0 + f64::from(i))));
        points.push(place(500.0));
        let all: Vec<usize> = (0..points.len()).rev().collect();
        let (groups, crumbs) = connected(&points, &all, 2.5, (2, 0.0));
        assert_eq!((groups.len(), crumbs.len()), (2, 1));
        assert_eq!((groups[0].len(), groups[1].len()), (40, 20));
        assert_eq!(crumbs[0], [60]);
    }
}
