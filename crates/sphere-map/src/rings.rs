//! The connectivity of a closed triangle mesh as one ring of neighbours per vertex.

/// For every vertex its neighbours, counter-clockwise seen from outside; empty once it is gone.
///
/// The triangles at v are (v, ring[k], ring[k+1]).
#[derive(Clone, Debug)]
pub(crate) struct Rings {
    rings: Vec<Vec<u32>>,
    live: usize,
}

/// A collapse of `gone` into `kept`, with what is needed to undo it.
#[derive(Clone, Debug)]
pub(crate) struct Collapse {
    pub(crate) gone: u32,
    pub(crate) kept: u32,
    /// The ring of `gone`, starting with `kept`.
    pub(crate) ring: Vec<u32>,
}

impl Rings {
    /// `None` when the triangles are no closed oriented surface.
    pub(crate) fn new(vertices: usize, triangles: &[[u32; 3]]) -> Option<Self> {
        let mut links: Vec<Vec<(u32, u32)>> = vec![Vec::with_capacity(8); vertices];
        for &[a, b, c] in triangles {
            links.get_mut(a as usize)?.push((b, c));
            links.get_mut(b as usize)?.push((c, a));
            links.get_mut(c as usize)?.push((a, b));
        }
        let rings: Option<Vec<Vec<u32>>> = links.iter().map(|link| ordered(link)).collect();
        Some(Self {
            rings: rings?,
            live: vertices,
        })
    }

    pub(crate) fn ring(&self, v: u32) -> &[u32] {
        &self.rings[v as usize]
    }

    /// Number of vertices that are left.
    pub(crate) fn live(&self) -> usize {
        self.live
    }

    pub(crate) fn len(&self) -> usize {
        self.rings.len()
    }

    /// Whether collapsing the edge from `gone` to `kept` keeps a closed surface: the link condition.
    pub(crate) fn collapsible(&self, gone: u32, kept: u32) -> bool {
        let (a, b) = (self.ring(gone), self.ring(kept));
        if a.len() == 3 && b.len() == 3 {
            return false;
        }
        let mut common = 0;
        let mut adjacent = false;
        for w in a {
            adjacent |= *w == kept;
            common += usize::from(b.contains(w));
        }
        adjacent && common == 2
    }

    /// Collapses an edge that is [`Rings::collapsible`].
    pub(crate) fn collapse(&mut self, gone: u32, kept: u32) -> Collapse {
        let mut ring = std::mem::take(&mut self.rings[gone as usize]);
        let start = ring.iter().position(|w| *w == kept).unwrap_or(0);
        ring.rotate_left(start);
        let last = ring.len() - 1;
        for side in [ring[1], ring[last]] {
            self.rings[side as usize].retain(|w| *w != gone);
        }
        for &w in &ring[2..last] {
            for x in &mut self.rings[w as usize] {
                if *x == gone {
                    *x = kept;
                }
            }
        }
        let target = &mut self.rings[kept as usize];
        if let Some(at) = target.iter().position(|w| *w == gone) {
            target.splice(at..=at, ring[2..last].iter().copied());
        }
        self.live -= 1;
        Collapse { gone, kept, ring }
    }

    /// Undoes the last collapse that is not undone yet.
    pub(crate) fn split(&mut self, collapse: &Collapse) {
        let Collapse { gone, kept, ring } = collapse;
        let last = ring.len() - 1;
        let (first, second) = (ring[1], ring[last]);
        let target = &mut self.rings[*kept as usize];
        // Counter-clockwise around `kept`: first, the moved ones, second.
        if let Some(at) = target.iter().position(|w| *w == first) {
            target.rotate_left(at);
            target.splice(1..last - 1, [*gone]);
        }
        for &w in &ring[2..last] {
            for x in &mut self.rings[w as usize] {
                if *x == *kept {
                    *x = *gone;
                }
            }
        }
        // Around `first` the order is gone, kept; around `second` it is kept, gone.
        let around = &mut self.rings[first as usize];
        if let Some(at) = around.iter().position(|w| w == kept) {
            around.insert(at, *gone);
        }
        let around = &mut self.rings[second as usize];
        if let Some(at) = around.iter().position(|w| w == kept) {
            around.insert(at + 1, *gone);
        }
        self.rings[*gone as usize] = ring.clone();
        self.live += 1;
    }

    /// Every triangle once, its least vertex first, in the order of that vertex.
    pub(crate) fn triangles(&self) -> Vec<[u32; 3]> {
        let mut out = Vec::with_capacity(2 * self.live);
        for (v, ring) in self.rings.iter().enumerate() {
            let v = v as u32;
            for (k, &a) in ring.iter().enumerate() {
                let b = ring[(k + 1) % ring.len()];
                if v < a && v < b {
                    out.push([v, a, b]);
                }
            }
        }
        out
    }
}

/// Links (b, c) of triangles (v, b, c) as one cycle.
fn ordered(links: &[(u32, u32)]) -> Option<Vec<u32>> {
    let mut ring = Vec::with_capacity(links.len());
    let mut at = links.first()?.0;
    for _ in 0..links.len() {
        ring.push(at);
        let from = at;
        let mut next = links.iter().filter(|(b, _)| *b == from);
        at = next.next()?.1;
        if next.next().is_some() {
            return None;
        }
    }
    let mut sorted = ring.clone();
    sorted.sort_unstable();
    sorted.dedup();
    (at == ring[0] && sorted.len() == ring.len() && ring.len() >= 3).then_some(ring)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An octahedron with one face divided at a new vertex.
    fn solid() -> Rings {
        let mut triangles = vec![
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
        ];
        triangles.extend([[0, 3, 6], [3, 5, 6], [5, 0, 6]]);
        Rings::new(7, &triangles).unwrap()
    }

    #[test]
    fn splits_undo_collapses() {
        let mut rings = solid();
        let before = rings.triangles();
        let mut undo = Vec::new();
        while rings.live() > 4 {
            let pair = (0..7_u32)
                .flat_map(|v| {
                    rings
                        .ring(v)
                        .iter()
                        .map(move |u| (v, *u))
                        .collect::<Vec<_>>()
                })
                .find(|(v, u)| rings.collapsible(*v, *u));
            let (v, u) = pair.unwrap();
            undo.push(rings.collapse(v, u));
            assert_eq!(rings.triangles().len(), 2 * rings.live() - 4);
        }
        for collapse in undo.iter().rev() {
            rings.split(collapse);
            assert_eq!(rings.triangles().len(), 2 * rings.live() - 4);
        }
        let mut after = rings.triangles();
        let mut before = before;
        after.sort_unstable();
        before.sort_unstable();
        assert_eq!(before, after);
    }

    #[test]
    fn open_and_pinched_surfaces_are_refused() {
        assert!(Rings::new(3, &[[0, 1, 2]]).is_none());
        // Two tetrahedra that share one vertex.
        let one = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        let two = one.map(|t: [u32; 3]| t.map(|v| if v == 0 { 0 } else { v + 3 }));
        let all: Vec<[u32; 3]> = one.into_iter().chain(two).collect();
        assert!(Rings::new(7, &all).is_none());
    }
}
