//! Sums over all harmonics at many scattered points by a non-uniform Fourier transform.
//!
//! Same sums as [`crate::batch`], at a cost that hardly grows with the degree: the harmonics are
//! summed on a grid of the doubled torus, and each point reads (or writes) its grid neighbours
//! through a window. Bands of rows have one owner each and are merged in order, so results do not
//! depend on the number of threads.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::coefficients::Coefficients;
use crate::direction::Direction;
use crate::index;
use crate::kernel::TAPS;
use crate::torus::{Torus, TorusGrid};

/// Taps for sums to about 1e-14 of the largest value.
const WIDTH: usize = 16;
const OVERSAMPLING: f64 = 2.0;
/// Points handled by one task.
const CHUNK: usize = 2048;
/// Rows owned by one task.
const BAND: usize = 24;

/// Points of the sphere, prepared for repeated sums.
#[derive(Clone, Debug)]
pub struct Scattered {
    /// (θ, φ) in turns around their circles, [0, ½] and [0, 1).
    turns: Vec<[f64; 2]>,
    /// Positions in the caller's list, by growing θ to the accuracy of a band.
    order: Vec<u32>,
}

impl Scattered {
    /// Angles of all points, and their order. At most 2³² points.
    pub fn new(directions: &[Direction]) -> Self {
        let angles: Vec<[f64; 2]> = directions.par_iter().map(turns).collect();
        const BUCKETS: usize = 1024;
        let bucket = |t: &[f64; 2]| ((t[0] * 2.0 * BUCKETS as f64) as usize).min(BUCKETS - 1);
        let mut starts = vec![0_usize; BUCKETS + 1];
        for t in &angles {
            starts[bucket(t) + 1] += 1;
        }
        for b in 0..BUCKETS {
            starts[b + 1] += starts[b];
        }
        let mut order = vec![0_u32; angles.len()];
        for (i, t) in angles.iter().enumerate() {
            let slot = &mut starts[bucket(t)];
            order[*slot] = i as u32;
            *slot += 1;
        }
        let turns = order.iter().map(|&i| angles[i as usize]).collect();
        Self { turns, order }
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
    /// Errors are about 1e-14 of the largest |f|. About 600 flops a point and L³ for the grid.
    pub fn evaluate(&self, beta: &Coefficients) -> Vec<f64> {
        let torus = Torus::new(beta.degree(), WIDTH, OVERSAMPLING);
        let grid = torus.synthesis(beta.as_slice());
        let mut sorted = vec![0.0; self.len()];
        sorted
            .par_chunks_mut(CHUNK)
            .zip(self.turns.par_chunks(CHUNK))
            .for_each(|(out, turns)| {
                Arch::new().dispatch(Interpolate {
                    torus: &torus,
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
    /// `weights` has one entry a point.
    pub fn moments(&self, weights: &[f64], degree: usize) -> Coefficients {
        assert_eq!(self.len(), weights.len(), "one weight a point");
        let torus = Torus::new(degree, WIDTH, OVERSAMPLING);
        let grid = self.spread(&torus, weights);
        let mut out = Coefficients::zeros(degree);
        out.as_mut_slice().copy_from_slice(&torus.analysis(grid));
        debug_assert_eq!(out.as_slice().len(), index::count(degree));
        out
    }

    /// Every point's weight, spread over its grid neighbours.
    fn spread(&self, torus: &Torus, weights: &[f64]) -> TorusGrid {
        let (stride, width, n) = (torus.stride(), torus.kernel().width(), torus.steps());
        let owned = n / 2 + 1;
        // First point of every band; the buckets of the order are not bands, so points are
        // assigned one by one.
        let mut bands: Vec<Vec<u32>> = vec![Vec::new(); owned.div_ceil(BAND)];
        for (slot, t) in self.turns.iter().enumerate() {
            bands[cell(t, n).0[0] / BAND].push(slot as u32);
        }
        let parts: Vec<Vec<f64>> = bands
            .par_iter()
            .enumerate()
            .map(|(band, members)| {
                let mut values = vec![0.0; (BAND + width) * stride];
                Arch::new().dispatch(Spread {
                    torus,
                    points: self,
                    members,
                    weights,
                    first: band * BAND,
                    values: &mut values,
                });
                values
            })
            .collect();
        let mut values = vec![0.0; torus.rows() * stride];
        for (band, part) in parts.iter().enumerate() {
            let start = band * BAND * stride;
            for (sum, p) in values[start..].iter_mut().zip(part) {
                *sum += p;
            }
        }
        TorusGrid { values }
    }
}

/// θ and φ in turns.
fn turns(p: &Direction) -> [f64; 2] {
    let theta = p.x.hypot(p.y).atan2(p.z) / std::f64::consts::TAU;
    let phi = p.y.atan2(p.x) / std::f64::consts::TAU;
    [theta, if phi < 0.0 { phi + 1.0 } else { phi }]
}

/// Row and column of the grid point at or below a place on an n×n torus, and the way past it less ½.
#[inline(always)]
fn cell(turns: &[f64; 2], n: usize) -> ([usize; 2], [f64; 2]) {
    let x = turns[0] * n as f64;
    let y = turns[1] * n as f64;
    // Rounding may bring φ to one whole turn; the last column then serves with u = ½.
    let row = (x as usize).min(n / 2);
    let column = (y as usize).min(n - 1);
    (
        [row, column],
        [x - row as f64 - 0.5, y - column as f64 - 0.5],
    )
}

struct Interpolate<'a> {
    torus: &'a Torus,
    grid: &'a TorusGrid,
    turns: &'a [[f64; 2]],
    out: &'a mut [f64],
}

impl WithSimd for Interpolate<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let (n, stride, width) = (
            self.torus.steps(),
            self.torus.stride(),
            self.torus.kernel().width(),
        );
        for (turns, out) in self.turns.iter().zip(self.out) {
            let ([row, column], [u, v]) = cell(turns, n);
            let along_theta = self.torus.kernel().weights(u);
            let along_phi = self.torus.kernel().weights(v);
            let mut sums = [0.0; TAPS];
            for (tap, factor) in along_theta.iter().enumerate().take(width) {
                let at = (row + tap) * stride + column;
                let values = &self.grid.values[at..at + TAPS];
                for k in 0..TAPS {
                    sums[k] += factor * values[k];
                }
            }
            let mut total = 0.0;
            for k in 0..TAPS {
                total += sums[k] * along_phi[k];
            }
            *out = total;
        }
    }
}

struct Spread<'a> {
    torus: &'a Torus,
    points: &'a Scattered,
    members: &'a [u32],
    weights: &'a [f64],
    /// First row of the band.
    first: usize,
    values: &'a mut [f64],
}

impl WithSimd for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let (n, stride, width) = (
            self.torus.steps(),
            self.torus.stride(),
            self.torus.kernel().width(),
        );
        for &slot in self.members {
            let slot = slot as usize;
            let ([row, column], [u, v]) = cell(&self.points.turns[slot], n);
            let along_theta = self.torus.kernel().weights(u);
            let mut along_phi = self.torus.kernel().weights(v);
            let weight = self.weights[self.points.order[slot] as usize];
            for p in &mut along_phi {
                *p *= weight;
            }
            for (tap, factor) in along_theta.iter().enumerate().take(width) {
                let at = (row - self.first + tap) * stride + column;
                let values = &mut self.values[at..at + TAPS];
                for k in 0..TAPS {
                    values[k] += factor * along_phi[k];
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
