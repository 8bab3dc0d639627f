//! Sums over all harmonics at many scattered points by a non-uniform Fourier transform.
//!
//! The sums are those of [`crate::batch`], at a cost per point that hardly grows with the degree. The
//! harmonics are summed on a grid of the double Fourier sphere, and each point is interpolated from (or
//! spread to) its grid neighbours with a window. Points are sorted by tiles, so that the grid rows they
//! need stay in the cache. Each band of rows is summed by one task and the bands are merged in order, so
//! the results do not depend on the number of threads.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::coefficients::Coefficients;
use crate::direction::Direction;
use crate::double_fourier::{DoubleFourier, FineGrid};
use crate::index;
use crate::kernel::{TAPS, Taps};
use crate::multiply_add::multiply_add;

/// Number of points per task of [`Scattered::evaluate`].
const CHUNK: usize = 2048;
/// Number of bands of tiles from pole to pole; a power of two, so that a point's band follows from
/// θ without rounding.
const BANDS: usize = 64;
/// Number of tiles in each band.
const SECTORS: usize = 64;
/// Least number of rows per task. A task also holds the rows that its windows cover beyond its own.
const OWNED_ROWS: usize = 24;

/// Puts items into the order of a permutation, in place: item `order[k]` comes to position k.
fn arrange<T: Copy>(items: &mut [T], order: &[u32]) {
    let mut done = vec![false; items.len()];
    for start in 0..items.len() {
        if done[start] {
            continue;
        }
        let first = items[start];
        let mut to = start;
        loop {
            done[to] = true;
            let from = order[to] as usize;
            if from == start {
                items[to] = first;
                break;
            }
            items[to] = items[from];
            to = from;
        }
    }
}

/// Points of the sphere, prepared for repeated sums.
///
/// Sums are accurate to about 1e-14 of the largest value, at any degree.
#[derive(Clone, Debug)]
pub struct Scattered {
    /// (θ, φ) in whole turns, [0, ½] and [0, 1), tile after tile.
    turns: Vec<[f64; 2]>,
    /// Index of each point in the caller's list.
    order: Vec<u32>,
    /// Index of the first point of each band of tiles, and the number of points.
    bands: Vec<usize>,
}

impl Scattered {
    /// Sorts the points by tiles. At most 2³² points; linear in their number.
    pub fn new(directions: &[Direction]) -> Self {
        let mut angles: Vec<[f64; 2]> = directions.par_iter().map(turns).collect();
        let mut starts = vec![0_usize; BANDS * SECTORS + 1];
        for t in &angles {
            starts[tile(t) + 1] += 1;
        }
        for b in 0..BANDS * SECTORS {
            starts[b + 1] += starts[b];
        }
        let bands = starts.iter().step_by(SECTORS).copied().collect();
        let mut order = vec![0_u32; angles.len()];
        for (i, t) in angles.iter().enumerate() {
            let slot = &mut starts[tile(t)];
            order[*slot] = i as u32;
            *slot += 1;
        }
        arrange(&mut angles, &order);
        Self {
            turns: angles,
            order,
            bands,
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// f(pᵢ) = Σ β_{lm} Y_{lm}(pᵢ), in the order of the points.
    ///
    /// Errors are about 1e-14 of the largest |f|. About 900 flops per point and L³ for the grid.
    pub fn evaluate(&self, beta: &Coefficients) -> Vec<f64> {
        let fourier = DoubleFourier::new(beta.degree());
        let grid = fourier.synthesis(beta.as_slice());
        let mut sorted = vec![0.0; self.len()];
        sorted
            .par_chunks_mut(CHUNK)
            .zip(self.turns.par_chunks(CHUNK))
            .for_each(|(out, turns)| {
                Arch::new().dispatch(Interpolate {
                    fourier: &fourier,
                    grid: &grid,
                    turns,
                    out,
                });
            });
        let mut values = vec![0.0; self.len()];
        for (&i, v) in self.order.iter().zip(&sorted) {
            values[i as usize] = *v;
        }
        values
    }

    /// Σᵢ wᵢ Y_{lm}(pᵢ) for all l ≤ L: the adjoint of [`Scattered::evaluate`].
    ///
    /// # Panics
    /// `weights` does not have one entry per point.
    pub fn moments(&self, weights: &[f64], degree: usize) -> Coefficients {
        assert_eq!(self.len(), weights.len(), "one weight per point");
        let fourier = DoubleFourier::new(degree);
        let grid = self.spread(&fourier, &self.sorted(weights));
        let mut out = Coefficients::zeros(degree);
        out.as_mut_slice().copy_from_slice(&fourier.analysis(grid));
        debug_assert_eq!(out.as_slice().len(), index::count(degree));
        out
    }

    /// Weights in the order of the tiles. They are gathered beforehand, so that the loop over the windows
    /// reads them one after the other.
    fn sorted(&self, weights: &[f64]) -> Vec<f64> {
        let order = self.order.par_iter();
        order.map(|&i| weights[i as usize]).collect()
    }

    /// Every point's weight, spread over its grid neighbours; weights in the order of the tiles.
    fn spread(&self, fourier: &DoubleFourier, weights: &[f64]) -> FineGrid {
        let (stride, n) = (fourier.stride(), fourier.steps());
        let group = (2 * BANDS * OWNED_ROWS).div_ceil(n).min(BANDS);
        let row = |band: usize| band.min(BANDS) * n / (2 * BANDS);
        let parts: Vec<Vec<f64>> = (0..BANDS.div_ceil(group))
            .into_par_iter()
            .map(|task| {
                let (begin, end) = (task * group, ((task + 1) * group).min(BANDS));
                let mut values = vec![0.0; (row(end) - row(begin) + 1 + TAPS) * stride];
                let slots = self.bands[begin]..self.bands[end];
                Arch::new().dispatch(Spread {
                    fourier,
                    turns: &self.turns[slots.clone()],
                    weights: &weights[slots],
                    first: row(begin),
                    values: &mut values,
                });
                values
            })
            .collect();
        let mut values = vec![0.0; fourier.rows() * stride];
        for (task, part) in parts.iter().enumerate() {
            let start = row(task * group) * stride;
            for (sum, p) in values[start..].iter_mut().zip(part) {
                *sum += p;
            }
        }
        FineGrid { values }
    }
}

/// θ and φ in whole turns.
fn turns(p: &Direction) -> [f64; 2] {
    let theta = p.x.hypot(p.y).atan2(p.z) / std::f64::consts::TAU;
    let phi = p.y.atan2(p.x) / std::f64::consts::TAU;
    [theta, if phi < 0.0 { phi + 1.0 } else { phi }]
}

/// Number of a point's tile.
fn tile(turns: &[f64; 2]) -> usize {
    let band = ((turns[0] * (2 * BANDS) as f64) as usize).min(BANDS - 1);
    let sector = ((turns[1] * SECTORS as f64) as usize).min(SECTORS - 1);
    band * SECTORS + sector
}

/// Where a point's window lies on the grid, and its weights.
struct Footprint {
    row: usize,
    column: usize,
    theta: Taps,
    phi: Taps,
}

impl Footprint {
    #[inline(always)]
    fn new<S: Simd>(fourier: &DoubleFourier, turns: &[f64; 2]) -> Self {
        let n = fourier.steps();
        let x = turns[0] * n as f64;
        let y = turns[1] * n as f64;
        // Rounding can make φ equal to one whole turn; then the last column with u = ½ is used.
        let row = (x as usize).min(n / 2);
        let column = (y as usize).min(n - 1);
        Self {
            row,
            column,
            theta: fourier.kernel().weights::<S>(x - row as f64 - 0.5),
            phi: fourier.kernel().weights::<S>(y - column as f64 - 0.5),
        }
    }
}

struct Interpolate<'a> {
    fourier: &'a DoubleFourier,
    grid: &'a FineGrid,
    turns: &'a [[f64; 2]],
    out: &'a mut [f64],
}

impl WithSimd for Interpolate<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let stride = self.fourier.stride();
        for (turns, out) in self.turns.iter().zip(self.out) {
            let window = Footprint::new::<S>(self.fourier, turns);
            let start = window.row * stride + window.column;
            let rows = self.grid.values[start..].chunks(stride);
            let mut sums = [0.0; TAPS];
            for (factor, values) in window.theta.iter().zip(rows) {
                let values = &values[..TAPS];
                for k in 0..TAPS {
                    sums[k] = multiply_add::<S>(*factor, values[k], sums[k]);
                }
            }
            let mut total = 0.0;
            for k in 0..TAPS {
                total += sums[k] * window.phi[k];
            }
            *out = total;
        }
    }
}

/// The adjoint of [`Interpolate`], onto the rows of one task.
struct Spread<'a> {
    fourier: &'a DoubleFourier,
    turns: &'a [[f64; 2]],
    weights: &'a [f64],
    /// First row of the task.
    first: usize,
    values: &'a mut [f64],
}

impl WithSimd for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let stride = self.fourier.stride();
        for (turns, weight) in self.turns.iter().zip(self.weights) {
            let mut window = Footprint::new::<S>(self.fourier, turns);
            for p in &mut window.phi {
                *p *= weight;
            }
            let start = (window.row - self.first) * stride + window.column;
            let rows = self.values[start..].chunks_mut(stride);
            for (factor, values) in window.theta.iter().zip(rows) {
                let values = &mut values[..TAPS];
                for k in 0..TAPS {
                    values[k] = multiply_add::<S>(*factor, window.phi[k], values[k]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch;
    use crate::direction::{even_directions, retract};
    use nalgebra::Vector3;

    fn points() -> Vec<Direction> {
        let mut all = even_directions(3000);
        all.extend([Vector3::z_axis(), -Vector3::z_axis(), Vector3::x_axis()]);
        let tiny = Vector3::new(3e-9, -1e-9, 0.0);
        all.extend([
            retract(&Vector3::z_axis(), &tiny),
            retract(&-Vector3::z_axis(), &tiny),
        ]);
        all.push(Direction::new_normalize(Vector3::new(1.0, -1e-18, 0.2)));
        all
    }

    #[test]
    fn agrees_with_the_direct_sums() {
        let points = points();
        let scattered = Scattered::new(&points);
        let weights: Vec<f64> = (0..points.len()).map(|i| (i as f64 * 0.77).sin()).collect();
        for degree in [0, 1, 2, 5, 16, 50, 101] {
            let mut beta = Coefficients::zeros(degree);
            for (i, b) in beta.as_mut_slice().iter_mut().enumerate() {
                *b = (i as f64 * 0.37).cos();
            }
            let direct = batch::evaluate(&beta, &points);
            let scale = direct.iter().fold(0.0_f64, |s, v| s.max(v.abs()));
            for (a, b) in scattered.evaluate(&beta).iter().zip(&direct) {
                assert!(
                    (a - b).abs() <= 3e-14 * scale,
                    "L={degree}: {:.1e}",
                    (a - b).abs() / scale
                );
            }
            let direct = batch::moments(&points, &weights, degree);
            let found = scattered.moments(&weights, degree);
            let scale = weights.iter().map(|w| w * w).sum::<f64>().sqrt() * (degree + 1) as f64;
            assert!(found.distance(&direct) <= 1e-13 * scale, "L={degree}");
        }
    }

    #[test]
    fn evaluate_and_moments_are_adjoint() {
        let points = points();
        let scattered = Scattered::new(&points);
        let mut beta = Coefficients::zeros(23);
        for (i, b) in beta.as_mut_slice().iter_mut().enumerate() {
            *b = (i as f64 * 1.9).sin();
        }
        let weights: Vec<f64> = (0..points.len()).map(|i| (i as f64 * 0.3).cos()).collect();
        let left: f64 = scattered
            .evaluate(&beta)
            .iter()
            .zip(&weights)
            .map(|(f, w)| f * w)
            .sum();
        let moments = scattered.moments(&weights, 23);
        let right: f64 = moments
            .as_slice()
            .iter()
            .zip(beta.as_slice())
            .map(|(a, b)| a * b)
            .sum();
        assert!((left - right).abs() <= 1e-11 * (1.0 + left.abs()));
    }
}
