//! Points that belong to no surface: far from the fitted one, and alone.

use std::collections::HashMap;

use nalgebra::Point3;

/// A point is far from the surface beyond this many standard deviations of the residuals.
const FAR: f64 = 4.0;
/// A median absolute deviation of a normal distribution times this is its standard deviation.
const NORMAL: f64 = 1.4826;
/// Neighbours are counted within this many mean distances between points.
const REACH: f64 = 2.0;
/// A flat surface has 13 points within reach of one of its points; a point with fewer others than
/// this is alone.
const MIN_NEIGHBOURS: usize = 2;

/// Indices of the points with a large residual and hardly any neighbours.
///
/// The loss behind it is a redescending one with a hard edge: weight 1 up to 4σ, with σ from the
/// median absolute residual, and 0 beyond it, but only for points that are alone in space. What a
/// radius cannot describe (an ear, a handle) is far from the surface too, but in company; it keeps
/// its weight, so that clouds without outliers lose nothing. Costs a few operations a point.
pub(crate) fn outlying_points(points: &[Point3<f64>], residuals: &[f64]) -> Vec<usize> {
    let limit = FAR * NORMAL * median_size(residuals);
    let far: Vec<usize> = (0..points.len())
        .filter(|i| residuals[*i].abs() > limit)
        .collect();
    isolated(points, far)
}

/// Indices of the points with hardly any neighbours, wherever the surface is.
pub(crate) fn isolated_points(points: &[Point3<f64>]) -> Vec<usize> {
    isolated(points, (0..points.len()).collect())
}

fn isolated(points: &[Point3<f64>], suspects: Vec<usize>) -> Vec<usize> {
    if suspects.is_empty() {
        return suspects;
    }
    let reach = REACH * spacing(points);
    if !(reach > 0.0 && reach.is_finite()) {
        return Vec::new();
    }
    let boxes = VoxelGrid::new(points, reach);
    let alone = |i: &usize| boxes.others_near(&points[*i], MIN_NEIGHBOURS) < MIN_NEIGHBOURS;
    suspects.into_iter().filter(alone).collect()
}

/// Points by the cube they lie in.
struct VoxelGrid<'a> {
    points: &'a [Point3<f64>],
    side: f64,
    members: HashMap<[i64; 3], Vec<usize>>,
}

impl<'a> VoxelGrid<'a> {
    fn new(points: &'a [Point3<f64>], side: f64) -> Self {
        let mut boxes = Self {
            points,
            side,
            members: HashMap::with_capacity(points.len()),
        };
        for (i, p) in points.iter().enumerate() {
            boxes.members.entry(boxes.key(p)).or_default().push(i);
        }
        boxes
    }

    fn key(&self, p: &Point3<f64>) -> [i64; 3] {
        [p.x, p.y, p.z].map(|x| (x / self.side).floor() as i64)
    }

    /// How many points other than p itself lie within one side of it; counts no further than
    /// `enough`.
    fn others_near(&self, p: &Point3<f64>, enough: usize) -> usize {
        let [x, y, z] = self.key(p);
        let near = |k: i64| k.saturating_sub(1)..=k.saturating_add(1);
        let keys = near(x).flat_map(|x| near(y).flat_map(move |y| near(z).map(move |z| [x, y, z])));
        keys.filter_map(|key| self.members.get(&key))
            .flatten()
            .filter(|i| (self.points[**i] - p).norm() <= self.side)
            .take(enough + 1)
            .count()
            .saturating_sub(1)
    }
}

fn median_size(residuals: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = residuals.iter().map(|e| e.abs()).collect();
    let middle = sizes.len() / 2;
    if sizes.is_empty() {
        return 0.0;
    }
    *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Distance between neighbours if the points were spread over the sphere of their median distance
/// from their middle.
fn spacing(points: &[Point3<f64>]) -> f64 {
    let median = |axis: usize| {
        let mut values: Vec<f64> = points.iter().map(|p| p[axis]).collect();
        let middle = values.len() / 2;
        *values.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let centre = Point3::new(median(0), median(1), median(2));
    let distances: Vec<f64> = points.iter().map(|p| (p - centre).norm()).collect();
    median_size(&distances) * (4.0 * std::f64::consts::PI / points.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::even_directions;

    #[test]
    fn an_isolated_point_is_an_outlier_and_a_patch_is_not() {
        let directions = even_directions(4000);
        let mut residuals: Vec<f64> = (0..4000).map(|i| 1e-4 * (i as f64).sin()).collect();
        let mut points: Vec<Point3<f64>> = directions
            .iter()
            .map(|p| Point3::from(p.into_inner() * 0.05))
            .collect();
        // A cap lifted by 20 mm, as an ear would be; the surface stays below.
        for (i, p) in directions.iter().enumerate().filter(|(_, p)| p.z > 0.97) {
            points[i] += p.into_inner() * 0.02;
            residuals[i] = -0.02;
        }
        points[2000] *= 2.0;
        residuals[2000] = -0.05;
        assert_eq!(outlying_points(&points, &residuals), [2000]);
        assert_eq!(isolated_points(&points), [2000]);
    }

    #[test]
    fn degenerate_points_are_no_trouble() {
        assert!(outlying_points(&[], &[]).is_empty());
        let points = vec![Point3::new(1.0, 1.0, 1.0); 9];
        let mut residuals = vec![0.0; 9];
        residuals[4] = 1.0;
        assert!(outlying_points(&points, &residuals).is_empty());
    }
}
