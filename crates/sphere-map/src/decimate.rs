//! Fewer, evenly spread vertices: edge collapses by quadric error.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use nalgebra::{Matrix3, Point3, Vector3};

use crate::mesh::Mesh;
use crate::rings::{Collapse, Rings};

/// Weight of the length of an edge against its quadric error: even triangles on flat parts.
const EVENNESS: f64 = 1e-3;
/// Before the cheapest edge is looked for, edges that cost less than flat ones of these shares of the
/// final length are collapsed in the order of the vertices.
const SHORT: [f64; 3] = [0.2, 0.35, 0.5];
/// Pull of a new vertex towards the middle of its edge, as a share of the quadric.
const CENTRING: f64 = 1e-3;
/// The same where vertices stay, against the quadric error itself.
const LENGTH: f64 = 1e-4;
/// Collapsing a vertex with more than six neighbours costs this share more per neighbour.
const CROWDING: f64 = 0.5;
/// Least cosine between the normals of a triangle before and after.
const LEAST_TURN: f64 = 0.2;

/// xᵀAx + 2bᵀx + c: the sum of squared distances to planes, weighted by area.
#[derive(Clone, Copy, Debug)]
struct Quadric {
    a: Matrix3<f64>,
    b: Vector3<f64>,
    c: f64,
}

impl Quadric {
    const ZERO: Self = Self {
        a: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        b: Vector3::new(0.0, 0.0, 0.0),
        c: 0.0,
    };

    fn add(&mut self, other: &Self) {
        self.a += other.a;
        self.b += other.b;
        self.c += other.c;
    }

    fn at(&self, x: &Vector3<f64>) -> f64 {
        (x.dot(&(self.a * x)) + 2.0 * self.b.dot(x) + self.c).max(0.0)
    }

    /// The place of the least error, drawn a little towards `middle`.
    fn best(&self, middle: &Vector3<f64>) -> Vector3<f64> {
        let pull = CENTRING * self.a.trace() + f64::MIN_POSITIVE;
        let matrix = self.a + Matrix3::identity() * pull;
        match matrix.cholesky() {
            Some(factor) => factor.solve(&(middle * pull - self.b)),
            None => *middle,
        }
    }
}

/// A candidate for a collapse; the least cost comes first.
struct Candidate {
    cost: f64,
    edge: (u32, u32),
    versions: (u32, u32),
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_cost = other.cost.total_cmp(&self.cost);
        by_cost.then(other.edge.cmp(&self.edge))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Candidate {}

/// Where the vertex of a collapsed edge goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    /// To the place of the least error.
    Free,
    /// It stays at the kept end.
    HalfEdge,
}

struct Decimation {
    mode: Mode,
    /// Whether collapses that turn a triangle over are left out.
    strict: bool,
    rings: Rings,
    places: Vec<Vector3<f64>>,
    quadrics: Vec<Quadric>,
    versions: Vec<u32>,
    heap: BinaryHeap<Candidate>,
    /// Squared length of an edge of the result.
    target_edge: f64,
}

/// A mesh of `target` vertices, or of as many as can go without folding it over.
///
/// `None` when the mesh is not a closed oriented surface. Costs (vertices)·log(vertices).
pub(crate) fn decimate(mesh: &Mesh, target: usize) -> Option<Mesh> {
    let mut work = Decimation::new(mesh, target, Mode::Free)?;
    for share in SHORT {
        work.sweep(target.max(4), share);
    }
    work.run(target.max(4), |_| {});
    Some(work.compact())
}

/// Collapses down to a tetrahedron, vertices where they are: the rings of the tetrahedron, and what
/// undoes the collapses, in the order in which they were done.
///
/// `None` when the mesh is not a closed oriented surface of genus zero.
pub(crate) fn to_tetrahedron(mesh: &Mesh) -> Option<(Rings, Vec<Collapse>)> {
    let mut work = Decimation::new(mesh, 4, Mode::HalfEdge)?;
    let mut collapses = Vec::with_capacity(mesh.vertices.len());
    work.run(4, |collapse| collapses.push(collapse));
    (work.rings.live() == 4).then_some((work.rings, collapses))
}

impl Decimation {
    fn new(mesh: &Mesh, target: usize, mode: Mode) -> Option<Self> {
        let rings = Rings::new(mesh.vertices.len(), &mesh.triangles)?;
        let mut quadrics = vec![Quadric::ZERO; mesh.vertices.len()];
        let mut area = 0.0;
        for triangle in &mesh.triangles {
            let vector = mesh.area_vector(triangle);
            let size = vector.norm();
            let Some(n) = vector.try_normalize(0.0) else {
                continue;
            };
            area += size;
            let d = -n.dot(&mesh.vertices[triangle[0] as usize].coords);
            let weight = size / 3.0;
            let plane = Quadric {
                a: n * n.transpose() * weight,
                b: n * (d * weight),
                c: d * d * weight,
            };
            for v in triangle {
                quadrics[*v as usize].add(&plane);
            }
        }
        Some(Self {
            mode,
            strict: true,
            places: mesh.vertices.iter().map(|p| p.coords).collect(),
            versions: vec![0; mesh.vertices.len()],
            heap: BinaryHeap::new(),
            target_edge: 1.15 * area / target.max(4) as f64,
            rings,
            quadrics,
        })
    }

    fn run(&mut self, target: usize, mut done: impl FnMut(Collapse)) {
        self.offer_all();
        while self.rings.live() > target {
            let Some(candidate) = self.heap.pop() else {
                if self.mode == Mode::Free || !self.strict {
                    return;
                }
                self.strict = false;
                self.offer_all();
                continue;
            };
            let (v, u) = candidate.edge;
            let versions = (self.versions[v as usize], self.versions[u as usize]);
            if candidate.versions != versions || !self.rings.collapsible(v, u) {
                continue;
            }
            let (_, place) = self.judge(v, u);
            if self.strict && (self.folds(v, u, &place) || self.folds(u, v, &place)) {
                continue;
            }
            done(self.merge(v, u, place));
            self.offer(u, false);
        }
    }

    /// Collapses the cheapest edge of every vertex if it costs less than a flat edge of a share of the
    /// final length.
    fn sweep(&mut self, target: usize, share: f64) {
        let limit = EVENNESS * self.target_edge * share.powi(4);
        for v in 0..self.rings.len() as u32 {
            if self.rings.live() <= target {
                return;
            }
            let mut best = (limit, None);
            for &u in self.rings.ring(v) {
                let (cost, place) = self.judge(v, u);
                if cost < best.0 && self.rings.collapsible(v, u) {
                    best = (cost, Some((u, place)));
                }
            }
            if let (_, Some((u, place))) = best
                && !self.folds(v, u, &place)
                && !self.folds(u, v, &place)
            {
                self.merge(v, u, place);
            }
        }
    }

    fn merge(&mut self, v: u32, u: u32, place: Vector3<f64>) -> Collapse {
        let collapse = self.rings.collapse(v, u);
        self.places[u as usize] = place;
        let merged = self.quadrics[v as usize];
        self.quadrics[u as usize].add(&merged);
        self.versions[u as usize] += 1;
        self.versions[v as usize] += 1;
        collapse
    }

    fn offer_all(&mut self) {
        for v in 0..self.rings.len() as u32 {
            self.offer(v, true);
        }
    }

    /// Puts the edges of a vertex into the heap; `once` leaves out those that the other end offers.
    fn offer(&mut self, v: u32, once: bool) {
        for k in 0..self.rings.ring(v).len() {
            let u = self.rings.ring(v)[k];
            if once && u > v {
                continue;
            }
            self.push(v.max(u), v.min(u));
            if self.mode == Mode::HalfEdge {
                self.push(v.min(u), v.max(u));
            }
        }
    }

    fn push(&mut self, v: u32, u: u32) {
        let (cost, _) = self.judge(v, u);
        let versions = (self.versions[v as usize], self.versions[u as usize]);
        self.heap.push(Candidate {
            cost,
            edge: (v, u),
            versions,
        });
    }

    fn judge(&self, v: u32, u: u32) -> (f64, Vector3<f64>) {
        let (a, b) = (self.places[v as usize], self.places[u as usize]);
        let mut quadric = self.quadrics[v as usize];
        quadric.add(&self.quadrics[u as usize]);
        let length = (a - b).norm_squared();
        if self.mode == Mode::HalfEdge {
            let crowded = self.rings.ring(v).len().saturating_sub(6) as f64;
            let cost = quadric.at(&b) + LENGTH * length * length;
            return (cost * (1.0 + CROWDING * crowded), b);
        }
        let middle = (a + b) * 0.5;
        let best = quadric.best(&middle);
        // A flat or thin neighbourhood may put the best place far away.
        let place = if (best - middle).norm_squared() <= length {
            best
        } else {
            middle
        };
        let cost =
            quadric.at(&place) / self.target_edge + EVENNESS * length * (length / self.target_edge);
        (cost, place)
    }

    /// Whether a triangle at `v` that does not hold `u` turns over when `v` moves to `place`.
    fn folds(&self, v: u32, u: u32, place: &Vector3<f64>) -> bool {
        let ring = self.rings.ring(v);
        let here = self.places[v as usize];
        (0..ring.len()).any(|k| {
            let (a, b) = (ring[k], ring[(k + 1) % ring.len()]);
            if a == u || b == u {
                return false;
            }
            let (a, b) = (self.places[a as usize], self.places[b as usize]);
            let before = (a - here).cross(&(b - here));
            let after = (a - place).cross(&(b - place));
            before.dot(&after) < LEAST_TURN * (before.norm_squared() * after.norm_squared()).sqrt()
        })
    }

    fn compact(&self) -> Mesh {
        let mut index = vec![u32::MAX; self.places.len()];
        let mut vertices = Vec::with_capacity(self.rings.live());
        for (v, place) in self.places.iter().enumerate() {
            if !self.rings.ring(v as u32).is_empty() {
                index[v] = vertices.len() as u32;
                vertices.push(Point3::from(*place));
            }
        }
        let triangles = self.rings.triangles();
        Mesh {
            vertices,
            triangles: triangles
                .iter()
                .map(|t| t.map(|v| index[v as usize]))
                .collect(),
        }
    }
}
