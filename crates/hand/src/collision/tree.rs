//! A hierarchy of surface patches, each with a sphere and a slab around it.
//!
//! A patch lies in the sphere of radius ρ about one of its own vertices c and in the slab
//! −below ≤ n·(x − c) ≤ above, n being its mean outward normal. The distance d to a
//! convex piece is a convex function, so with its slope g at c, over the patch
//! d(x) ≥ d(c) + g·(x − c) ≥ d(c) + min over the slab of (g·n) h − ρ |g − (g·n) n|,
//! while d(c) itself bounds the least distance from above. Where patch and piece face
//! each other g ≈ −n, so both bounds agree to second order in the patch's size and few
//! patches survive.

use nalgebra::{Point3, Vector3};
use sph::{Direction, SphericalCoords};

use super::gap::Vertex;
use super::piece::direction_or_z;

/// Largest number of cells in a leaf.
const LEAF_CELLS: usize = 2;

/// The content of a node.
#[derive(Debug, Clone, Copy)]
pub(super) enum Content {
    /// The cells of a block of the grid.
    Leaf(Block),
    /// Two nodes.
    Inner { left: usize, right: usize },
}

/// Cells of these rows and columns; a cell has its first corner at its row and column.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    rows: (usize, usize),
    columns: (usize, usize),
}

/// A patch of the surface.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) centre: Vector3<f64>,
    /// Row and column of the centre.
    pub(super) vertex: Vertex,
    pub(super) radius: f64,
    pub(super) normal: Vector3<f64>,
    pub(super) above: f64,
    pub(super) below: f64,
    pub(super) content: Content,
}

/// The vertices of a (θ,φ) grid, ring after ring, and the nodes over its cells, the root first.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    vertices: Vec<Vector3<f64>>,
    columns: usize,
    /// Whether every vertex lies in its own direction from the origin.
    star_shaped: bool,
}

impl Tree {
    /// Builds the hierarchy over a grid from pole to pole. O(n log n).
    pub(super) fn new(vertices: &[Point3<f64>], columns: usize, star_shaped: bool) -> Self {
        let mut tree = Tree {
            nodes: Vec::with_capacity(vertices.len() + 1),
            vertices: vertices.iter().map(|v| v.coords).collect(),
            columns,
            star_shaped,
        };
        let rows = vertices.len() / columns;
        tree.build(Block {
            rows: (0, rows - 1),
            columns: (0, columns),
        });
        tree
    }

    /// Rows and columns of the vertices.
    pub(super) fn grid(&self) -> (usize, usize) {
        (self.vertices.len() / self.columns, self.columns)
    }

    /// The direction of a vertex of the grid.
    pub(super) fn direction(&self, (row, column): Vertex) -> Direction {
        let theta = std::f64::consts::PI * f64::from(row) / (self.grid().0 - 1) as f64;
        let phi = std::f64::consts::TAU * f64::from(column) / self.columns as f64;
        SphericalCoords { theta, phi }.direction()
    }

    fn at(&self, row: usize, column: usize) -> Vector3<f64> {
        self.vertices[row * self.columns + column % self.columns]
    }

    /// The two triangles of every cell of a block, each with its first corner's row and column; those
    /// at the poles may be degenerate.
    pub(super) fn triangles(
        &self,
        block: Block,
    ) -> impl Iterator<Item = ([Vector3<f64>; 3], Vertex)> + '_ {
        let cells = (block.rows.0..block.rows.1)
            .flat_map(move |r| (block.columns.0..block.columns.1).map(move |c| (r, c)));
        cells.flat_map(|(r, c)| {
            let corner = self.at(r, c);
            let across = self.at(r + 1, c + 1);
            let vertex = (r as u32, (c % self.columns) as u32);
            [
                ([corner, self.at(r + 1, c), across], vertex),
                ([corner, across, self.at(r, c + 1)], vertex),
            ]
        })
    }

    /// Appends the node of a block and everything below it; returns its index.
    fn build(&mut self, block: Block) -> usize {
        let index = self.nodes.len();
        let node = self.patch(block);
        self.nodes.push(node);
        if let Some((first, second)) = self.split(block) {
            let left = self.build(first);
            let right = self.build(second);
            self.nodes[index].content = Content::Inner { left, right };
        }
        index
    }

    fn patch(&self, block: Block) -> Node {
        let ((r0, r1), (c0, c1)) = (block.rows, block.columns);
        let (row, column) = ((r0 + r1) / 2, (c0 + c1) / 2);
        let centre = self.at(row, column);
        let down = self.at(r1, c1) - self.at(r0, c0);
        let up = self.at(r0, c1) - self.at(r1, c0);
        let mut normal = direction_or_z(&down.cross(&up)).into_inner();
        if self.star_shaped && normal.dot(&centre) < 0.0 {
            normal = -normal;
        }
        let (mut radius, mut above, mut below): (f64, f64, f64) = (0.0, 0.0, 0.0);
        for row in r0..=r1 {
            for column in c0..=c1 {
                let offset = self.at(row, column) - centre;
                let height = normal.dot(&offset);
                radius = radius.max(offset.norm_squared());
                above = above.max(height);
                below = below.max(-height);
            }
        }
        Node {
            centre,
            vertex: (row as u32, (column % self.columns) as u32),
            radius: radius.sqrt(),
            normal,
            above,
            below,
            content: Content::Leaf(block),
        }
    }

    /// Halves a block across its longer side; `None` for a leaf.
    fn split(&self, block: Block) -> Option<(Block, Block)> {
        let ((r0, r1), (c0, c1)) = (block.rows, block.columns);
        if (r1 - r0) * (c1 - c0) <= LEAF_CELLS {
            return None;
        }
        let (height, width) = if self.star_shaped {
            self.angles(block)
        } else {
            self.lengths(block)
        };
        let part = |rows, columns| Block { rows, columns };
        Some(if c1 - c0 == 1 || (r1 - r0 > 1 && height >= width) {
            let cut = (r0 + r1) / 2;
            (part((r0, cut), (c0, c1)), part((cut, r1), (c0, c1)))
        } else {
            let cut = (c0 + c1) / 2;
            (part((r0, r1), (c0, cut)), part((r0, r1), (cut, c1)))
        })
    }
    /// Extents of a block along its rows and columns as angles, about.
    fn angles(&self, block: Block) -> (f64, f64) {
        let ((r0, r1), (c0, c1)) = (block.rows, block.columns);
        let middle = self.at((r0 + r1) / 2, (c0 + c1) / 2);
        let rows = self.vertices.len() / self.columns;
        let height = (r1 - r0) as f64 * std::f64::consts::PI / (rows - 1) as f64;
        let ring = middle.xy().norm() / middle.norm();
        let width = (c1 - c0) as f64 * ring * std::f64::consts::TAU / self.columns as f64;
        (height, width)
    }

    /// Lengths of the lines through the middle of a block, metres.
    fn lengths(&self, block: Block) -> (f64, f64) {
        let ((r0, r1), (c0, c1)) = (block.rows, block.columns);
        let (row, column) = ((r0 + r1) / 2, (c0 + c1) / 2);
        let down = (r0..r1).map(|r| (self.at(r + 1, column) - self.at(r, column)).norm());
        let along = (c0..c1).map(|c| (self.at(row, c + 1) - self.at(row, c)).norm());
        (down.sum(), along.sum())
    }
}
