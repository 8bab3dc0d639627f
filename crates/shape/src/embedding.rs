//! Classical multidimensional scaling: points of the plane whose distances resemble given ones.

use nalgebra::DMatrix;

/// Coordinates and how much of the squared distances they explain.
#[derive(Clone, Debug, PartialEq)]
pub struct Embedding {
    /// One row per object, `dimensions` numbers each, in the unit of the distances.
    pub coordinates: Vec<Vec<f64>>,
    /// All eigenvalues of the doubly centred matrix, largest first.
    pub eigenvalues: Vec<f64>,
}

/// Torgerson's classical scaling of a symmetric n×n table of distances.
///
/// B = −½ J D² J, coordinates = eigenvectors × √eigenvalue. The sign of each axis is fixed by
/// making its entry of largest size positive. Costs n³.
pub fn classical_scaling(distances: &[Vec<f64>], dimensions: usize) -> Embedding {
    let n = distances.len();
    let squared = DMatrix::from_fn(n, n, |i, j| distances[i][j] * distances[i][j]);
    let row_mean: Vec<f64> = (0..n).map(|i| squared.row(i).mean()).collect();
    let mean = squared.mean();
    let centred = DMatrix::from_fn(n, n, |i, j| {
        -0.5 * (squared[(i, j)] - row_mean[i] - row_mean[j] + mean)
    });
    let eigen = centred.symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let mut coordinates = vec![vec![0.0; dimensions]; n];
    for (axis, &k) in order.iter().take(dimensions).enumerate() {
        let vector = eigen.eigenvectors.column(k);
        let scale = eigen.eigenvalues[k].max(0.0).sqrt();
        let sign = 1.0_f64.copysign(vector[vector.iamax()]);
        for i in 0..n {
            coordinates[i][axis] = sign * scale * vector[i];
        }
    }
    Embedding {
        coordinates,
        eigenvalues: order.iter().map(|&k| eigen.eigenvalues[k]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_in_the_plane_are_kept() {
        let points = [(0.0, 0.0), (3.0, 0.0), (0.0, 4.0), (-2.0, 1.0), (1.0, -5.0)];
        let table: Vec<Vec<f64>> = points
            .iter()
            .map(|a: &(f64, f64)| {
                points
                    .iter()
                    .map(|b| (a.0 - b.0).hypot(a.1 - b.1))
                    .collect()
            })
            .collect();
        let embedding = classical_scaling(&table, 2);
        for (i, a) in embedding.coordinates.iter().enumerate() {
            for (j, b) in embedding.coordinates.iter().enumerate() {
                let d = (a[0] - b[0]).hypot(a[1] - b[1]);
                assert!((d - table[i][j]).abs() <= 1e-12);
            }
        }
        assert!(embedding.eigenvalues[2].abs() <= 1e-12);
    }
}
