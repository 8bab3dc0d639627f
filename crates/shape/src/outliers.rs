//! Points that belong to no surface: far from the fitted one, and alone.

use std::collections::HashMap;

use nalgebra::Point3;

/// A point is far from the surface beyond this many standard deviations of the residuals.
const FAR: f64 = 4.0;
/// A median absolute deviation of a normal distribution times this is its standard deviation.
const NORMAL: f64 = 1.4826;
/// Side of the cells in which neighbours are counted, in mean distances between points.
const CELL: f64 = 2.0;
/// A flat surface has 36 points in the 27 cells around one of its points; a point with fewer than
/// this is alone.
const COMPANY: usize = 5;

/// Indices of the points with a large residual and hardly any neighbours.
///
/// The loss behind it is a redescending one with a hard edge: weight 1 up to 4σ, with σ from the
/// median absolute residual, and 0 beyond it, but only for points that are alone in space. What a
/// radius cannot describe (an ear, a handle) is far from the surface too, but in company; it keeps
/// its weight, so that clouds without outliers lose nothing. Costs a few operations a point.
pub(crate) fn stray_points(points: &[Point3<f64>], residuals: &[f64]) -> Vec<usize> {
    let limit = FAR * NORMAL * median_size(residuals);
    let far: Vec<usize> = (0..points.len())
        .filter(|i| residuals[*i].abs() > limit)
        .collect();
    if far.is_empty() {
        return far;
    }
    let side = CELL * spacing(points);
    if !(side > 0.0 && side.is_finite()) {
        return Vec::new();
    }
    let cell = |p: &Point3<f64>| [p.x, p.y, p.z].map(|x| (x / side).floor() as i64);
    let mut counts: HashMap<[i64; 3], usize> = HashMap::with_capacity(points.len());
    for p in points {
        *counts.entry(cell(p)).or_default() += 1;
    }
    let around = |[x, y, z]: [i64; 3]| -> usize {
        let near = |k: i64| k.saturating_sub(1)..=k.saturating_add(1);
        near(x)
            .flat_map(|x| near(y).flat_map(move |y| near(z).map(move |z| [x, y, z])))
            .filter_map(|cell| counts.get(&cell))
            .sum()
    };
    let alone = |i: &usize| around(cell(&points[*i])) < COMPANY;
    far.into_iter().filter(alone).collect()
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
    fn a_lone_point_is_stray_and_a_patch_is_not() {
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
        assert_eq!(stray_points(&points, &residuals), [2000]);
    }

    #[test]
    fn degenerate_points_are_no_trouble() {
        assert!(stray_points(&[], &[]).is_empty());
        let points = vec![Point3::new(1.0, 1.0, 1.0); 9];
        let mut residuals = vec![0.0; 9];
        residuals[4] = 1.0;
        assert!(stray_points(&points, &residuals).is_empty());
    }
}
