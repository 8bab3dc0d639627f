//! The Freudenthal lattice: a cubic grid whose cubes are cut into six tetrahedra each.
//!
//! Every vertex has 14 neighbours, ±{100, 010, 001, 110, 101, 011, 111}. They triangulate a sphere
//! around it, so that the topology of a set of vertices and of its complement are decided by the same
//! adjacency.

use nalgebra::{Point3, Vector3};

/// Number of neighbours of a vertex.
pub(crate) const NEIGHBOURS: usize = 14;

/// A box of lattice vertices.
#[derive(Clone, Debug)]
pub(crate) struct Lattice {
    pub(crate) dims: [usize; 3],
    pub(crate) origin: Point3<f64>,
    pub(crate) step: f64,
}

impl Lattice {
    /// The lattice of at most `most` vertices that covers a box and `margin` around it; the step is
    /// at least `step`.
    pub(crate) fn covering(
        low: &Point3<f64>,
        high: &Point3<f64>,
        margin: f64,
        step: f64,
        most: usize,
    ) -> Self {
        let extent = (high - low).add_scalar(2.0 * margin);
        let volume = extent.x * extent.y * extent.z;
        let step = step.max((volume / most as f64).cbrt());
        // Two layers on each side belong to the border and its neighbours.
        let dims = [extent.x, extent.y, extent.z].map(|e| (e / step).ceil() as usize + 5);
        Self {
            dims,
            origin: low - Vector3::repeat(margin + 2.0 * step),
            step,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.dims.iter().product()
    }

    pub(crate) fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        x + self.dims[0] * (y + self.dims[1] * z)
    }

    pub(crate) fn cell(&self, index: usize) -> [usize; 3] {
        let rest = index / self.dims[0];
        [
            index % self.dims[0],
            rest % self.dims[1],
            rest / self.dims[1],
        ]
    }

    pub(crate) fn place(&self, index: usize) -> Point3<f64> {
        self.origin + Vector3::from(self.cell(index).map(|k| k as f64)) * self.step
    }

    /// Distances in the list from a vertex to its neighbours; the eighth and later ones are the
    /// negatives of the first seven. Neighbour k < 7 has the offsets of the bits of k + 1.
    pub(crate) fn offsets(&self) -> [isize; NEIGHBOURS] {
        let stride = [1, self.dims[0], self.dims[0] * self.dims[1]];
        std::array::from_fn(|k| {
            let sum: usize = (0..3)
                .filter(|bit| (k % 7 + 1) >> bit & 1 == 1)
                .map(|bit| stride[bit])
                .sum();
            if k < 7 { sum as isize } else { -(sum as isize) }
        })
    }

    pub(crate) fn on_border(&self, index: usize) -> bool {
        let cell = self.cell(index);
        (0..3).any(|axis| cell[axis] == 0 || cell[axis] + 1 == self.dims[axis])
    }

    /// Ranges of the vertices within `reach` of a point, per axis.
    pub(crate) fn around(&self, p: &Point3<f64>, reach: f64) -> [std::ops::Range<usize>; 3] {
        std::array::from_fn(|axis| {
            let at = (p[axis] - self.origin[axis]) / self.step;
            let low = (at - reach / self.step).ceil().max(0.0) as usize;
            let high = (at + reach / self.step).floor() + 1.0;
            low..(high.max(0.0) as usize).min(self.dims[axis])
        })
    }

    /// Visits the vertices within `reach` of a point, with the squared distance.
    pub(crate) fn visit(
        &self,
        p: &Point3<f64>,
        reach: f64,
        mut act: impl FnMut(usize, f64, Vector3<f64>),
    ) {
        let [xs, ys, zs] = self.around(p, reach);
        let limit = reach * reach;
        let offset = self.origin - p;
        for z in zs {
            let dz = offset.z + self.step * z as f64;
            for y in ys.clone() {
                let dy = offset.y + self.step * y as f64;
                let row = self.dims[0] * (y + self.dims[1] * z);
                let rest = dy * dy + dz * dz;
                if rest > limit {
                    continue;
                }
                for x in xs.clone() {
                    let dx = offset.x + self.step * x as f64;
                    let squared = dx * dx + rest;
                    if squared <= limit {
                        act(row + x, squared, Vector3::new(dx, dy, dz));
                    }
                }
            }
        }
    }
}

/// For every set of inside neighbours whether a vertex is simple.
///
/// Changing the label of a vertex keeps the homotopy type of the inside and of the outside exactly if
/// its inside neighbours are connected and not empty, and so are the outside ones: on the sphere of the
/// neighbours Alexander duality gives the rest.
pub(crate) fn simple_table() -> Vec<bool> {
    let offsets: [[i32; 3]; NEIGHBOURS] = std::array::from_fn(|k| {
        let sign = if k < 7 { 1 } else { -1 };
        [0, 1, 2].map(|bit| sign * ((k % 7 + 1) >> bit & 1) as i32)
    });
    let adjacent: [u32; NEIGHBOURS] = std::array::from_fn(|i| {
        let neighbour = |j: &usize| {
            let difference = [0, 1, 2].map(|axis| offsets[i][axis] - offsets[*j][axis]);
            offsets.contains(&difference)
        };
        (0..NEIGHBOURS).filter(neighbour).map(|j| 1 << j).sum()
    });
    let connected = |set: u32| {
        let mut seen = set & set.wrapping_neg();
        loop {
            let mut next = seen;
            for (i, around) in adjacent.iter().enumerate() {
                if seen >> i & 1 == 1 {
                    next |= around & set;
                }
            }
            if next == seen {
                return set != 0 && seen == set;
            }
            seen = next;
        }
    };
    let all = (1_u32 << NEIGHBOURS) - 1;
    (0..=all)
        .map(|set| connected(set) && connected(!set & all))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_neighbours_triangulate_a_sphere() {
        // 14 vertices, 36 edges, 24 triangles: χ = 2. A single vertex is simple when exactly one
        // neighbour is inside, and never when all or none are.
        let table = simple_table();
        assert_eq!(table.len(), 1 << 14);
        assert!(!table[0] && !table[(1 << 14) - 1]);
        assert!((0..14).all(|k| table[1 << k]));
        // Opposite neighbours are not adjacent.
        assert!((0..7).all(|k| !table[1 << k | 1 << (k + 7)]));
    }

    #[test]
    fn offsets_agree_with_cells() {
        let lattice = Lattice {
            dims: [5, 6, 7],
            origin: Point3::origin(),
            step: 1.0,
        };
        let middle = lattice.index([2, 3, 3]);
        let last = (middle as isize + lattice.offsets()[6]) as usize;
        assert_eq!(lattice.cell(last), [3, 4, 4]);
        let back = (middle as isize + lattice.offsets()[7]) as usize;
        assert_eq!(lattice.cell(back), [1, 3, 3]);
    }
}
