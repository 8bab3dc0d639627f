//! A growing simplicial polytope in R⁶: planes, neighbours and the step that adds a vertex.
//!
//! A new vertex removes the facets that it sees and is joined to the ridges of their border. The
//! hyperplane of a new facet lies in the pencil of the two facets that meet at its ridge,
//! n = h_vis n_hid − h_hid n_vis with h the heights of the new vertex, so no system is solved.
//! Whichever facets rounding calls visible, the surface stays closed: the border of any set of
//! facets is a cycle. Together with the residual that each plane carries (how far it may miss its
//! own vertices) this makes min(offset − residual) a lower bound of the ball inside, however thin
//! a facet may be.

mod bounds;
mod moved;

use super::plane::{Plane, V6, add_scaled, norm, scale};

/// A neighbour across a ridge: the facet's number and which of its six vertices the ridge omits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Link(u32);

impl Link {
    const NONE: Link = Link(u32::MAX);

    fn new(facet: u32, slot: usize) -> Link {
        Link(facet << 3 | slot as u32)
    }

    pub(crate) fn facet(self) -> usize {
        (self.0 >> 3) as usize
    }

    fn slot(self) -> usize {
        (self.0 & 7) as usize
    }
}

/// Six vertices in ascending order, the outward plane, and the facet across each ridge.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    pub(crate) plane: Plane,
    height: f64,
    epoch: u32,
    pub(crate) vertices: [u16; 6],
    links: [Link; 6],
    /// Set once the plane has been replaced by the best one for this simplex.
    pub(crate) settled: bool,
    /// Set once a cap of directions is known that settles this facet; its key is the cap's level.
    pub(crate) covered: bool,
    /// The count of moves at which no point was known to lie above; 0 for never.
    pub(crate) finished: u32,
    /// The count of moves for which the plane holds; an earlier one bounds less and less.
    pub(crate) moved: u32,
}

#[derive(Clone, Copy, Debug)]
struct Slot {
    key: u64,
    epoch: u32,
    link: Link,
}

/// The most vertices that a polytope may hold (vertex numbers are 16 bits wide).
pub(crate) const MAX_VERTICES: usize = u16::MAX as usize;
/// The most facets that a polytope may hold at once: with all scratch about 30 MB.
const MAX_FACETS: usize = 100_000;

/// The surface and all scratch of its growth; cleared, never shrunk, by `start`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Polytope {
    pub(crate) vertices: Vec<V6>,
    /// What the caller calls each vertex.
    pub(crate) tags: Vec<u32>,
    pub(crate) facets: Vec<Facet>,
    /// Offset of each facet plus `drift`, +∞ where the slot is free. Of a facet whose plane is out
    /// of date: a bound, plus `drift`, of the distance of its simplex from the origin.
    pub(crate) keys: Vec<f64>,
    /// How far any vertex can have moved since `start`: the sum of the largest moves.
    pub(crate) drift: f64,
    /// Times that the vertices moved since `start`, plus one.
    pub(crate) moves: u32,
    /// A facet that was the nearest before the last move.
    pub(super) hint: usize,
    /// Facets made since `start`.
    pub(crate) created: usize,
    /// How many vertices may still be taken twice.
    pub(crate) copies: usize,
    /// Whether the surface is known to surround the origin: every ray from it meets a facet.
    pub(crate) surrounds: bool,
    /// The largest residual of any plane since `start`.
    pub(crate) worst_residual: f64,
    /// The rounding error of a height: a few ulps of the longest vertex.
    rounding: f64,
    /// The facets that the last `start` or `insert` made.
    pub(crate) fresh: Vec<u32>,
    free: Vec<u32>,
    pub(super) visible: Vec<u32>,
    border: Vec<Link>,
    table: Vec<Slot>,
    epoch: u32,
}

impl Polytope {
    /// Begins with a simplex of seven affinely independent points.
    pub(crate) fn start(&mut self, points: &[V6; 7], tags: &[u32; 7]) {
        self.vertices.clear();
        self.vertices.extend_from_slice(points);
        self.tags.clear();
        self.tags.extend_from_slice(tags);
        self.facets.clear();
        self.keys.clear();
        self.free.clear();
        self.fresh.clear();
        self.created = 0;
        self.worst_residual = 0.0;
        self.rounding = 0.0;
        self.drift = 0.0;
        self.moves = 1;
        self.surrounds = false;
        self.copies = 0;
        points.iter().for_each(|p| self.widen(p));
        // Stamps go on counting, so that old ones mean nothing; long before they run out, anew.
        if self.epoch > u32::MAX / 2 {
            self.epoch = 0;
            self.table.clear();
        }
        for omitted in 0..7 {
            self.start_facet(omitted);
        }
    }

    /// The facet of the first simplex that omits a vertex.
    fn start_facet(&mut self, omitted: usize) {
        let vertices: [u16; 6] =
            std::array::from_fn(|i| (if i < omitted { i } else { i + 1 }) as u16);
        let plane = self.direct(&vertices, omitted as u16);
        // Across the ridge that also omits `other` lies the facet that omits `other`.
        let links = vertices.map(|other| {
            let slot = omitted - usize::from(omitted > other as usize);
            Link::new(u32::from(other), slot)
        });
        self.push(vertices, plane, links);
    }

    /// The facet with the smallest offset.
    pub(crate) fn nearest(&self) -> usize {
        let mut best = (0, f64::INFINITY);
        for (facet, &key) in self.keys.iter().enumerate() {
            if key < best.1 {
                best = (facet, key);
            }
        }
        best.0
    }

    /// The unfinished facets up to `level`; `out` is emptied before. The nearest first in a new
    /// polytope, where order saves work.
    pub(crate) fn open(&self, level: f64, out: &mut Vec<u32>) {
        out.clear();
        let open = |f: &u32| self.is_open(*f as usize, level);
        out.extend((0..self.keys.len() as u32).filter(open));
        if self.moves == 1 {
            self.sort(out);
        }
    }

    /// The facets up to `level`, the nearest first; `out` is emptied before.
    pub(crate) fn up_to(&self, level: f64, out: &mut Vec<u32>) {
        out.clear();
        out.extend((0..self.keys.len() as u32).filter(|&f| self.bound(f as usize) <= level));
        self.sort(out);
    }

    fn sort(&self, out: &mut [u32]) {
        let key = |f: &u32| self.keys[*f as usize];
        out.sort_unstable_by(|a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
    }

    /// Whether a facet is up to `level` and not finished.
    pub(crate) fn is_open(&self, facet: usize, level: f64) -> bool {
        self.bound(facet) <= level && self.facets[facet].finished != self.moves
    }

    /// The distance that a facet's simplex keeps from the origin; of a present plane the offset.
    pub(crate) fn bound(&self, facet: usize) -> f64 {
        self.keys[facet] - self.drift
    }

    /// The numbers of the facets of the present surface.
    pub(crate) fn alive(&self) -> impl Iterator<Item = usize> {
        (0..self.facets.len()).filter(|&f| self.keys[f] < f64::INFINITY)
    }

    /// The vertices of a facet.
    pub(crate) fn corners(&self, facet: usize) -> [V6; 6] {
        self.facets[facet]
            .vertices
            .map(|v| self.vertices[v as usize])
    }

    /// Whether `point` is, to the last bit, a vertex already.
    pub(crate) fn has_vertex(&self, point: &V6) -> bool {
        self.vertices.iter().any(|v| v == point)
    }

    /// Replaces the plane of a facet, which then counts as settled.
    pub(crate) fn settle(&mut self, facet: usize, plane: Plane) {
        self.facets[facet].plane = plane;
        self.facets[facet].settled = true;
        self.keys[facet] = plane.offset + self.drift;
    }

    /// Adds a vertex that lies above facet `seed` by more than `tolerance`.
    ///
    /// Facets below which the point lies by no more than the tolerance stay. Returns false, with
    /// the surface unchanged, if no facet would be left to join the vertex to.
    pub(crate) fn insert(&mut self, point: &V6, tag: u32, seed: usize, tolerance: f64) -> bool {
        self.flood(point, seed, tolerance);
        let facets = self.facets.len() + self.border.len();
        if self.border.is_empty() || self.vertices.len() > MAX_VERTICES || facets > MAX_FACETS {
            return false;
        }
        self.surrounds &= self.stays_clear();
        let apex = self.vertices.len() as u16;
        self.vertices.push(*point);
        self.tags.push(tag);
        self.widen(point);
        self.fresh.clear();
        self.clear_table();
        for i in 0..self.border.len() {
            self.raise(self.border[i], apex);
        }
        for &facet in &self.visible {
            self.keys[facet as usize] = f64::INFINITY;
        }
        self.free.extend_from_slice(&self.visible);
        true
    }

    /// Collects the facets that see `point` and the ridges around them.
    fn flood(&mut self, point: &V6, seed: usize, tolerance: f64) {
        self.epoch += 1;
        let epoch = self.epoch;
        self.visible.clear();
        self.border.clear();
        self.visible.push(seed as u32);
        let first = &mut self.facets[seed];
        first.epoch = epoch;
        first.height = first.plane.height(point).max(tolerance * 1.5);
        let mut next = 0;
        while next < self.visible.len() {
            let facet = self.visible[next];
            next += 1;
            let links = self.facets[facet as usize].links;
            for (slot, link) in links.into_iter().enumerate() {
                if self.facets[link.facet()].epoch != epoch {
                    self.freshen(link.facet());
                    let other = &mut self.facets[link.facet()];
                    other.epoch = epoch;
                    other.height = other.plane.height(point);
                    if other.height > tolerance {
                        self.visible.push(link.facet() as u32);
                    }
                }
                if self.facets[link.facet()].height <= tolerance {
                    self.border.push(Link::new(facet, slot));
                }
            }
        }
    }

    /// Makes the facet of `apex` over one border ridge and links it.
    fn raise(&mut self, ridge: Link, apex: u16) {
        let lower = &self.facets[ridge.facet()];
        let beyond = lower.links[ridge.slot()];
        let omitted = ridge.slot();
        let mut vertices = lower.vertices;
        vertices.copy_within(omitted + 1.., omitted);
        vertices[5] = apex;
        let plane = match pencil(lower, &self.facets[beyond.facet()], self.rounding) {
            Some(plane) => plane,
            None => self.direct(&vertices, lower.vertices[ridge.slot()]),
        };
        let mut links = [Link::NONE; 6];
        links[5] = beyond;
        let facet = self.push(vertices, plane, links);
        self.facets[beyond.facet()].links[beyond.slot()] = Link::new(facet, 5);
        // A ridge holds the new vertex and four others, 16 bits each: the rest of five when one goes.
        let five = vertices[..5]
            .iter()
            .fold(0u128, |all, &v| all << 16 | u128::from(v));
        for slot in 0..5 {
            let below = (1u128 << (16 * (4 - slot))) - 1;
            let key = (five & below) | (five >> 16 & !below);
            self.join(facet, slot, key as u64);
        }
    }

    /// Links ridge `slot` of a new facet with its twin, or leaves it in the table for the twin.
    #[inline]
    fn join(&mut self, facet: u32, slot: usize, key: u64) {
        let mask = self.table.len() - 1;
        let mut at = (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize & mask;
        let link = Link::new(facet, slot);
        loop {
            let entry = &mut self.table[at];
            if entry.epoch != self.epoch {
                *entry = Slot {
                    key,
                    epoch: self.epoch,
                    link,
                };
                return;
            }
            if entry.key == key && entry.link != Link::NONE {
                let twin = entry.link;
                entry.link = Link::NONE;
                self.facets[twin.facet()].links[twin.slot()] = link;
                self.facets[facet as usize].links[slot] = twin;
                return;
            }
            at = (at + 1) & mask;
        }
    }

    /// Room for every ridge of the new facets at a load of at most one half.
    fn clear_table(&mut self) {
        let need = (5 * self.border.len()).next_power_of_two();
        if self.table.len() < need {
            let empty = Slot {
                key: 0,
                epoch: 0,
                link: Link::NONE,
            };
            self.table.resize(2 * need, empty);
        }
    }

    /// The plane through six vertices with `inner` below it.
    fn direct(&self, vertices: &[u16; 6], inner: u16) -> Plane {
        let plane = self.plane_through(vertices);
        if plane.height(&self.vertices[inner as usize]) > 0.0 {
            plane.flipped()
        } else {
            plane
        }
    }

    pub(super) fn plane_through(&self, vertices: &[u16; 6]) -> Plane {
        Plane::through(&vertices.map(|v| self.vertices[v as usize]))
    }

    pub(super) fn widen(&mut self, point: &V6) {
        self.rounding = self.rounding.max(4.0 * f64::EPSILON * norm(point));
    }

    fn push(&mut self, vertices: [u16; 6], plane: Plane, links: [Link; 6]) -> u32 {
        let facet = Facet {
            plane,
            height: 0.0,
            epoch: 0,
            vertices,
            links,
            settled: false,
            covered: false,
            finished: 0,
            moved: self.moves,
        };
        self.created += 1;
        self.worst_residual = self.worst_residual.max(plane.residual);
        let key = plane.offset + self.drift;
        let at = match self.free.pop() {
            Some(at) => {
                self.facets[at as usize] = facet;
                self.keys[at as usize] = key;
                at
            }
            None => {
                self.facets.push(facet);
                self.keys.push(key);
                self.facets.len() as u32 - 1
            }
        };
        self.fresh.push(at);
        at
    }
}

/// The plane of the pencil of two facets that contains the point whose heights they hold.
///
/// None where the pencil says too little: a point (nearly) on or above the hidden facet that is
/// hardly above the visible one.
fn pencil(visible: &Facet, hidden: &Facet, rounding: f64) -> Option<Plane> {
    let (a, b) = (visible.height, -hidden.height);
    if b < 0.0 && -b > 1e-2 * a {
        return None;
    }
    let n = add_scaled(&scale(&hidden.plane.normal, a), b, &visible.plane.normal);
    let length = norm(&n);
    if length <= 1e-3 * (a + b.abs()) {
        return None;
    }
    let inverse = 1.0 / length;
    let reach = a + b.abs();
    let residual = a * hidden.plane.residual + b.abs() * visible.plane.residual + reach * rounding;
    Some(Plane {
        normal: scale(&n, inverse),
        offset: inverse * (a * hidden.plane.offset + b * visible.plane.offset),
        residual: inverse * residual,
    })
}

/// The simplex volume |det(p_i − apex)| / 6! of a facet and a point.
pub(crate) fn cone_volume(corners: &[V6; 6], apex: &V6) -> f64 {
    let m = nalgebra::Matrix6::from_fn(|i, j| corners[j][i] - apex[i]);
    m.determinant().abs() / 720.0
}

#[cfg(test)]
mod tests {
    use super::super::plane::dot;
    use super::*;

    fn cross_polytope() -> Polytope {
        let mut points = [[0.0; 6]; 7];
        for (k, p) in points.iter_mut().take(6).enumerate() {
            p[k] = 1.0;
        }
        points[6] = [-0.1; 6];
        let mut polytope = Polytope::default();
        polytope.start(&points, &[0, 1, 2, 3, 4, 5, 6]);
        for k in 0..6 {
            let mut p = [0.0; 6];
            p[k] = -1.0;
            let seed = polytope
                .alive()
                .find(|&f| polytope.facets[f].plane.height(&p) > 1e-12);
            assert!(polytope.insert(&p, 7, seed.unwrap(), 1e-12));
        }
        polytope
    }

    #[test]
    fn grows_to_the_cross_polytope() {
        let polytope = cross_polytope();
        let facets: Vec<usize> = polytope.alive().collect();
        assert_eq!(facets.len(), 64);
        let offset = 1.0 / 6.0_f64.sqrt();
        for &f in &facets {
            assert!((polytope.facets[f].plane.offset - offset).abs() <= 1e-14);
        }
        let volume: f64 = facets
            .iter()
            .map(|&f| cone_volume(&polytope.corners(f), &[0.0; 6]))
            .sum();
        assert!((volume - 64.0 / 720.0).abs() <= 1e-14);
    }

    #[test]
    fn links_are_mutual_and_share_a_ridge() {
        let polytope = cross_polytope();
        for f in polytope.alive() {
            for slot in 0..6 {
                let link = polytope.facets[f].links[slot];
                let back = polytope.facets[link.facet()].links[link.slot()];
                assert_eq!(back, Link::new(f as u32, slot));
                let ridge = |f: usize, slot: usize| {
                    let mut v = polytope.facets[f].vertices.to_vec();
                    v.remove(slot);
                    v
                };
                assert_eq!(ridge(f, slot), ridge(link.facet(), link.slot()));
                assert!(dot(&polytope.facets[f].plane.normal, &polytope.corners(f)[0]) > 0.0);
            }
        }
    }
}
