//! Marching tetrahedra: the mesh between inside and outside.

use nalgebra::{Point3, Vector3};

use crate::lattice::Lattice;
use crate::mesh::Mesh;

/// A corner stays this share of an edge away from both ends.
const LEAST_SHARE: f64 = 0.05;

/// Orders in which the three axes are walked: one tetrahedron of a cube each.
const WALKS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [1, 2, 0],
    [2, 0, 1],
    [0, 2, 1],
    [2, 1, 0],
    [1, 0, 2],
];

/// The surface between inside and outside over the six tetrahedra of every cube.
///
/// Signs come from the labels, so the surface has the topology of the labels, and there is no ambiguous
/// case; places come from `field`, negative inside.
pub(crate) fn march(lattice: &Lattice, inside: &[bool], field: &[f32]) -> Mesh {
    let [nx, ny, nz] = lattice.dims;
    let stride = [1, nx, nx * ny];
    let corner = |m: usize| -> usize {
        (0..3)
            .filter(|bit| m >> bit & 1 == 1)
            .map(|bit| stride[bit])
            .sum()
    };
    let corners: [usize; 8] = std::array::from_fn(corner);
    let mut surface = Surface {
        lattice,
        inside,
        field,
        // Corners of edges that start in this layer and the next, by the direction of the edge.
        layers: [vec![u32::MAX; 8 * nx * ny], vec![u32::MAX; 8 * nx * ny]],
        mesh: Mesh {
            vertices: Vec::new(),
            triangles: Vec::new(),
        },
    };
    for z in 0..nz - 1 {
        for y in 0..ny - 1 {
            for x in 0..nx - 1 {
                let base = lattice.index([x, y, z]);
                let count = corners.iter().filter(|c| inside[base + **c]).count();
                if count == 0 || count == 8 {
                    continue;
                }
                for walk in WALKS {
                    // A tetrahedron as the masks of its corners in the cube.
                    let second = 1 << walk[0];
                    let third = second | 1 << walk[1];
                    surface.tetrahedron(base, [0, second, third, 7], &corners);
                }
            }
        }
        surface.layers.swap(0, 1);
        surface.layers[1].fill(u32::MAX);
    }
    surface.mesh
}

struct Surface<'a> {
    lattice: &'a Lattice,
    inside: &'a [bool],
    field: &'a [f32],
    layers: [Vec<u32>; 2],
    mesh: Mesh,
}

impl Surface<'_> {
    fn tetrahedron(&mut self, base: usize, masks: [usize; 4], corners: &[usize; 8]) {
        let is_inside = |m: &usize| self.inside[base + corners[*m]];
        let (mut ins, mut outs) = (Vec::with_capacity(4), Vec::with_capacity(4));
        for m in masks {
            if is_inside(&m) {
                ins.push(m)
            } else {
                outs.push(m)
            }
        }
        if ins.is_empty() || outs.is_empty() {
            return;
        }
        let middle = |masks: &[usize]| -> Vector3<f64> {
            let bits = |m: &usize| Vector3::new(m & 1, m >> 1 & 1, m >> 2 & 1).map(|b| b as f64);
            masks.iter().map(bits).sum::<Vector3<f64>>() / masks.len() as f64
        };
        let outward = middle(&outs) - middle(&ins);
        let mut at = |i: usize, o: usize| self.vertex(base, ins[i], outs[o], corners);
        match (ins.len(), outs.len()) {
            (1, _) => {
                let t = [at(0, 0), at(0, 1), at(0, 2)];
                self.push(t, &outward);
            }
            (3, _) => {
                let t = [at(0, 0), at(1, 0), at(2, 0)];
                self.push(t, &outward);
            }
            _ => {
                let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 1), at(1, 0)];
                self.push([a, b, c], &outward);
                self.push([a, c, d], &outward);
            }
        }
    }

    /// The corner of the surface on the edge from an inside to an outside vertex.
    fn vertex(&mut self, base: usize, inner: usize, outer: usize, corners: &[usize; 8]) -> u32 {
        let (low, high) = (inner & outer, inner | outer);
        let start = base + corners[low];
        let direction = high & !low;
        let layer_size = self.lattice.dims[0] * self.lattice.dims[1];
        let (layer, place) = (low >> 2, start % layer_size);
        let known = self.layers[layer][8 * place + direction];
        if known != u32::MAX {
            return known;
        }
        let (i, o) = (base + corners[inner], base + corners[outer]);
        let (a, b) = (f64::from(self.field[i]), f64::from(self.field[o]));
        // Where the label overrules the field the corner stays near the middle of what is known.
        let (a, b) = (a.min(-1e-12), b.max(1e-12));
        let share = (a / (a - b)).clamp(LEAST_SHARE, 1.0 - LEAST_SHARE);
        let (from, to) = (self.lattice.place(i), self.lattice.place(o));
        let index = self.mesh.vertices.len() as u32;
        self.mesh.vertices.push(Point3::from(
            from.coords * (1.0 - share) + to.coords * share,
        ));
        self.layers[layer][8 * place + direction] = index;
        index
    }

    fn push(&mut self, [a, b, c]: [u32; 3], outward: &Vector3<f64>) {
        let normal = self.mesh.area_vector(&[a, b, c]);
        let triangle = if normal.dot(outward) < 0.0 {
            [a, c, b]
        } else {
            [a, b, c]
        };
        self.mesh.triangles.push(triangle);
    }
}
