//! A proof that the normal f_u × f_v of a map S² → R³ vanishes nowhere, or the place where it does.

use std::collections::BinaryHeap;

use nalgebra::Vector3;
use sph::grid::RingGrid;
use sph::{Coefficients, Direction, SphericalCoords};

use crate::normals::{normals, normals_at};

/// Points per half wave of N on the first grid.
const OVERSAMPLING: usize = 5;
/// A normal shorter than this part of the longest one counts as zero.
const VANISHING: f64 = 1e-6;
/// Errors of the normals themselves, as a part of the longest one.
const ROUNDING: f64 = 1e-9;
/// The proved bound is at least this part of the shortest normal seen.
const SHARE: f64 = 0.5;
/// Largest number of subdivided cells, a few seconds at L = 50. Elongated scans at L = 50 need
/// about thirty.
const MOST_CELLS: usize = 5_000;

/// Points of a stencil along one axis, and of those the first corner of its cell.
const STENCIL: usize = 8;
const CORNER: usize = 3;
/// max over the cell of Π|t − tₖ| / 8!, the remainder of the stencil's polynomial.
const REMAINDER: f64 = 1.069e-3;

/// Bounds of |f_u × f_v|, the area of the surface per area of the sphere, m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Immersion {
    /// Proved: nowhere below this.
    pub lower: f64,
    /// Least value seen on a grid.
    pub seen_lower: f64,
    /// Largest value seen on a grid.
    pub seen_upper: f64,
}

/// Why three functions are not a surface in M^sph.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SphericalError {
    /// The normal vanishes, or nearly so: the map is not an immersion.
    #[error(
        "not an immersion: the area element falls to {seen:.3e} m² along ({x:.3}, {y:.3}, {z:.3}), where the largest is {largest:.3e} m²"
    )]
    NotImmersed {
        /// |f_u × f_v| there.
        seen: f64,
        /// Direction, x.
        x: f64,
        /// Direction, y.
        y: f64,
        /// Direction, z.
        z: f64,
        /// Largest |f_u × f_v|.
        largest: f64,
    },
    /// The normal was zero nowhere, but too short in too many places for a proof within the limit
    /// of work.
    #[error(
        "cannot prove the map an immersion: {open} places remain after {cells} cells, the least area element {seen:.3e} m² along ({x:.3}, {y:.3}, {z:.3}), where the largest is {largest:.3e} m²; a lower degree or more penalty may help"
    )]
    Undecided {
        /// Least |f_u × f_v| seen.
        seen: f64,
        /// Direction, x.
        x: f64,
        /// Direction, y.
        y: f64,
        /// Direction, z.
        z: f64,
        /// Largest |f_u × f_v|.
        largest: f64,
        /// Cells that are not settled.
        open: usize,
        /// Cells looked at.
        cells: usize,
    },
    /// f_u × f_v points inward.
    #[error("the surface is inside out (volume {volume:.3e} m³); mirror the sphere coordinates")]
    InsideOut {
        /// Signed volume, m³.
        volume: f64,
    },
}

/// Proves that N = f_u × f_v vanishes nowhere.
///
/// The sphere is cut into cells in (θ, φ). Over a cell N·d, d the mean direction of N at its
/// corners, is a trigonometric polynomial of degree D = 2L+1 in both angles, and so its polynomial
/// over the 8 × 8 points around the cell to within (1 + Σ max|w|)·|N|_∞ (D·step)⁸ × 1.07e-3
/// (Bernstein's inequality for the eighth derivative). That polynomial is the sum of the bilinear
/// interpolant of the corners, which stays above their least value, and a remainder that depends
/// only on the deviation from the bilinear function at the other points. Cells that are not settled
/// so are quartered, those with the shortest normal first, until N is found to vanish (below 1e-6
/// of its largest length), all are settled, or the work exceeds its limit.
pub(crate) fn certify(coordinates: &[Coefficients; 3]) -> Result<Immersion, SphericalError> {
    let degree = 2 * coordinates[0].degree() + 1;
    let half = OVERSAMPLING * degree.max(8);
    let grid = Grid::new(coordinates, half);
    let lengths = grid.padded.iter().map(Vector3::norm);
    let (shortest, longest) = lengths.fold((f64::INFINITY, 0.0_f64), |(low, high), l| {
        (low.min(l), high.max(l))
    });
    let mut search = Search {
        coordinates,
        weights: Weights::new(),
        degree: degree as f64,
        // The bound of sph::bounds, for every N·d.
        most: longest
            * (0.5 * std::f64::consts::PI / OVERSAMPLING as f64)
                .cos()
                .powi(-2),
        longest,
        shortest,
        lower: f64::INFINITY,
        open: BinaryHeap::new(),
    };
    search.first(&grid);
    search.run()
}

/// N at θ = πi/half, φ = πj/half, and a stencil's reach beyond all ends.
struct Grid {
    padded: Vec<Vector3<f64>>,
    stride: usize,
    half: usize,
}

impl Grid {
    fn new(coordinates: &[Coefficients; 3], half: usize) -> Self {
        let normals = normals(coordinates, &RingGrid::equiangular(half + 1, 2 * half));
        let stride = 2 * half + STENCIL;
        let padded = (0..half + STENCIL).flat_map(|row| {
            // Beyond the poles (−θ, φ) is (θ, φ + π).
            let (ring, turn) = match row {
                _ if row < CORNER => (CORNER - row, half),
                _ if row > half + CORNER => (2 * half + CORNER - row, half),
                _ => (row - CORNER, 0),
            };
            let normals = &normals;
            (0..stride).map(move |column| {
                let longitude = (column + 2 * half - CORNER + turn) % (2 * half);
                normals[ring * 2 * half + longitude]
            })
        });
        Self {
            padded: padded.collect(),
            stride,
            half,
        }
    }
}

/// max |wₖ(t)| over the cell 0 ≤ t ≤ 1 of the stencil's Lagrange polynomials, nodes −3 … 4.
struct Weights([f64; STENCIL]);

impl Weights {
    fn new() -> Self {
        const STEPS: usize = 1000;
        let node = |k: usize| k as f64 - CORNER as f64;
        let weight = |k: usize, t: f64| -> f64 {
            let others = (0..STENCIL).filter(|m| *m != k);
            others
                .map(|m| (t - node(m)) / (node(k) - node(m)))
                .product()
        };
        Self(std::array::from_fn(|k| {
            let values = (0..=STEPS).map(|i| weight(k, i as f64 / STEPS as f64).abs());
            // Between the places looked at it is less than 1e-5 more.
            values.fold(0.0, f64::max) + 1e-5
        }))
    }

    fn sum(&self) -> f64 {
        self.0.iter().sum()
    }
}

/// Angles from (theta, phi) to one step more that are not settled.
struct Cell {
    theta: f64,
    phi: f64,
    step: f64,
    /// Shortest |N| at its corners.
    shortest: f64,
    /// That corner.
    at: Direction,
}

/// Cells are taken from the heap by their shortest normal.
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.shortest.total_cmp(&self.shortest)
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Cell {}

struct Search<'a> {
    coordinates: &'a [Coefficients; 3],
    weights: Weights,
    degree: f64,
    /// No |N| is above this.
    most: f64,
    longest: f64,
    shortest: f64,
    /// Least lower bound among the settled cells.
    lower: f64,
    open: BinaryHeap<Cell>,
}

impl Search<'_> {
    fn first(&mut self, grid: &Grid) {
        let step = std::f64::consts::PI / grid.half as f64;
        for i in 0..grid.half {
            for j in 0..2 * grid.half {
                let at = |a: usize, b: usize| grid.padded[(i + a) * grid.stride + j + b];
                self.settle(step * i as f64, step * j as f64, step, &at);
            }
        }
    }

    /// Settles a cell from N on its stencil, or keeps it open.
    fn settle(
        &mut self,
        theta: f64,
        phi: f64,
        step: f64,
        at: &impl Fn(usize, usize) -> Vector3<f64>,
    ) {
        let lower = self.bound(step, at);
        if lower > SHARE * self.shortest {
            self.lower = self.lower.min(lower);
        } else {
            // In the order of `corners`.
            let offsets = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
            let lengths = corners(at).map(|n| n.norm());
            let ends = lengths.into_iter().zip(offsets);
            let least = ends.min_by(|a, b| a.0.total_cmp(&b.0));
            let (shortest, (a, b)) = least.unwrap_or((0.0, (0.0, 0.0)));
            self.open.push(Cell {
                theta,
                phi,
                step,
                shortest,
                at: direction(theta + a * step, phi + b * step),
            });
        }
    }

    /// A lower bound of |N| over a cell; not positive if nothing is proved.
    fn bound(&self, step: f64, at: &impl Fn(usize, usize) -> Vector3<f64>) -> f64 {
        let corners = corners(at);
        let Some(along) = corners.iter().sum::<Vector3<f64>>().try_normalize(0.0) else {
            return 0.0;
        };
        let [a, b, c, d] = corners.map(|n| n.dot(&along));
        let remainder = (1.0 + self.weights.sum()) * REMAINDER * self.most;
        let error = remainder * (self.degree * step).powi(STENCIL as i32) + ROUNDING * self.longest;
        let mut lower = a.min(b).min(c).min(d) - error;
        for i in 0..STENCIL {
            let t = i as f64 - CORNER as f64;
            for j in 0..STENCIL {
                let u = j as f64 - CORNER as f64;
                let bilinear = a + t * (b - a) + u * (c - a) + t * u * (a - b - c + d);
                let missed = at(i, j).dot(&along) - bilinear;
                lower -= self.weights.0[i] * self.weights.0[j] * missed.abs();
            }
            if lower <= 0.0 {
                break;
            }
        }
        lower
    }

    /// Subdivides open cells until there are none.
    fn run(mut self) -> Result<Immersion, SphericalError> {
        let mut cells = 0;
        while let Some(cell) = self.open.pop() {
            self.shortest = self.shortest.min(cell.shortest);
            let p = cell.at;
            if cell.shortest <= VANISHING * self.longest {
                return Err(SphericalError::NotImmersed {
                    seen: cell.shortest,
                    x: p.x,
                    y: p.y,
                    z: p.z,
                    largest: self.longest,
                });
            }
            if cells >= MOST_CELLS {
                return Err(SphericalError::Undecided {
                    seen: self.shortest,
                    x: p.x,
                    y: p.y,
                    z: p.z,
                    largest: self.longest,
                    open: self.open.len() + 1,
                    cells,
                });
            }
            cells += 1;
            self.quarter(&cell);
        }
        Ok(Immersion {
            lower: self.lower,
            seen_lower: self.shortest,
            seen_upper: self.longest,
        })
    }

    fn quarter(&mut self, cell: &Cell) {
        const WIDE: usize = STENCIL + 1;
        let step = 0.5 * cell.step;
        let angle = |start: f64, k: usize| start + step * (k as f64 - CORNER as f64);
        let places: Vec<Direction> = (0..WIDE * WIDE)
            .map(|k| direction(angle(cell.theta, k / WIDE), angle(cell.phi, k % WIDE)))
            .collect();
        let patch = normals_at(self.coordinates, &places);
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let at = |a: usize, b: usize| patch[(a + i) * WIDE + b + j];
            let (theta, phi) = (cell.theta + step * i as f64, cell.phi + step * j as f64);
            self.settle(theta, phi, step, &at);
        }
    }
}

/// N at (0,0), (1,0), (0,1), (1,1) of the cell.
fn corners(at: &impl Fn(usize, usize) -> Vector3<f64>) -> [Vector3<f64>; 4] {
    let k = CORNER;
    [at(k, k), at(k + 1, k), at(k, k + 1), at(k + 1, k + 1)]
}

/// The point of the sphere at any θ, also beyond the poles.
fn direction(theta: f64, phi: f64) -> Direction {
    SphericalCoords { theta, phi }.direction()
}
