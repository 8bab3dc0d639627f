//! Outliers: points that are far from the fitted surface and isolated.

use nalgebra::Point3;

use crate::voxel_grid::{VoxelGrid, median, spacing_on_a_sphere};

/// A point is far from the surface beyond this many standard deviations of the residuals.
const FAR: f64 = 4.0;
/// A median absolute deviation of a normal distribution times this is its standard deviation.
const NORMAL: f64 = 1.4826;
/// Neighbours are counted within this many mean distances between points.
const REACH: f64 = 2.0;
/// A flat surface has 13 points within that radius of one of its points; a point with fewer
/// neighbours than this is isolated.
const MIN_NEIGHBOURS: usize = 2;

/// Indices of the points with a large residual and hardly any neighbours.
///
/// The loss is redescending with a hard edge: weight 1 up to 4σ, with σ from the median absolute
/// residual, and 0 beyond it, but only for isolated points. Points of a part that no radius
/// describes (an ear, a handle) are far from the surface too, but have neighbours. They keep their
/// weight, so that clouds without outliers lose no point. Costs a few operations per point.
pub(crate) fn outlying_points(points: &[Point3<f64>], residuals: &[f64]) -> Vec<usize> {
    let limit = FAR * NORMAL * median(residuals.iter().map(|e| e.abs()).collect());
    let far: Vec<usize> = (0..points.len())
        .filter(|i| residuals[*i].abs() > limit)
        .collect();
    isolated(points, far)
}

/// Indices of the points with hardly any neighbours, at any distance from the surface.
pub(crate) fn isolated_points(points: &[Point3<f64>]) -> Vec<usize> {
    isolated(points, (0..points.len()).collect())
}

fn isolated(points: &[Point3<f64>], suspects: Vec<usize>) -> Vec<usize> {
    if suspects.is_empty() {
        return suspects;
    }
    let reach = REACH * spacing_on_a_sphere(points);
    if !(reach > 0.0 && reach.is_finite()) {
        return Vec::new();
    }
    let grid = VoxelGrid::near(points, reach, suspects.iter().map(|i| &points[*i]));
    // The point itself is among those within the radius.
    let alone = |i: &usize| {
        let near = grid.within(&points[*i], reach);
        near.take(MIN_NEIGHBOURS + 1).count() <= MIN_NEIGHBOURS
    };
    suspects.into_iter().filter(alone).collect()
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
