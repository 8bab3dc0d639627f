//! A tree of boxes over the triangles of a mesh.

use nalgebra::{Point3, Vector3};

use crate::mesh::Mesh;

/// Triangles per leaf.
const LEAF: usize = 4;

/// The triangles of a mesh in nested boxes, for closest points.
///
/// ```
/// use nalgebra::Point3;
/// use sphere_map::{Mesh, Tree};
///
/// let [o, x, y, z] = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
///     .map(|(x, y, z)| Point3::new(x, y, z).cast::<f64>());
/// let mesh = Mesh {
///     vertices: vec![o, x, y, z],
///     triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
/// };
/// assert_eq!(mesh.euler_characteristic(), 2);
/// let found = Tree::new(&mesh).closest(&Point3::new(0.2, 0.3, -0.5));
/// assert!(found.is_some_and(|at| at.triangle == 0 && (at.distance - 0.5).abs() < 1e-12));
/// ```
#[derive(Clone, Debug)]
pub struct Tree {
    corners: Vec<[Point3<f64>; 3]>,
    /// Indices of the corners in the mesh.
    ids: Vec<[u32; 3]>,
    /// Index of the triangle of every entry of `corners`, and the way back.
    order: Vec<u32>,
    entries: Vec<u32>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Point3<f64>,
    high: Point3<f64>,
    /// Entries of a leaf, or the right child (the left one follows the node).
    from: u32,
    to: u32,
    right: u32,
}

/// The point of a mesh that is closest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Which triangle.
    pub triangle: usize,
    /// Weights of its corners, not negative, with sum 1.
    pub weights: [f64; 3],
    /// Distance.
    pub distance: f64,
}

impl Tree {
    /// Sorts the triangles; n log n.
    pub fn new(mesh: &Mesh) -> Self {
        let mut order: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        let all: Vec<[Point3<f64>; 3]> = mesh.triangles.iter().map(|t| mesh.corners(t)).collect();
        let mut nodes = Vec::with_capacity(all.len());
        if !order.is_empty() {
            build(&all, &mut order, 0, &mut nodes);
        }
        let mut entries = vec![0; order.len()];
        for (entry, triangle) in order.iter().enumerate() {
            entries[*triangle as usize] = entry as u32;
        }
        Self {
            entries,
            corners: order.iter().map(|i| all[*i as usize]).collect(),
            ids: order.iter().map(|i| mesh.triangles[*i as usize]).collect(),
            order,
            nodes,
        }
    }

    /// The closest point of the mesh; `None` when it has no triangles.
    pub fn closest(&self, p: &Point3<f64>) -> Option<Closest> {
        self.search(p, |_| true)
    }

    /// The closest point on the triangles that face along `normal`, so that the other side of a thin wall
    /// is left out; `None` when there are no such triangles.
    pub fn closest_facing(&self, p: &Point3<f64>, normal: &Vector3<f64>) -> Option<Closest> {
        self.search(p, |[a, b, c]| (b - a).cross(&(c - a)).dot(normal) > 0.0)
    }

    /// The point that [`Tree::closest`] found.
    pub fn place(&self, at: &Closest) -> Point3<f64> {
        let [a, b, c] = &self.corners[self.entries[at.triangle] as usize];
        let [u, v, w] = at.weights;
        Point3::from(a.coords * u + b.coords * v + c.coords * w)
    }

    /// Where the line p + t d meets triangles, for t within ±`reach`: t and whether the triangle faces
    /// along d there. In no particular order.
    pub fn along_line(&self, p: &Point3<f64>, d: &Vector3<f64>, reach: f64) -> Vec<(f64, bool)> {
        let mut found = Vec::new();
        let mut stack = vec![0_u32];
        if self.nodes.is_empty() {
            return found;
        }
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !node.meets(p, d, reach) {
                continue;
            }
            if node.right != 0 {
                stack.extend([index + 1, node.right]);
                continue;
            }
            let near = self.corners[node.from as usize..node.to as usize].iter();
            found.extend(
                near.filter_map(|t| met(p, d, t))
                    .filter(|(t, _)| t.abs() <= reach),
            );
        }
        found
    }

    /// Pairs of triangles without a common corner that cut each other; the search ends at `most` pairs.
    pub fn crossings(&self, most: usize) -> Vec<[usize; 2]> {
        let mut found = Vec::new();
        let mut stack = vec![(0_u32, 0_u32)];
        if self.nodes.is_empty() {
            return found;
        }
        while let Some((a, b)) = stack.pop() {
            let (one, other) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            if !one.touches(other) {
                continue;
            }
            match (one.right == 0, other.right == 0) {
                (true, true) => {
                    for i in one.from as usize..one.to as usize {
                        let start = if a == b { i + 1 } else { other.from as usize };
                        for j in start..other.to as usize {
                            if self.cross(i, j) {
                                found.push([self.order[i] as usize, self.order[j] as usize]);
                                if found.len() >= most {
                                    return found;
                                }
                            }
                        }
                    }
                }
                _ if a == b => {
                    let (left, right) = (a + 1, one.right);
                    stack.extend([(left, left), (right, right), (left, right)]);
                }
                (leaf, _) if leaf || (other.right != 0 && other.size() > one.size()) => {
                    stack.extend([(a, b + 1), (a, other.right)]);
                }
                _ => stack.extend([(a + 1, b), (one.right, b)]),
            }
        }
        found
    }

    fn cross(&self, i: usize, j: usize) -> bool {
        if self.ids[i].iter().any(|v| self.ids[j].contains(v)) {
            return false;
        }
        let (s, t) = (&self.corners[i], &self.corners[j]);
        let edges = [(0, 1), (1, 2), (2, 0)];
        edges
            .iter()
            .any(|(a, b)| pierces(&s[*a], &s[*b], t) || pierces(&t[*a], &t[*b], s))
    }

    fn search(
        &self,
        p: &Point3<f64>,
        admits: impl Fn(&[Point3<f64>; 3]) -> bool,
    ) -> Option<Closest> {
        let mut best: Option<Closest> = None;
        let mut squared = f64::INFINITY;
        let mut stack = vec![(0.0, 0_u32)];
        if self.nodes.is_empty() {
            return None;
        }
        while let Some((gap, index)) = stack.pop() {
            if gap >= squared {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.right == 0 {
                for k in node.from as usize..node.to as usize {
                    let (weights, d) = closest_on_triangle(p, &self.corners[k]);
                    if d < squared && admits(&self.corners[k]) {
                        squared = d;
                        best = Some(Closest {
                            triangle: self.order[k] as usize,
                            weights,
                            distance: d.sqrt(),
                        });
                    }
                }
                continue;
            }
            let children = [index + 1, node.right];
            let gaps = children.map(|c| self.nodes[c as usize].gap(p));
            let near = usize::from(gaps[1] < gaps[0]);
            stack.push((gaps[1 - near], children[1 - near]));
            stack.push((gaps[near], children[near]));
        }
        best
    }
}

/// Where a line p + t d meets a triangle, and whether the triangle faces along d. After Möller and
/// Trumbore, Fast, minimum storage ray-triangle intersection, 1997.
fn met(p: &Point3<f64>, d: &Vector3<f64>, [a, b, c]: &[Point3<f64>; 3]) -> Option<(f64, bool)> {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let across = d.cross(&ac);
    let determinant = ab.dot(&across);
    let u = ap.dot(&across) / determinant;
    let along = ap.cross(&ab);
    let v = d.dot(&along) / determinant;
    // Written so that a line in the plane of the triangle, where u is infinite or NaN, does not meet it.
    let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    inside.then(|| (ac.dot(&along) / determinant, determinant < 0.0))
}

/// Whether a segment passes through a triangle; one in its plane does not.
fn pierces(p: &Point3<f64>, q: &Point3<f64>, [a, b, c]: &[Point3<f64>; 3]) -> bool {
    let volume = |x: &Point3<f64>, y: &Point3<f64>, z: &Point3<f64>, w: &Point3<f64>| {
        (y - x).cross(&(z - x)).dot(&(w - x))
    };
    if volume(a, b, c, p) * volume(a, b, c, q) >= 0.0 {
        return false;
    }
    let [u, v, w] = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0)
}

impl Node {
    fn touches(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.high[axis] && other.low[axis] <= self.high[axis])
    }

    /// Whether the line p + t d with |t| at most `reach` passes through the box.
    fn meets(&self, p: &Point3<f64>, d: &Vector3<f64>, reach: f64) -> bool {
        let (mut from, mut to) = (-reach, reach);
        for axis in 0..3 {
            let (low, high) = (self.low[axis] - p[axis], self.high[axis] - p[axis]);
            if d[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
                continue;
            }
            let ends = [low / d[axis], high / d[axis]];
            from = ends[0].min(ends[1]).max(from);
            to = ends[0].max(ends[1]).min(to);
        }
        from <= to
    }

    fn size(&self) -> f64 {
        (self.high - self.low).norm_squared()
    }

    fn gap(&self, p: &Point3<f64>) -> f64 {
        let inside = p.sup(&self.low).inf(&self.high);
        (inside - p).norm_squared()
    }
}

fn build(all: &[[Point3<f64>; 3]], order: &mut [u32], from: usize, nodes: &mut Vec<Node>) -> u32 {
    let (mut low, mut high) = (all[order[0] as usize][0], all[order[0] as usize][0]);
    for i in order.iter() {
        for corner in &all[*i as usize] {
            low = low.inf(corner);
            high = high.sup(corner);
        }
    }
    let index = nodes.len() as u32;
    nodes.push(Node {
        low,
        high,
        from: from as u32,
        to: (from + order.len()) as u32,
        right: 0,
    });
    if order.len() > LEAF {
        let axis = (high - low).imax();
        let middle = order.len() / 2;
        let key = |i: &u32| -> f64 { all[*i as usize].iter().map(|c| c[axis]).sum() };
        order.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let (left, right) = order.split_at_mut(middle);
        build(all, left, from, nodes);
        let right = build(all, right, from + middle, nodes);
        nodes[index as usize].right = right;
    }
    index
}

/// Weights of the closest point of a triangle, and its squared distance.
///
/// By the regions of the plane: Ericson, Real-Time Collision Detection, 2005, 5.1.5.
pub(crate) fn closest_on_triangle(
    p: &Point3<f64>,
    [a, b, c]: &[Point3<f64>; 3],
) -> ([f64; 3], f64) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let weights = if d1 <= 0.0 && d2 <= 0.0 {
        [1.0, 0.0, 0.0]
    } else if d3 >= 0.0 && d4 <= d3 {
        [0.0, 1.0, 0.0]
    } else if d6 >= 0.0 && d5 <= d6 {
        [0.0, 0.0, 1.0]
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        [1.0 - t, t, 0.0]
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        [1.0 - t, 0.0, t]
    } else if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = (d4 - d3) / (d4 - d3 + d5 - d6);
        [0.0, 1.0 - t, t]
    } else {
        let sum = va + vb + vc;
        [va / sum, vb / sum, vc / sum]
    };
    let nearest: Vector3<f64> =
        a.coords * weights[0] + b.coords * weights[1] + c.coords * weights[2];
    let squared = (nearest - p.coords).norm_squared();
    if squared.is_finite() {
        (weights, squared)
    } else {
        // A triangle without area.
        ([1.0, 0.0, 0.0], ap.norm_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_are_those_of_all_pairs() {
        let wave = |i: usize, k: f64| (i as f64 * k).sin();
        let vertices: Vec<Point3<f64>> = (0..180)
            .map(|i| Point3::new(wave(i, 1.1), wave(i, 2.3), wave(i, 3.7)) * 0.5)
            .collect();
        let triangles: Vec<[u32; 3]> = (0..60).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let tree = Tree::new(&Mesh {
            vertices,
            triangles,
        });
        let mut all = 0;
        for i in 0..60 {
            all += (i + 1..60).filter(|j| tree.cross(i, *j)).count();
        }
        assert!(all > 20);
        assert_eq!(tree.crossings(usize::MAX).len(), all);
    }

    #[test]
    fn the_closest_point_is_that_of_a_full_search() {
        let wave = |i: usize, k: f64| (i as f64 * k).sin();
        let vertices: Vec<Point3<f64>> = (0..90)
            .map(|i| Point3::new(wave(i, 1.1), wave(i, 2.3), wave(i, 3.7)))
            .collect();
        let triangles: Vec<[u32; 3]> = (0..30).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = Mesh {
            vertices,
            triangles,
        };
        let tree = Tree::new(&mesh);
        for i in 0..50 {
            let p = Point3::new(wave(i, 0.7), wave(i, 5.3), 1.5 * wave(i, 0.3));
            let found = tree.closest(&p).unwrap();
            let all = mesh.triangles.iter().map(|t| {
                let [a, b, c] = mesh.corners(t);
                let mut least = f64::INFINITY;
                for s in 0..=40 {
                    for t in 0..=40 - s {
                        let (s, t) = (f64::from(s) / 40.0, f64::from(t) / 40.0);
                        least = least.min((a + (b - a) * s + (c - a) * t - p).norm());
                    }
                }
                least
            });
            let sampled = all.fold(f64::INFINITY, f64::min);
            assert!(found.distance <= sampled + 1e-12 && sampled <= found.distance + 0.05);
            let [a, b, c] = mesh.corners(&mesh.triangles[found.triangle]);
            let [u, v, w] = found.weights;
            let at = a.coords * u + b.coords * v + c.coords * w;
            assert!(((at - p.coords).norm() - found.distance).abs() <= 1e-12);
        }
    }
}
