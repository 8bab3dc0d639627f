//! Vertices of a mesh moved onto the sheet of points that they belong to.

use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use crate::mesh::Mesh;
use crate::points::Points;
use crate::tree::Tree;

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

/// Where the normals of the points near a vertex agree less than this, it is on a crease and stays.
const CREASE: f64 = 0.97;
/// Rounds in which vertices of triangles that cut others go back to where they were.
const ROUNDS: usize = 4;

/// Moves every vertex along its normal onto the planes of the points near it whose normals agree with
/// its own. The other side of a thin wall has no influence; vertices far from all points stay.
///
/// Where that would let the mesh cut itself, the vertices stay too.
pub(crate) fn project(mesh: &mut Mesh, sheet: &Sheet) {
    let before = mesh.vertices.clone();
    let places = projected(mesh, sheet);
    mesh.vertices = places;
    for _ in 0..ROUNDS {
        let crossings = Tree::new(mesh).crossings(usize::MAX);
        if crossings.is_empty() {
            return;
        }
        for v in crossings.iter().flatten().flat_map(|t| mesh.triangles[*t]) {
            mesh.vertices[v as usize] = before[v as usize];
        }
    }
}

fn projected(mesh: &Mesh, sheet: &Sheet) -> Vec<Point3<f64>> {
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
        .par_iter()
        .zip(&normals)
        .map(|(vertex, normal)| {
            let Some(normal) = normal.try_normalize(0.0) else {
                return *vertex;
            };
            let (mut sum, mut along, mut total) = (Vector3::zeros(), Vector3::zeros(), 0.0);
            for (squared, i) in sheet.grid.nearest(vertex, NEAR) {
                let n = &sheet.normals[i as usize];
                let agreement = n.dot(&normal);
                if squared > limit || agreement < AGREEMENT || !sheet.seen[i as usize] {
                    continue;
                }
                let weight = agreement * (scale * squared).exp();
                sum += n * (weight * n.dot(&(*vertex - sheet.grid.point(i))));
                along += n * weight;
                total += weight;
            }
            if along.norm() > CREASE * total {
                vertex - sum / total
            } else {
                *vertex
            }
        })
        .collect()
}
