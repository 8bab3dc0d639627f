//! Synthesis and analysis on rings that come in mirrored pairs, with fast Fourier transforms.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::fft::{Complex, Fft, LANES, smooth_length};
use crate::ring_pairs::{RingPairs, add_analysis, add_up, synthesis};
use crate::two_step::{Folded, TwoStep};

/// Whether the functions below apply. Ring j must be the mirror image of ring n−1−j, and there must
/// be more than 2L longitudes, a number whose prime factors are 2, 3 and 5 only.
pub(crate) fn suits(rings: &[(f64, f64)], longitudes: usize, degree: usize) -> bool {
    let mirrored = rings
        .iter()
        .zip(rings.iter().rev())
        .all(|(a, b)| (a.1 + b.1).abs() <= 1e-15);
    mirrored && longitudes > 2 * degree && smooth_length(longitudes) == longitudes
}

/// Eight pairs of rings from pair number `first` on; lanes without a pair hold the equator.
fn pairs(rings: &[(f64, f64)], first: usize) -> RingPairs {
    let mut out = RingPairs {
        z: [0.0; LANES],
        sin: [1.0; LANES],
    };
    for lane in 0..LANES.min(rings.len().div_ceil(2) - first) {
        (out.sin[lane], out.z[lane]) = rings[first + lane];
    }
    out
}

/// Values of Σ β Y, ring after ring.
pub(crate) fn to_rings(rings: &[(f64, f64)], longitudes: usize, beta: &[f64]) -> Vec<f64> {
    let two_step = TwoStep::new(beta.len().isqrt() - 1);
    let fft = Fft::new(longitudes);
    let folded = &two_step.fold(beta);
    let count = rings.len().div_ceil(2);
    let blocks: Vec<Vec<Complex>> = (0..count.div_ceil(LANES))
        .into_par_iter()
        .map(|block| {
            Arch::new().dispatch(ToRings {
                two_step: &two_step,
                fft: &fft,
                pairs: pairs(rings, block * LANES),
                folded,
            })
        })
        .collect();
    let mut values = vec![0.0; rings.len() * longitudes];
    values
        .par_chunks_mut(longitudes)
        .enumerate()
        .for_each(|(j, row)| {
            let pair = j.min(rings.len() - 1 - j);
            let lane = pair % LANES;
            for (value, element) in row.iter_mut().zip(&blocks[pair / LANES]) {
                *value = if j == pair {
                    element.re[lane]
                } else {
                    element.im[lane]
                };
            }
        });
    values
}

/// Σ weight · value · Y over the grid; one weight per ring.
pub(crate) fn from_rings(
    rings: &[(f64, f64)],
    weights: &[f64],
    longitudes: usize,
    values: &[f64],
    degree: usize,
) -> Vec<f64> {
    let two_step = TwoStep::new(degree);
    let fft = Fft::new(longitudes);
    let count = rings.len().div_ceil(2);
    let parts: Vec<Vec<Folded>> = (0..count.div_ceil(LANES))
        .into_par_iter()
        .map(|block| {
            let first = block * LANES;
            let mut data = vec![Complex::ZERO; longitudes];
            for lane in 0..LANES.min(count - first) {
                let (north, south) = (first + lane, rings.len() - 1 - first - lane);
                let row = |j: usize| &values[j * longitudes..(j + 1) * longitudes];
                for (element, v) in data.iter_mut().zip(row(north)) {
                    element.re[lane] = weights[north] * v;
                }
                if south != north {
                    for (element, v) in data.iter_mut().zip(row(south)) {
                        element.im[lane] = weights[south] * v;
                    }
                }
            }
            let mut folded = vec![[0.0; 4]; two_step.len()];
            Arch::new().dispatch(FromRings {
                two_step: &two_step,
                fft: &fft,
                pairs: pairs(rings, first),
                folded: &mut folded,
                data: &mut data,
            });
            folded
        })
        .collect();
    two_step.unfold(&add_up(&parts, two_step.len()))
}

struct ToRings<'a> {
    two_step: &'a TwoStep,
    fft: &'a Fft,
    pairs: RingPairs,
    folded: &'a [Folded],
}

impl WithSimd for ToRings<'_> {
    type Output = Vec<Complex>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Vec<Complex> {
        let mut values = vec![Complex::ZERO; self.fft.length()];
        let mut scratch = values.clone();
        synthesis::<S>(
            self.two_step,
            self.fft,
            &self.pairs,
            self.folded,
            &mut values,
            &mut scratch,
        );
        values
    }
}

struct FromRings<'a> {
    two_step: &'a TwoStep,
    fft: &'a Fft,
    pairs: RingPairs,
    folded: &'a mut [Folded],
    data: &'a mut [Complex],
}

impl WithSimd for FromRings<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let mut scratch = vec![Complex::ZERO; self.fft.length()];
        add_analysis::<S>(
            self.two_step,
            self.fft,
            &self.pairs,
            self.folded,
            self.data,
            &mut scratch,
        );
    }
}
