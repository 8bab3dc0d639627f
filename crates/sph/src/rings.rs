//! Sums over degrees and longitudes on pairs of mirrored rings, eight pairs at a time.
//!
//! A pair is the ring at z and the ring at −z. Harmonics are even or odd in z with l − m, so one
//! recurrence serves both; and the two real rings are the real and imaginary part of one complex
//! sequence, so one Fourier transform serves both.

use crate::fft::{Complex, Fft, LANES, Sign};
use crate::legendre::Legendre;

/// Eight numbers, one a pair of rings.
pub(crate) type Lane = [f64; LANES];

/// Eight pairs of rings at ±z; sin θ beside it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pairs {
    pub(crate) z: Lane,
    pub(crate) sin: Lane,
}

/// Σ_l β_{l,±m} P̄_l^m on eight pairs: cosine and sine parts, north and south.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OrderValues {
    pub(crate) cos: [Lane; 2],
    pub(crate) sin: [Lane; 2],
}

/// Coefficients order by order: [β_{l,m}, β_{l,−m}] for l = m … L, so that sums over l run through
/// memory in order. The second of the pair is zero for m = 0.
pub(crate) fn by_order(beta: &[f64]) -> Vec<[f64; 2]> {
    let degree = beta.len().isqrt() - 1;
    let mut out = Vec::with_capacity((degree + 1) * (degree + 2) / 2);
    for m in 0..=degree {
        for l in m..=degree {
            let centre = l * l + l;
            let sin = if m == 0 { 0.0 } else { beta[centre - m] };
            out.push([beta[centre + m], sin]);
        }
    }
    out
}

/// The inverse of [`by_order`]; what stands beside m = 0 is ignored.
pub(crate) fn by_position(pairs: &[[f64; 2]], degree: usize) -> Vec<f64> {
    let mut out = vec![0.0; crate::index::count(degree)];
    let mut pairs = pairs.iter();
    for m in 0..=degree {
        for (l, &[cos, sin]) in (m..=degree).zip(&mut pairs) {
            let centre = l * l + l;
            out[centre + m] = cos;
            if m > 0 {
                out[centre - m] = sin;
            }
        }
    }
    out
}

/// The sum of vectors, in their order.
pub(crate) fn add_up(parts: &[Vec<[f64; 2]>], length: usize) -> Vec<[f64; 2]> {
    let mut sum = vec![[0.0; 2]; length];
    for part in parts {
        for (s, p) in sum.iter_mut().zip(part) {
            s[0] += p[0];
            s[1] += p[1];
        }
    }
    sum
}

/// Where order m begins in [`by_order`].
#[inline(always)]
pub(crate) fn order_start(degree: usize, m: usize) -> usize {
    // Σ_{k<m} (L + 1 − k), written without a negative intermediate.
    m * (2 * degree + 3 - m) / 2
}

/// The sums over l of one order. `power` is sinᵐθ; `beta` is ordered as by [`by_order`].
#[inline(always)]
pub(crate) fn order_sums(
    legendre: &Legendre,
    m: usize,
    z: &Lane,
    power: &Lane,
    beta: &[[f64; 2]],
) -> OrderValues {
    let start = order_start(legendre.degree(), m);
    let beta = &beta[start..start + legendre.degree() + 1 - m];
    let (first, steps) = legendre.recurrence(m);
    let mut sums = [[[0.0; LANES]; 2]; 2];
    let (mut before, mut here) = ([0.0; LANES], *power);
    for h in &mut here {
        *h *= first;
    }
    let (lowest, rest) = beta.split_at(1);
    add_scaled(&mut sums[0], &here, lowest[0]);
    let mut pairs = steps.chunks_exact(2).zip(rest.chunks_exact(2));
    for (step_pair, beta) in &mut pairs {
        step(&mut before, &mut here, z, step_pair[0]);
        add_scaled(&mut sums[1], &before, beta[0]);
        step(&mut here, &mut before, z, step_pair[1]);
        add_scaled(&mut sums[0], &here, beta[1]);
    }
    if rest.len() % 2 == 1 {
        let last = rest.len() - 1;
        step(&mut before, &mut here, z, steps[last]);
        add_scaled(&mut sums[1], &before, rest[last]);
    }
    let [even, odd] = sums;
    let mut out = OrderValues {
        cos: [[0.0; LANES]; 2],
        sin: [[0.0; LANES]; 2],
    };
    for k in 0..LANES {
        out.cos[0][k] = even[0][k] + odd[0][k];
        out.cos[1][k] = even[0][k] - odd[0][k];
        out.sin[0][k] = even[1][k] + odd[1][k];
        out.sin[1][k] = even[1][k] - odd[1][k];
    }
    out
}

/// The adjoint of [`order_sums`]: adds Σ_rings value · P̄_l^m to `beta`.
#[inline(always)]
pub(crate) fn add_order(
    legendre: &Legendre,
    m: usize,
    z: &Lane,
    power: &Lane,
    values: &OrderValues,
    beta: &mut [[f64; 2]],
) {
    let start = order_start(legendre.degree(), m);
    let beta = &mut beta[start..start + legendre.degree() + 1 - m];
    let (first, steps) = legendre.recurrence(m);
    let (mut before, mut here) = ([0.0; LANES], *power);
    for h in &mut here {
        *h *= first;
    }
    let mut parts = [[[0.0; LANES]; 2]; 2];
    for k in 0..LANES {
        parts[0][0][k] = values.cos[0][k] + values.cos[1][k];
        parts[1][0][k] = values.cos[0][k] - values.cos[1][k];
        parts[0][1][k] = values.sin[0][k] + values.sin[1][k];
        parts[1][1][k] = values.sin[0][k] - values.sin[1][k];
    }
    let (lowest, rest) = beta.split_at_mut(1);
    add_dots(&mut lowest[0], &parts[0], &here);
    let mut pairs = steps.chunks_exact(2).zip(rest.chunks_exact_mut(2));
    for (step_pair, beta) in &mut pairs {
        step(&mut before, &mut here, z, step_pair[0]);
        add_dots(&mut beta[0], &parts[1], &before);
        step(&mut here, &mut before, z, step_pair[1]);
        add_dots(&mut beta[1], &parts[0], &here);
    }
    if rest.len() % 2 == 1 {
        let last = rest.len() - 1;
        step(&mut before, &mut here, z, steps[last]);
        add_dots(&mut rest[last], &parts[1], &before);
    }
}

/// before ← a z here − b before: the next degree stands in `before`.
#[inline(always)]
fn step(before: &mut Lane, here: &mut Lane, z: &Lane, (a, b): (f64, f64)) {
    for k in 0..LANES {
        before[k] = a * z[k] * here[k] - b * before[k];
    }
}

#[inline(always)]
fn add_scaled(sums: &mut [Lane; 2], values: &Lane, [cos, sin]: [f64; 2]) {
    for k in 0..LANES {
        sums[0][k] += values[k] * cos;
        sums[1][k] += values[k] * sin;
    }
}

#[inline(always)]
fn add_dots(sums: &mut [f64; 2], parts: &[Lane; 2], values: &Lane) {
    sums[0] += dot(&parts[0], values);
    sums[1] += dot(&parts[1], values);
}

#[inline(always)]
fn dot(a: &Lane, b: &Lane) -> f64 {
    let mut products = [0.0; LANES];
    for k in 0..LANES {
        products[k] = a[k] * b[k];
    }
    let mut half = [0.0; LANES / 2];
    for k in 0..LANES / 2 {
        half[k] = products[k] + products[k + LANES / 2];
    }
    (half[0] + half[2]) + (half[1] + half[3])
}

/// Values of Σ β Y on eight pairs of rings: north real, south imaginary, one element a longitude.
#[inline(always)]
pub(crate) fn synthesis(
    legendre: &Legendre,
    fft: &Fft,
    pairs: &Pairs,
    beta: &[[f64; 2]],
    values: &mut [Complex],
    scratch: &mut [Complex],
) {
    let n = fft.length();
    values.fill(Complex::ZERO);
    let mut power = [1.0; LANES];
    for m in 0..=legendre.degree() {
        let sums = order_sums(legendre, m, &pairs.z, &power, beta);
        if m == 0 {
            values[0].re = sums.cos[0];
            values[0].im = sums.cos[1];
        } else {
            let (north, south) = ([sums.cos[0], sums.sin[0]], [sums.cos[1], sums.sin[1]]);
            for k in 0..LANES {
                values[m].re[k] = 0.5 * (north[0][k] + south[1][k]);
                values[m].im[k] = 0.5 * (south[0][k] - north[1][k]);
                values[n - m].re[k] = 0.5 * (north[0][k] - south[1][k]);
                values[n - m].im[k] = 0.5 * (south[0][k] + north[1][k]);
            }
        }
        multiply(&mut power, &pairs.sin);
    }
    fft.run(Sign::Plus, values, scratch);
}

/// The adjoint of [`synthesis`]: adds Σ value · Y over the rings to `beta`; `values` is used up.
#[inline(always)]
pub(crate) fn add_analysis(
    legendre: &Legendre,
    fft: &Fft,
    pairs: &Pairs,
    beta: &mut [[f64; 2]],
    values: &mut [Complex],
    scratch: &mut [Complex],
) {
    let n = fft.length();
    fft.run(Sign::Minus, values, scratch);
    let mut power = [1.0; LANES];
    for m in 0..=legendre.degree() {
        let (up, down) = (&values[m], &values[(n - m) % n]);
        let mut sums = OrderValues {
            cos: [[0.0; LANES]; 2],
            sin: [[0.0; LANES]; 2],
        };
        for k in 0..LANES {
            sums.cos[0][k] = 0.5 * (up.re[k] + down.re[k]);
            sums.cos[1][k] = 0.5 * (up.im[k] + down.im[k]);
            sums.sin[0][k] = 0.5 * (down.im[k] - up.im[k]);
            sums.sin[1][k] = 0.5 * (up.re[k] - down.re[k]);
        }
        add_order(legendre, m, &pairs.z, &power, &sums, beta);
        multiply(&mut power, &pairs.sin);
    }
}

#[inline(always)]
pub(crate) fn multiply(a: &mut Lane, b: &Lane) {
    for k in 0..LANES {
        a[k] *= b[k];
    }
}
