//! A cloud sorted into cells, for neighbours and normals.

use nalgebra::{Matrix3, Point3, Vector3};
use rayon::prelude::*;

/// Most cells of the grid.
const MOST_CELLS: f64 = 2e6;
/// Neighbours that determine a normal, the point itself included.
const PLANE: usize = 14;
/// A point of an even cloud has its sixth neighbour at 1/0.72 of the spacing 1/√density.
const SPACING: (usize, f64) = (6, 0.72);

/// Points in the cells of a cubic grid.
pub(crate) struct Points<'a> {
    points: &'a [Point3<f64>],
    low: Point3<f64>,
    cell: f64,
    dims: [usize; 3],
    /// Start of every cell in `order`, and the number of points.
    starts: Vec<u32>,
    order: Vec<u32>,
}

impl<'a> Points<'a> {
    /// Sorts finite points; linear in their number.
    pub(crate) fn new(points: &'a [Point3<f64>]) -> Self {
        let (low, high) = bounds(points);
        let extent = high - low;
        let longest = extent.max().max(f64::MIN_POSITIVE);
        let box_area = 2.0 * (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x);
        let even = (box_area / points.len() as f64).sqrt();
        let cell = even.max(longest * 1e-3);
        let count = |c: f64| -> f64 { extent.iter().map(|e| (e / c).floor() + 1.0).product() };
        let cell = if count(cell) > MOST_CELLS {
            longest / MOST_CELLS.cbrt()
        } else {
            cell
        };
        let dims = [extent.x, extent.y, extent.z].map(|e| (e / cell) as usize + 1);
        let mut grid = Self {
            points,
            low,
            cell,
            dims,
            starts: vec![0; dims.iter().product::<usize>() + 1],
            order: vec![0; points.len()],
        };
        let keys: Vec<usize> = points.iter().map(|p| grid.key(grid.cell_of(p))).collect();
        for key in &keys {
            grid.starts[key + 1] += 1;
        }
        for k in 1..grid.starts.len() {
            grid.starts[k] += grid.starts[k - 1];
        }
        let mut next = grid.starts.clone();
        for (i, key) in keys.iter().enumerate() {
            grid.order[next[*key] as usize] = i as u32;
            next[*key] += 1;
        }
        grid
    }

    fn cell_of(&self, p: &Point3<f64>) -> [usize; 3] {
        std::array::from_fn(|axis| {
            let at = (p[axis] - self.low[axis]) / self.cell;
            (at.max(0.0) as usize).min(self.dims[axis] - 1)
        })
    }

    fn key(&self, [x, y, z]: [usize; 3]) -> usize {
        x + self.dims[0] * (y + self.dims[1] * z)
    }

    pub(crate) fn point(&self, index: u32) -> &Point3<f64> {
        &self.points[index as usize]
    }

    /// The `count` points nearest to `q`, nearest first, with squared distances.
    pub(crate) fn nearest(&self, q: &Point3<f64>, count: usize) -> Vec<(f64, u32)> {
        let centre = self.cell_of(q);
        let widest = self.dims.iter().max().copied().unwrap_or(1);
        let mut reach = 1;
        loop {
            let mut found = Vec::new();
            let range = |axis: usize| {
                centre[axis].saturating_sub(reach)..(centre[axis] + reach + 1).min(self.dims[axis])
            };
            for z in range(2) {
                for y in range(1) {
                    let row = |x: usize| self.key([x, y, z]);
                    let (from, to) = (row(range(0).start), row(range(0).end - 1) + 1);
                    let members = self.starts[from] as usize..self.starts[to] as usize;
                    for &i in &self.order[members] {
                        found.push(((self.points[i as usize] - q).norm_squared(), i));
                    }
                }
            }
            let sure = (reach as f64 * self.cell).powi(2);
            let enough = found.iter().filter(|(d, _)| *d <= sure).count() >= count;
            if enough || reach >= widest {
                let by_distance =
                    |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
                if found.len() > count {
                    found.select_nth_unstable_by(count, by_distance);
                    found.truncate(count);
                }
                found.sort_unstable_by(by_distance);
                return found;
            }
            reach *= 2;
        }
    }

    /// 1/√density of an even cloud: the median over the points.
    pub(crate) fn spacing(&self) -> f64 {
        let (neighbour, share) = SPACING;
        let step = self.points.len().div_ceil(4000);
        let sampled: Vec<usize> = (0..self.points.len()).step_by(step).collect();
        let mut distances: Vec<f64> = sampled
            .par_iter()
            .map(|i| {
                let found = self.nearest(&self.points[*i], neighbour + 1);
                found.last().map_or(0.0, |(d, _)| d.sqrt())
            })
            .collect();
        distances.sort_by(f64::total_cmp);
        share * distances[distances.len() / 2]
    }

    /// Unit normals of the planes through the neighbours of every point, of either sign.
    pub(crate) fn normals(&self) -> Vec<Vector3<f64>> {
        self.points
            .par_iter()
            .map(|p| {
                let near = self.nearest(p, PLANE);
                let at = |(_, i): &(f64, u32)| self.points[*i as usize].coords;
                let mean = near.iter().map(at).sum::<Vector3<f64>>() / near.len() as f64;
                let spread: Matrix3<f64> = near
                    .iter()
                    .map(|n| (at(n) - mean) * (at(n) - mean).transpose())
                    .sum();
                let eigen = spread.symmetric_eigen();
                eigen.eigenvectors.column(eigen.eigenvalues.imin()).into()
            })
            .collect()
    }
}

/// The corners of the bounding box.
pub(crate) fn bounds(points: &[Point3<f64>]) -> (Point3<f64>, Point3<f64>) {
    points
        .iter()
        .fold((points[0], points[0]), |(low, high), p| {
            (low.inf(p), high.sup(p))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_points_are_those_of_a_full_search() {
        let points: Vec<Point3<f64>> = (0..500)
            .map(|i| {
                let t = f64::from(i);
                Point3::new((t * 1.3).sin(), (t * 2.7).cos(), 0.3 * (t * 0.61).sin())
            })
            .collect();
        let grid = Points::new(&points);
        for q in points.iter().step_by(17) {
            let q = q + Vector3::new(0.4, -0.01, 0.02);
            let mut all: Vec<f64> = points.iter().map(|p| (p - q).norm_squared()).collect();
            all.sort_by(f64::total_cmp);
            let found = grid.nearest(&q, 9);
            assert_eq!(found.len(), 9);
            for (a, (b, _)) in all.iter().zip(&found) {
                assert!((a - b).abs() <= 1e-12);
            }
        }
    }
}
