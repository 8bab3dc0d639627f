//! Multiplication by a function on the sphere followed by projection to degree L, without a matrix.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::coefficients::Coefficients;
use crate::fft::{Complex, Fft, LANES, smooth_length};
use crate::grid::gauss_legendre;
use crate::ring_pairs::{RingPairs, add_analysis, add_up, synthesis};
use crate::two_step::{Folded, TwoStep};

/// Number of blocks of [`LANES`] pairs of rings per task. It is fixed, so that sums do not depend
/// on the number of threads.
const BLOCKS_PER_TASK: usize = 4;

/// b ↦ Sᵀ diag(ω g) S b with S the degree-L synthesis on a Gauss–Legendre grid: the coefficients up
/// to degree L of g times the function b, whenever the grid is exact for their product.
pub(super) struct Multiplier {
    two_step: TwoStep,
    fft: Fft,
    blocks: Vec<RingPairs>,
    /// ω g of every block, longitude after longitude; north real, south imaginary.
    factors: Vec<Complex>,
}

impl Multiplier {
    /// Multiplication by `change(g)` with g given by coefficients of degree at most `longitudes`/2.
    ///
    /// The grid has `rings` Gauss–Legendre rings and at least `longitudes` longitudes.
    pub(super) fn new(
        degree: usize,
        rings: usize,
        longitudes: usize,
        g: &Coefficients,
        change: impl Fn(f64) -> f64,
    ) -> Self {
        let fft = Fft::new(smooth_length(longitudes.max(2 * g.degree() + 1)));
        let n = fft.length();
        let (blocks, weights) = ring_pairs(rings);
        let two_step = TwoStep::new(g.degree());
        let folded = two_step.fold(g.as_slice());
        let mut factors = vec![Complex::ZERO; blocks.len() * n];
        for ((pairs, weights), factors) in blocks.iter().zip(&weights).zip(factors.chunks_mut(n)) {
            Arch::new().dispatch(Synthesis {
                two_step: &two_step,
                fft: &fft,
                pairs,
                folded: &folded,
                values: factors,
            });
            let cell = std::f64::consts::TAU / n as f64;
            for factor in factors {
                for k in 0..LANES {
                    factor.re[k] = cell * weights.re[k] * change(factor.re[k]);
                    factor.im[k] = cell * weights.im[k] * change(factor.im[k]);
                }
            }
        }
        Self {
            two_step: TwoStep::new(degree),
            fft,
            blocks,
            factors,
        }
    }

    /// The product's coefficients. About 6·rings·L² flops and two Fourier transforms per ring.
    pub(super) fn apply(&self, beta: &[f64]) -> Vec<f64> {
        let n = self.fft.length();
        let folded = &self.two_step.fold(beta);
        let tasks = self.blocks.par_chunks(BLOCKS_PER_TASK);
        let parts: Vec<Vec<Folded>> = tasks
            .zip(self.factors.par_chunks(BLOCKS_PER_TASK * n))
            .map(|(blocks, factors)| {
                let mut out = vec![[0.0; 4]; folded.len()];
                Arch::new().dispatch(Apply {
                    operator: self,
                    blocks,
                    factors,
                    folded,
                    out: &mut out,
                });
                out
            })
            .collect();
        self.two_step.unfold(&add_up(&parts, self.two_step.len()))
    }
}

/// Gauss–Legendre rings in mirrored pairs, and their weights (north real, south imaginary).
fn ring_pairs(rings: usize) -> (Vec<RingPairs>, Vec<Complex>) {
    let (nodes, weights) = gauss_legendre(rings);
    let pairs = rings.div_ceil(2);
    let blocks = pairs.div_ceil(LANES);
    let mut places = Vec::with_capacity(blocks);
    let mut shares = Vec::with_capacity(blocks);
    for b in 0..blocks {
        // Lanes beyond the last pair hold the equator with weight zero.
        let mut place = RingPairs {
            z: [0.0; LANES],
            sin: [1.0; LANES],
        };
        let mut share = Complex::ZERO;
        for k in 0..LANES.min(pairs - b * LANES) {
            let j = b * LANES + k;
            let z = nodes[j];
            place.z[k] = z;
            place.sin[k] = ((1.0 - z) * (1.0 + z)).sqrt();
            share.re[k] = weights[j];
            // The equator is its own mirror image and is counted once.
            share.im[k] = if 2 * j + 1 == rings { 0.0 } else { weights[j] };
        }
        places.push(place);
        shares.push(share);
    }
    (places, shares)
}

struct Synthesis<'a> {
    two_step: &'a TwoStep,
    fft: &'a Fft,
    pairs: &'a RingPairs,
    folded: &'a [Folded],
    values: &'a mut [Complex],
}

impl WithSimd for Synthesis<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let mut scratch = vec![Complex::ZERO; self.fft.length()];
        synthesis::<S>(
            self.two_step,
            self.fft,
            self.pairs,
            self.folded,
            self.values,
            &mut scratch,
        );
    }
}

struct Apply<'a> {
    operator: &'a Multiplier,
    blocks: &'a [RingPairs],
    factors: &'a [Complex],
    folded: &'a [Folded],
    out: &'a mut [Folded],
}

impl WithSimd for Apply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let (two_step, fft) = (&self.operator.two_step, &self.operator.fft);
        let n = fft.length();
        let mut values = vec![Complex::ZERO; n];
        let mut scratch = vec![Complex::ZERO; n];
        for (pairs, factors) in self.blocks.iter().zip(self.factors.chunks(n)) {
            synthesis::<S>(two_step, fft, pairs, self.folded, &mut values, &mut scratch);
            for (value, factor) in values.iter_mut().zip(factors) {
                for k in 0..LANES {
                    value.re[k] *= factor.re[k];
                    value.im[k] *= factor.im[k];
                }
            }
            add_analysis::<S>(two_step, fft, pairs, self.out, &mut values, &mut scratch);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch;
    use crate::direction::even_directions;

    #[test]
    fn the_density_of_points_multiplies_as_the_points_do() {
        for degree in [0, 1, 5, 20] {
            let points = even_directions(70);
            let ones = vec![1.0; points.len()];
            let density = batch::moments(&points, &ones, 2 * degree);
            let operator = Multiplier::new(degree, 2 * degree + 1, 4 * degree + 1, &density, |g| g);
            let mut beta = Coefficients::zeros(degree);
            for (i, b) in beta.as_mut_slice().iter_mut().enumerate() {
                *b = (i as f64 * 0.9).sin();
            }
            let values = batch::evaluate(&beta, &points);
            let plain = batch::moments(&points, &values, degree);
            let found = operator.apply(beta.as_slice());
            for (a, b) in found.iter().zip(plain.as_slice()) {
                assert!((a - b).abs() <= 1e-10, "L={degree}: {a} {b}");
            }
        }
    }
}
