//! Synthesis and analysis on rings that come in mirrored pairs, with fast Fourier transforms.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::fft::{Complex, Fft, LANES, smooth_length};
use crate::legendre::Legendre;
use crate::rings::{Pairs, add_analysis, add_up, by_order, by_position, order_start, synthesis};

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
    let legendre = Legendre::new(beta.len().isqrt() - 1);
    let fft = Fft::new(longitudes);
    let beta = &by_order(beta);
    let count = rings.len().div_ceil(2);
    let blocks: Vec<Vec<Complex>> = (0..count.div_ceil(LANES))
        .into_par_iter()
        .map(|block| {
            Arch::new().dispatch(ToRings {
                legendre: &legendre,
                fft: &fft,
                pairs: pairs(rings, block * LANES),
                beta,
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
    let legendre = Legendre::new(degree);
    let fft = Fft::new(longitudes);
    let count = rings.len().div_ceil(2);
    let unknowns = order_start(degree, degree + 1);
    let parts: Vec<Vec<[f64; 2]>> = (0..count.div_ceil(LANES))
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
            let mut beta = vec![[0.0; 2]; unknowns];
            Arch::new().dispatch(FromRings {
                legendre: &legendre,
                fft: &fft,
                pairs: pairs(rings, first),
                beta: &mut beta,
                data: &mut data,
            });
            beta
        })
        .collect();
    by_position(&add_up(&parts, unknowns), degree)
}

struct ToRings<'a> {
    legendre: &'a Legendre,
    fft: &'a Fft,
    pairs: Pairs,
    beta: &'a [[f64; 2]],
}

impl WithSimd for ToRings<'_> {
    type Output = Vec<Complex>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Vec<Complex> {
        let mut values = vec![Complex::ZERO; self.fft.length()];
        let mut scratch = values.clone();
        synthesis(
            self.legendre,
            self.fft,
            &self.pairs,
            self.beta,
            &mut values,
            &mut scratch,
        );
        values
    }
}

struct FromRings<'a> {
    legendre: &'a Legendre,
    fft: &'a Fft,
    pairs: Pairs,
    beta: &'a mut [[f64; 2]],
    data: &'a mut [Complex],
}

impl WithSimd for FromRings<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let mut scratch = vec![Complex::ZERO; self.fft.length()];
        add_analysis(
            self.legendre,
            self.fft,
            &self.pairs,
            self.beta,
            self.data,
            &mut scratch,
        );
    }
}
