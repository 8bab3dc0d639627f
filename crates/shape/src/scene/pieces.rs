//! Connected parts of a cloud.

use nalgebra::Point3;

use crate::voxel_grid::{Key, KeyMap, key};

/// Cubes per linking distance.
const CUBES: i64 = 3;

/// The connected groups among some points, the largest first, and the groups that are too small.
///
/// Points are joined if the centres of their cubes, of a side of a third of `link` (metres), are at most
/// `link` apart. A group is too small with fewer points than `least.0` or than the share `least.1` of all
/// points. Costs a few operations per point and 13 look-ups per cube of the largest group, 135 per cube of
/// the others.
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
    let mut cubes: Vec<Key> = Vec::new();
    let mut inside: Vec<(u32, u32)> = Vec::with_capacity(members.len());
    for &i in members {
        let at = key(&places[i], side);
        let number = *numbers.entry(at).or_insert(cubes.len());
        if number == cubes.len() {
            cubes.push(at);
        }
        inside.push((number as u32, i as u32));
    }
    let roots = joined(&cubes, &numbers);
    // Stable, so that the points of a cube keep their order.
    inside.sort_by_key(|(number, _)| *number);
    let root = |number: u32| roots[number as usize];
    let mut sizes = vec![0; cubes.len()];
    inside
        .iter()
        .for_each(|(number, _)| sizes[root(*number)] += 1);
    let mut groups: Vec<Vec<usize>> = sizes.into_iter().map(Vec::with_capacity).collect();
    for (number, i) in inside {
        groups[root(number)].push(i as usize);
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

/// The group of each cube, named by one of its cubes.
///
/// Neighbours are joined first. Cubes farther apart that belong together and are not joined yet are not
/// both in the largest group, so that the wider search begins only at cubes outside of it.
fn joined(cubes: &[Key], numbers: &KeyMap<usize>) -> Vec<usize> {
    let mut forest = Forest::new(cubes.len());
    let join = |forest: &mut Forest, number: usize, offset: &Key| {
        let beside = [0, 1, 2].map(|k| cubes[number][k].saturating_add(offset[k]));
        if let Some(other) = numbers.get(&beside) {
            forest.join(number, *other);
        }
    };
    let ball = ball();
    let beside = ball.iter().filter(|k| k.iter().all(|x| x.abs() <= 1));
    let half: Vec<&Key> = beside.filter(|k| **k > [0, 0, 0]).collect();
    for number in 0..cubes.len() {
        half.iter().for_each(|k| join(&mut forest, number, k));
    }
    let mut sizes = vec![0; cubes.len()];
    let roots: Vec<usize> = (0..cubes.len()).map(|i| forest.root(i)).collect();
    roots.iter().for_each(|root| sizes[*root] += 1);
    let largest = (0..cubes.len()).max_by_key(|i| sizes[*i]);
    for number in (0..cubes.len()).filter(|i| Some(roots[*i]) != largest) {
        ball.iter().for_each(|k| join(&mut forest, number, k));
    }
    (0..cubes.len()).map(|i| forest.root(i)).collect()
}

/// The steps between cubes whose centres are at most [`CUBES`] sides apart.
fn ball() -> Vec<Key> {
    let range = -CUBES..=CUBES;
    let all = range.clone().flat_map(|x| {
        let range = range.clone();
        let inner = range.clone();
        range.flat_map(move |y| inner.clone().map(move |z| [x, y, z]))
    });
    let near = |k: &Key| k.iter().map(|x| x * x).sum::<i64>() <= CUBES * CUBES;
    all.filter(near).collect()
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
    fn the_groups_are_those_of_all_pairs_of_cubes() {
        let wave = |i: u32, k: f64| 6.0 * (f64::from(i) * k).sin();
        let points: Vec<Point3<f64>> = (0..160)
            .map(|i| Point3::new(wave(i, 1.1), wave(i, 2.3), wave(i, 3.7)))
            .collect();
        let all: Vec<usize> = (0..points.len()).collect();
        let link = 1.9;
        let (groups, _) = connected(&points, &all, link, (1, 0.0));
        // By repeated merging over all pairs of points.
        let cube = |i: usize| key(&points[i], link / CUBES as f64);
        let near = |i: usize, j: usize| {
            let steps = (0..3).map(|k| (cube(i)[k] - cube(j)[k]).pow(2));
            steps.sum::<i64>() <= CUBES * CUBES
        };
        let mut label = all.clone();
        while let Some((i, j)) = all
            .iter()
            .flat_map(|i| all.iter().map(move |j| (*i, *j)))
            .find(|(i, j)| label[*i] < label[*j] && near(*i, *j))
        {
            let (to, from) = (label[i], label[j]);
            label
                .iter_mut()
                .filter(|l| **l == from)
                .for_each(|l| *l = to);
        }
        let distinct: std::collections::BTreeSet<usize> = label.iter().copied().collect();
        assert!(groups.len() > 5 && groups[0].len() > 20, "{}", groups.len());
        assert_eq!(groups.len(), distinct.len());
        for group in &groups {
            assert!(group.iter().all(|i| label[*i] == label[group[0]]));
        }
    }

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
