//! The noise of a cloud, from what its neighbours say of each point.

use nalgebra::{Matrix3, Point3, SMatrix, SVector, SymmetricEigen, Vector3};
use rayon::prelude::*;

use crate::voxel_grid::{VoxelGrid, median, spacing, subset};

/// Points at which the noise is measured.
const PATCHES: usize = 600;
/// Points of a patch.
const NEIGHBOURS: usize = 24;
/// Radius in which they are looked for, in spacings; a disc of it holds 50 points.
const REACH: f64 = 4.0;
/// Coefficients of a quadric.
const COEFFICIENTS: usize = 6;

/// Standard deviation of the points across the surface they lie on, metres.
///
/// At 600 points of the cloud a quadratic height over the plane of the 24 nearest neighbours is fitted to
/// them; the median of the standard deviations that remain is not moved by edges or outliers. Independent
/// of the order of the points, which should be distinct. 0 where there are too few points.
pub fn noise(points: &[Point3<f64>]) -> f64 {
    let reach = REACH * spacing(points);
    if !(reach > 0.0 && reach.is_finite()) {
        return 0.0;
    }
    let places: Vec<Point3<f64>> = subset(points, PATCHES).iter().map(|i| points[*i]).collect();
    let grid = VoxelGrid::near(points, reach, places.iter());
    let deviations: Vec<f64> = places
        .par_iter()
        .filter_map(|p| {
            let mut near: Vec<(usize, f64)> = grid.within(p, reach).collect();
            if near.len() > NEIGHBOURS {
                near.select_nth_unstable_by(NEIGHBOURS, |a, b| a.1.total_cmp(&b.1));
                near.truncate(NEIGHBOURS);
            }
            let patch: Vec<Point3<f64>> = near.iter().map(|(k, _)| points[*k]).collect();
            deviation(&patch)
        })
        .collect();
    median(deviations)
}

/// Standard deviation of points from a quadratic height over their plane.
fn deviation(patch: &[Point3<f64>]) -> Option<f64> {
    if patch.len() < 2 * COEFFICIENTS {
        return None;
    }
    let n = patch.len() as f64;
    let first = patch[0];
    let mean = first + patch.iter().map(|p| p - first).sum::<Vector3<f64>>() / n;
    let spread: Matrix3<f64> = patch
        .iter()
        .map(|p| (p - mean) * (p - mean).transpose())
        .sum();
    let eigen = SymmetricEigen::new(spread);
    let least = eigen.eigenvalues.imin();
    let size = (eigen.eigenvalues.max() / n).sqrt();
    if !(size > 0.0) {
        return None;
    }
    let normal = eigen.eigenvectors.column(least).into_owned();
    let e1 = eigen.eigenvectors.column((least + 1) % 3).into_owned();
    let e2 = eigen.eigenvectors.column((least + 2) % 3).into_owned();
    let row = |p: &Point3<f64>| {
        let arm = (p - mean) / size;
        let (u, v) = (arm.dot(&e1), arm.dot(&e2));
        let basis = SVector::<f64, COEFFICIENTS>::from([1.0, u, v, u * u, u * v, v * v]);
        (basis, arm.dot(&normal))
    };
    let mut gram = SMatrix::<f64, COEFFICIENTS, COEFFICIENTS>::zeros();
    let mut right = SVector::<f64, COEFFICIENTS>::zeros();
    for (basis, height) in patch.iter().map(row) {
        gram += basis * basis.transpose();
        right += basis * height;
    }
    let quadric = (gram + SMatrix::identity() * (1e-12 * gram.trace()))
        .cholesky()?
        .solve(&right);
    let rest = patch
        .iter()
        .map(row)
        .map(|(basis, height)| height - basis.dot(&quadric));
    let squares: f64 = rest.map(|e| e * e).sum();
    Some(size * (squares / (n - COEFFICIENTS as f64)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::even_directions;

    #[test]
    fn the_noise_of_a_ball_is_found() {
        for sigma in [0.0, 2e-4, 2e-3] {
            // Sums of four numbers spread evenly over 1, of standard deviation 0.577.
            let wave = |i: usize| {
                let each = (0..4).map(|k| ((i * 4 + k) as f64 * 12.9898).sin() * 43_758.545);
                each.map(|x| x - x.floor() - 0.5).sum::<f64>() / 0.577
            };
            let points: Vec<Point3<f64>> = even_directions(8000)
                .iter()
                .enumerate()
                .map(|(i, p)| Point3::from(p.into_inner() * (0.05 + sigma * wave(i))))
                .collect();
            let found = noise(&points);
            assert!(
                (found - sigma).abs() <= 0.2 * sigma + 1e-5,
                "{found} {sigma}"
            );
        }
        assert_eq!(noise(&[]), 0.0);
        assert_eq!(noise(&[Point3::origin(); 40]), 0.0);
    }
}
