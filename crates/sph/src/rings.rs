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

/// The sums over l of one order. `power` is sinᵐθ.
#[inline(always)]
pub(crate) fn order_sums(
    legendre: &Legendre,
    m: usize,
    z: &Lane,
    power: &Lane,
    beta: &[f64],
) -> OrderValues {
    let (first, steps) = legendre.recurrence(m);
    let mut sums = [[[0.0; LANES]; 2]; 2];
    let (mut before, mut here) = ([0.0; LANES], *power);
    for h in &mut here {
        *h *= first;
    }
    let mut centre = m * m + m;
    add_scaled(&mut sums[0], &here, beta[centre + m], beta[centre - m]);
    let mut l = m + 1;
    let mut pairs = steps.chunks_exact(2);
    for pair in &mut pairs {
        centre += 2 * l;
        step(&mut before, &mut here, z, pair[0]);
        add_scaled(&mut sums[1], &before, beta[centre + m], beta[centre - m]);
        centre += 2 * (l + 1);
        step(&mut here, &mut before, z, pair[1]);
        add_scaled(&mut sums[0], &here, beta[centre + m], beta[centre - m]);
        l += 2;
    }
    if let [last] = pairs.remainder() {
        centre += 2 * l;
        step(&mut before, &mut here, z, *last);
        add_scaled(&mut sums[1], &before, beta[centre + m], beta[centre - m]);
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
    beta: &mut [f64],
) {
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
    let mut centre = m * m + m;
    beta[centre + m] += dot(&parts[0][0], &here);
    if m > 0 {
        beta[centre - m] += dot(&parts[0][1], &here);
    }
    for (l, (&constants, parity)) in (m + 1..).zip(steps.iter().zip([1, 0].into_iter().cycle())) {
        centre += 2 * l;
        step(&mut before, &mut here, z, constants);
        std::mem::swap(&mut before, &mut here);
        beta[centre + m] += dot(&parts[parity][0], &here);
        if m > 0 {
            beta[centre - m] += dot(&parts[parity][1], &here);
        }
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
fn add_scaled(sums: &mut [Lane; 2], values: &Lane, cos: f64, sin: f64) {
    for k in 0..LANES {
        sums[0][k] += values[k] * cos;
        sums[1][k] += values[k] * sin;
    }
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
    beta: &[f64],
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
    beta: &mut [f64],
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
