//! Vertices of a mesh moved onto the sheet of points that they belong to.

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::mesh::Mesh;
use crate::points::Points;

/// Points looked at, and the least cosine between their normals and that of the vertex.
const NEAR: usize = 24;
const AGREEMENT: f64 = 0.3;
/// Points farther than this many spacings have no influence; the weights are Gaussians of this width.
const REACH: f64 = 2.5;
const WIDTH: f64 = 0.8;

/// A cloud with outward normals.
pub(crate) struct Sheet<'a> {
    pub(crate) grid: &'a Points<'a>,
    pub(crate) normals: &'a [Vector3<f64>],
    pub(crate) seen: &'a [bool],
    pub(crate) spacing: f64,
}

/// Moves every vertex along its normal onto the planes of the points near it whose normals agree with
/// its own. The other side of a thin wall has no influence; vertices far from all points stay.
pub(crate) fn project(mesh: &mut Mesh, sheet: &Sheet) {
    let mut normals = vec![Vector3::zeros(); mesh.vertices.len()];
    for triangle in &mesh.triangles {
        let vector = mesh.area_vector(triangle);
        for v in triangle {
            normals[*v as usize] += vector;
        }
    }
    let scale = -0.5 / (WIDTH * sheet.spacing).powi(2);
    let limit = (REACH * sheet.spacing).powi(2);
    mesh.vertices
        .par_iter_mut()
        .zip(&normals)
        .for_each(|(vertex, normal)| {
            let Some(normal) = normal.try_normalize(0.0) else {
                return;
            };
            let (mut sum, mut total) = (Vector3::zeros(), 0.0);
            for (squared, i) in sheet.grid.nearest(vertex, NEAR) {
                let n = &sheet.normals[i as usize];
                let agreement = n.dot(&normal);
                if squared > limit || agreement < AGREEMENT || !sheet.seen[i as usize] {
                    continue;
                }
                let weight = agreement * (scale * squared).exp();
                sum += n * (weight * n.dot(&(*vertex - sheet.grid.point(i))));
                total += weight;
            }
            if total > 0.0 {
                *vertex -= sum / total;
            }
        });
}
