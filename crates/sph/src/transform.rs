//! Synthesis and analysis on rings that come in mirrored pairs, with fast Fourier transforms.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::fft::{Complex, Fft, LANES, smooth_length};
use crate::ladder::{Ladder, Rung};
use crate::rings::{Pairs, add_analysis, add_up, synthesis};

/// Whether rings and longitudes suit the functions below: ring j mirrors ring n−1−j, and the
/// longitudes are a smooth number that tells all orders apart.
pub(crate) fn suits(rings: &[(f64, f64)], longitudes: usize, degree: usize) -> bool {
    let mirrored = rings
        .iter()
        .zip(rings.iter().rev())
        .all(|(a, b)| (a.1 + b.1).abs() <= 1e-15);
    mirrored && longitudes > 2 * degree && smooth_length(longitudes) == longitudes
}

/// Eight pairs of rings from pair number `first` on; missing ones stand on the equator.
fn pairs(rings: &[(f64, f64)], first: usize) -> Pairs {
    let mut out = Pairs {
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
    let ladder = Ladder::new(beta.len().isqrt() - 1);
    let fft = Fft::new(longitudes);
    let rungs = &ladder.fold(beta);
    let count = rings.len().div_ceil(2);
    let blocks: Vec<Vec<Complex>> = (0..count.div_ceil(LANES))
        .into_par_iter()
        .map(|block| {
            Arch::new().dispatch(ToRings {
                ladder: &ladder,
                fft: &fft,
                pairs: pairs(rings, block * LANES),
                rungs,
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

/// Σ weight · value · Y over the grid; one weight a ring.
pub(crate) fn from_rings(
    rings: &[(f64, f64)],
    weights: &[f64],
    longitudes: usize,
    values: &[f64],
    degree: usize,
) -> Vec<f64> {
    let ladder = Ladder::new(degree);
    let fft = Fft::new(longitudes);
    let count = rings.len().div_ceil(2);
    let parts: Vec<Vec<Rung>> = (0..count.div_ceil(LANES))
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
            let mut rungs = vec![[0.0; 4]; ladder.len()];
            Arch::new().dispatch(FromRings {
                ladder: &ladder,
                fft: &fft,
                pairs: pairs(rings, first),
                rungs: &mut rungs,
                data: &mut data,
            });
            rungs
        })
        .collect();
    ladder.unfold(&add_up(&parts, ladder.len()))
}

struct ToRings<'a> {
    ladder: &'a Ladder,
    fft: &'a Fft,
    pairs: Pairs,
    rungs: &'a [Rung],
}

impl WithSimd for ToRings<'_> {
    type Output = Vec<Complex>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Vec<Complex> {
        let mut values = vec![Complex::ZERO; self.fft.length()];
        let mut scratch = values.clone();
        synthesis::<S>(
            self.ladder,
            self.fft,
            &self.pairs,
            self.rungs,
            &mut values,
            &mut scratch,
        );
        values
    }
}

struct FromRings<'a> {
    ladder: &'a Ladder,
    fft: &'a Fft,
    pairs: Pairs,
    rungs: &'a mut [Rung],
    data: &'a mut [Complex],
}

impl WithSimd for FromRings<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let mut scratch = vec![Complex::ZERO; self.fft.length()];
        add_analysis::<S>(
            self.ladder,
            self.fft,
            &self.pairs,
            self.rungs,
            self.data,
            &mut scratch,
        );
    }
}
