//! A proof that a map of the sphere into space does not touch itself.

use nalgebra::Vector3;
use rayon::prelude::*;
use sph::direction::angle;
use sph::{Coefficients, Direction, batch};

use crate::injectivity_cell::{Cell, Piece};
use crate::third_derivatives::ThirdDerivatives;

/// Cells between the poles at the start, per degree.
const RINGS: f64 = 1.2;
/// Most cells, and the most halvings of one.
const MOST_CELLS: usize = 500_000;
const DEEPEST: u32 = 9;

/// The result of the proof that a surface does not touch itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Embedding {
    /// The map is proved to be injective and an immersion.
    Proved {
        /// Cells of the proof.
        cells: usize,
    },
    /// Neither proved nor refuted within the limit of work.
    Undecided {
        /// Two directions whose points are the nearest among those that remain.
        first: Direction,
        /// The other one.
        second: Direction,
        /// Distance of the two points, metres.
        gap: f64,
    },
}

/// A set of cells: a leaf, or what its children hold.
struct Node {
    centre: Direction,
    radius: f64,
    /// Least reach of the cells.
    reach: f64,
    low: Vector3<f64>,
    high: Vector3<f64>,
    kind: Kind,
}

enum Kind {
    Leaf(usize),
    Inner(Vec<usize>),
}

/// Proves that f = (x, y, z) is injective, or returns the nearest pair of points for which it
/// cannot.
///
/// A search over pairs of cells. A pair is settled if one cell is within the other's reach
/// ([`Cell::reach`], by the mean value of df along great circles), or if slabs or boxes separate
/// the images. Cells of pairs that are not settled are quartered. Bounds of second-order remainders
/// are certified ([`ThirdDerivatives`]). Rounding is covered by a margin.
pub(crate) fn certify(coordinates: &[Coefficients; 3]) -> Embedding {
    let mut search = Search::new(coordinates);
    let mut open = vec![(search.root, search.root)];
    while !open.is_empty() {
        let rest: Vec<(usize, usize)> = open
            .par_chunks(64)
            .flat_map_iter(|pairs| {
                let mut rest = Vec::new();
                for pair in pairs {
                    search.settle(*pair, &mut rest);
                }
                rest
            })
            .collect();
        if rest.is_empty() {
            break;
        }
        let deep = rest.iter().any(|pair| search.depth(pair) >= DEEPEST);
        if deep || search.cells.len() > MOST_CELLS {
            return search.nearest(&rest);
        }
        search.quarter(&rest);
        open = rest;
    }
    Embedding::Proved {
        cells: search.cells.len(),
    }
}

struct Search<'a> {
    coordinates: &'a [Coefficients; 3],
    thirds: ThirdDerivatives,
    size: f64,
    cells: Vec<Cell>,
    nodes: Vec<Node>,
    root: usize,
}

impl<'a> Search<'a> {
    fn new(coordinates: &'a [Coefficients; 3]) -> Self {
        let degree = coordinates[0].degree().max(8);
        let pieces = pieces((RINGS * degree as f64) as usize);
        let size = coordinates.iter().map(|c| {
            let squares = c.as_slice().iter().map(|b| b * b);
            squares.sum::<f64>().sqrt() * (degree as f64 + 1.0)
        });
        let mut search = Self {
            coordinates,
            thirds: ThirdDerivatives::new(coordinates),
            size: size.sum(),
            cells: Vec::new(),
            nodes: Vec::new(),
            root: 0,
        };
        let depths = vec![0; pieces.len()];
        let mut leaves = search.add_cells(pieces, &depths);
        search.root = search.group(&mut leaves);
        search
    }

    /// Expands the map about the centres of pieces; their nodes.
    fn add_cells(&mut self, pieces: Vec<Piece>, depths: &[u32]) -> Vec<usize> {
        let centres: Vec<Direction> = pieces.iter().map(Piece::centre).collect();
        let jets = self
            .coordinates
            .each_ref()
            .map(|c| batch::jets(c, &centres));
        let (thirds, size) = (&self.thirds, self.size);
        let cells: Vec<Cell> = (0..pieces.len())
            .into_par_iter()
            .map(|i| {
                let jets = jets.each_ref().map(|j| j[i]);
                Cell::new(pieces[i], depths[i], jets, thirds, size)
            })
            .collect();
        cells
            .into_iter()
            .map(|cell| {
                let (low, high) = cell.bounds();
                self.nodes.push(Node {
                    centre: cell.centre,
                    radius: cell.radius,
                    reach: if cell.reach >= cell.radius {
                        cell.reach
                    } else {
                        0.0
                    },
                    low,
                    high,
                    kind: Kind::Leaf(self.cells.len()),
                });
                self.cells.push(cell);
                self.nodes.len() - 1
            })
            .collect()
    }

    /// A binary tree over nodes, halved along the widest extent of their centres.
    fn group(&mut self, members: &mut [usize]) -> usize {
        if members.len() == 1 {
            return members[0];
        }
        let centre = |i: &usize| self.nodes[*i].centre.into_inner();
        let (low, high) = members.iter().map(centre).fold(
            (Vector3::repeat(2.0), Vector3::repeat(-2.0)),
            |(low, high): (Vector3<f64>, Vector3<f64>), c| (low.inf(&c), high.sup(&c)),
        );
        let axis = (high - low).imax();
        let middle = members.len() / 2;
        members.select_nth_unstable_by(middle, |a, b| {
            centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(b))
        });
        let (left, right) = members.split_at_mut(middle);
        let children = vec![self.group(left), self.group(right)];
        self.add_inner(children)
    }

    fn add_inner(&mut self, children: Vec<usize>) -> usize {
        let nodes = || children.iter().map(|i| &self.nodes[*i]);
        let sum: Vector3<f64> = nodes().map(|n| n.centre.into_inner()).sum();
        let axis = sum.try_normalize(1e-9).unwrap_or_else(Vector3::z);
        let centre = Direction::new_unchecked(axis);
        let radius = nodes()
            .map(|n| angle(&centre, &n.centre) + n.radius)
            .fold(0.0, f64::max);
        let node = Node {
            centre,
            radius,
            reach: nodes().map(|n| n.reach).fold(f64::INFINITY, f64::min),
            low: nodes().fold(Vector3::repeat(f64::INFINITY), |a, n| a.inf(&n.low)),
            high: nodes().fold(Vector3::repeat(f64::NEG_INFINITY), |a, n| a.sup(&n.high)),
            kind: Kind::Inner(children),
        };
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// Settles a pair of nodes, or adds the pairs of leaves that are not settled.
    fn settle(&self, (a, b): (usize, usize), rest: &mut Vec<(usize, usize)>) {
        let mut stack = vec![(a, b)];
        while let Some((a, b)) = stack.pop() {
            let (one, other) = (&self.nodes[a], &self.nodes[b]);
            if a != b {
                let boxes_apart =
                    (0..3).any(|k| one.low[k] > other.high[k] || other.low[k] > one.high[k]);
                if boxes_apart {
                    continue;
                }
            }
            let span = if a == b {
                2.0 * one.radius
            } else {
                angle(&one.centre, &other.centre) + one.radius + other.radius
            };
            if span <= one.reach || span <= other.reach {
                continue;
            }
            match (&one.kind, &other.kind) {
                (Kind::Inner(children), _) if a == b => {
                    for (k, i) in children.iter().enumerate() {
                        stack.extend(children[k..].iter().map(|j| (*i, *j)));
                    }
                }
                (Kind::Leaf(i), Kind::Leaf(j)) => {
                    let (p, q) = (&self.cells[*i], &self.cells[*j]);
                    let settled = p.reaches(q) || q.reaches(p) || (i != j && p.apart(q));
                    if !settled {
                        rest.push((a, b));
                    }
                }
                (Kind::Inner(children), Kind::Leaf(_)) => {
                    stack.extend(children.iter().map(|i| (*i, b)));
                }
                (Kind::Inner(children), Kind::Inner(_)) if one.radius >= other.radius => {
                    stack.extend(children.iter().map(|i| (*i, b)));
                }
                (_, Kind::Inner(children)) => stack.extend(children.iter().map(|j| (a, *j))),
            }
        }
    }

    fn depth(&self, (a, b): &(usize, usize)) -> u32 {
        let of = |node: usize| match self.nodes[node].kind {
            Kind::Leaf(cell) => self.cells[cell].depth,
            Kind::Inner(_) => 0,
        };
        of(*a).max(of(*b))
    }

    /// Subdivides the larger cell of every pair, and every cell that is not within its own reach.
    fn quarter(&mut self, pairs: &[(usize, usize)]) {
        let mut split: Vec<usize> = Vec::new();
        for (a, b) in pairs {
            let larger = if self.nodes[*a].radius >= self.nodes[*b].radius {
                *a
            } else {
                *b
            };
            split.push(larger);
        }
        split.sort_unstable();
        split.dedup();
        let (mut pieces, mut depths) = (Vec::new(), Vec::new());
        for node in &split {
            if let Kind::Leaf(cell) = self.nodes[*node].kind {
                pieces.extend(self.cells[cell].piece.quarters());
                depths.extend([self.cells[cell].depth + 1; 4]);
            }
        }
        let leaves = self.add_cells(pieces, &depths);
        for (node, children) in split.into_iter().zip(leaves.chunks(4)) {
            let reach = children.iter().map(|c| self.nodes[*c].reach);
            self.nodes[node].reach = reach.fold(f64::INFINITY, f64::min);
            self.nodes[node].kind = Kind::Inner(children.to_vec());
        }
    }

    /// The result if pairs are left.
    fn nearest(&self, pairs: &[(usize, usize)]) -> Embedding {
        let cell = |node: usize| match &self.nodes[node].kind {
            Kind::Leaf(cell) => self.cells.get(*cell),
            Kind::Inner(_) => None,
        };
        let found = pairs
            .iter()
            .filter_map(|(a, b)| Some((cell(*a)?, cell(*b)?)))
            .map(|(p, q)| (p.centre, q.centre, (p.place - q.place).norm()))
            .min_by(|a, b| a.2.total_cmp(&b.2));
        let (first, second, gap) = found.unwrap_or((Vector3::z_axis(), Vector3::z_axis(), 0.0));
        Embedding::Undecided { first, second, gap }
    }
}

/// The sphere cut into about square pieces.
fn pieces(rings: usize) -> Vec<Piece> {
    let rings = rings.max(8);
    let step = std::f64::consts::PI / rings as f64;
    let mut out = Vec::new();
    for i in 0..rings {
        let theta = [step * i as f64, step * (i + 1) as f64];
        let widest = if theta[0] < std::f64::consts::FRAC_PI_2 {
            theta[1].min(std::f64::consts::FRAC_PI_2).sin()
        } else {
            theta[0].sin()
        };
        let columns = ((std::f64::consts::TAU * widest / step).ceil() as usize).max(4);
        let turn = std::f64::consts::TAU / columns as f64;
        out.extend((0..columns).map(|j| Piece {
            theta,
            phi: [turn * j as f64, turn * (j + 1) as f64],
        }));
    }
    out
}
