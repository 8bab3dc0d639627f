//! Carving: labels of a lattice change one by one, each change a simple one, so that the topology of a
//! ball is kept.

use std::collections::BinaryHeap;

use nalgebra::Point3;

use crate::lattice::{Lattice, NEIGHBOURS, simple_table};

/// Reach of the exact start of the distances, in steps of the lattice.
const SPLAT: f64 = 2.0;

/// Distance of every vertex to the cloud, and the point nearest to it.
///
/// Exact within two steps of a point. Elsewhere the nearest point is handed on from vertex to vertex
/// in two sweeps, so that a distance may be too large by a fraction of a step.
pub(crate) fn distances(lattice: &Lattice, points: &[Point3<f64>]) -> (Vec<f32>, Vec<u32>) {
    let mut squared = vec![f32::INFINITY; lattice.len()];
    let mut nearest = vec![u32::MAX; lattice.len()];
    for (i, p) in points.iter().enumerate() {
        lattice.visit(p, SPLAT * lattice.step, |at, d, _| {
            if (d as f32) < squared[at] {
                squared[at] = d as f32;
                nearest[at] = i as u32;
            }
        });
    }
    let [nx, ny, nz] = lattice.dims;
    let stride = [1, nx as isize, (nx * ny) as isize];
    // The 13 neighbours of the 26 that come before a vertex.
    let before: Vec<[isize; 3]> = (0..13)
        .map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1])
        .collect();
    for sign in [1, -1] {
        let offsets: Vec<isize> = before
            .iter()
            .map(|o| sign * (o[0] + o[1] * stride[1] + o[2] * stride[2]))
            .collect();
        let mut relax = |[x, y, z]: [usize; 3]| {
            let here = lattice.index([x, y, z]);
            let place = lattice.origin.coords
                + nalgebra::Vector3::new(x as f64, y as f64, z as f64) * lattice.step;
            for offset in &offsets {
                let there = (here as isize + offset) as usize;
                let candidate = nearest[there];
                if candidate == u32::MAX || candidate == nearest[here] {
                    continue;
                }
                let d = (points[candidate as usize].coords - place).norm_squared() as f32;
                if d < squared[here] {
                    squared[here] = d;
                    nearest[here] = candidate;
                }
            }
        };
        for k in 1..nz - 1 {
            let z = if sign > 0 { k } else { nz - 1 - k };
            for j in 1..ny - 1 {
                let y = if sign > 0 { j } else { ny - 1 - j };
                for i in 1..nx - 1 {
                    let x = if sign > 0 { i } else { nx - 1 - i };
                    relax([x, y, z]);
                }
            }
        }
    }
    (squared.iter().map(|d| d.sqrt()).collect(), nearest)
}

/// Which vertices are inside, and the means to change that safely.
pub(crate) struct Carving {
    pub(crate) inside: Vec<bool>,
    offsets: [isize; NEIGHBOURS],
    border: Vec<bool>,
    simple: Vec<bool>,
}

impl Carving {
    /// All of the lattice but its border: a ball.
    pub(crate) fn solid(lattice: &Lattice) -> Self {
        let border: Vec<bool> = (0..lattice.len()).map(|i| lattice.on_border(i)).collect();
        Self {
            inside: border.iter().map(|b| !b).collect(),
            offsets: lattice.offsets(),
            border,
            simple: simple_table(),
        }
    }

    /// The neighbours of a vertex that is not on the border.
    pub(crate) fn neighbours(&self, at: usize) -> impl Iterator<Item = usize> + use<> {
        let here = at as isize;
        self.offsets.into_iter().map(move |o| (here + o) as usize)
    }

    /// Whether a vertex is inside and has a neighbour outside.
    pub(crate) fn on_surface(&self, at: usize) -> bool {
        self.inside[at] && self.neighbours(at).any(|n| !self.inside[n])
    }

    /// Flips simple vertices from `from` to its opposite, those of the largest urgency first, as long as
    /// there are simple ones with a positive urgency.
    pub(crate) fn flip(&mut self, from: bool, urgency: impl Fn(usize) -> f32) {
        let starts = |at: &usize| {
            self.inside[*at] == from
                && !self.border[*at]
                && urgency(*at) > 0.0
                && self.neighbours(*at).any(|n| self.inside[n] != from)
        };
        let mut queued = vec![false; self.inside.len()];
        let mut heap = BinaryHeap::new();
        for at in (0..self.inside.len()).filter(starts) {
            heap.push(entry(urgency(at), at));
            queued[at] = true;
        }
        while let Some(next) = heap.pop() {
            let at = (!next & 0xffff_ffff) as usize;
            queued[at] = false;
            let around = self.neighbours(at).enumerate();
            let set: usize = around.map(|(k, n)| usize::from(self.inside[n]) << k).sum();
            if !self.simple[set] {
                continue;
            }
            self.inside[at] = !from;
            for n in self.neighbours(at) {
                if self.inside[n] == from && !queued[n] && !self.border[n] {
                    let urgency = urgency(n);
                    if urgency > 0.0 {
                        heap.push(entry(urgency, n));
                        queued[n] = true;
                    }
                }
            }
        }
    }
}

/// A number that orders by urgency, which is positive, and then by the lower index.
fn entry(urgency: f32, at: usize) -> u64 {
    u64::from(urgency.to_bits()) << 32 | (!(at as u64) & 0xffff_ffff)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_a_full_search() {
        let points: Vec<Point3<f64>> = (0..40)
            .map(|i| {
                let t = f64::from(i);
                Point3::new(t.sin(), (1.7 * t).cos(), (0.4 * t).sin())
            })
            .collect();
        let (low, high) = crate::points::bounds(&points);
        let lattice = Lattice::covering(&low, &high, 0.3, 0.1, 100_000);
        let (found, _) = distances(&lattice, &points);
        for (i, d) in found.iter().enumerate() {
            if lattice.on_border(i) {
                continue;
            }
            let place = lattice.place(i);
            let exact = points
                .iter()
                .map(|p| (p - place).norm())
                .fold(f64::INFINITY, f64::min);
            let error = f64::from(*d) - exact;
            assert!((-1e-6..=0.1).contains(&error), "{error}");
        }
    }
}
