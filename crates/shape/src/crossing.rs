//! A fast test whether a surface intersects itself or folds. It is not a proof; a fit uses it to
//! choose λ.

use nalgebra::{Point3, Vector3};
use sph::Coefficients;
use sph::grid::RingGrid;
use sphere_map::{Mesh, Tree};

use crate::normals::normals;

/// Rings of the mesh per degree.
const RINGS: f64 = 2.4;
/// An area element below this share of the largest one counts as a fold.
const FLAT: f64 = 3e-3;

/// A place where a fine mesh of the surface cuts itself, or where the area element nearly vanishes.
pub(crate) fn crossing(coordinates: &[Coefficients; 3]) -> Option<Point3<f64>> {
    let rows = (RINGS * coordinates[0].degree() as f64) as usize + 3;
    let columns = 2 * (rows - 1);
    let grid = RingGrid::equiangular(rows, columns);
    let [x, y, z] = coordinates.each_ref().map(|c| grid.synthesis(c).values);
    let vertices: Vec<Point3<f64>> = (0..rows * columns)
        .map(|i| Point3::new(x[i], y[i], z[i]))
        .collect();
    let sizes: Vec<f64> = normals(coordinates, &grid)
        .iter()
        .map(Vector3::norm)
        .collect();
    let largest = sizes.iter().fold(0.0, |a: f64, b| a.max(*b));
    if let Some(flat) = sizes.iter().position(|size| !(*size > FLAT * largest)) {
        return Some(vertices[flat]);
    }
    let mesh = Mesh {
        vertices,
        triangles: triangles(rows, columns),
    };
    let pair = Tree::new(&mesh).crossings(1).into_iter().next()?;
    let corner = mesh.triangles[pair[0]][0];
    Some(mesh.vertices[corner as usize])
}

/// The triangles of a regular grid with one vertex at each pole.
fn triangles(rows: usize, columns: usize) -> Vec<[u32; 3]> {
    let at = |row: usize, column: usize| -> u32 {
        let pole = row == 0 || row + 1 == rows;
        let column = if pole { 0 } else { column % columns };
        (row * columns + column) as u32
    };
    let mut triangles = Vec::with_capacity(2 * rows * columns);
    for j in 0..rows - 1 {
        for k in 0..columns {
            let [a, b, c, d] = [at(j, k), at(j + 1, k), at(j + 1, k + 1), at(j, k + 1)];
            if j + 2 < rows {
                triangles.push([a, b, c]);
            }
            if j > 0 {
                triangles.push([a, c, d]);
            }
        }
    }
    triangles
}
