//! Points that belong to no surface: far from the fitted one, and alone.

use nalgebra::Point3;

use crate::voxel_grid::{VoxelGrid, median, spacing_on_a_sphere};

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
    let limit = FAR * NORMAL * median(residuals.iter().map(|e| e.abs()).collect());
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
    let reach = REACH * spacing_on_a_sphere(points);
    if !(reach > 0.0 && reach.is_finite()) {
        return Vec::new();
    }
    let grid = VoxelGrid::new(points, reach);
    // The point itself is among those within reach.
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
