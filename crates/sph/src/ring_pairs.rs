//! Synthesis and analysis on pairs of mirrored rings, eight pairs at a time.
//!
//! A pair is the ring at z and the ring at −z. A harmonic is even or odd in z as l − m is, so one
//! recurrence serves both rings. The two real rings are the real and imaginary part of one complex
//! sequence, so one Fourier transform serves both as well.

use pulp::Simd;

use crate::fft::{Complex, Fft, LANES, Sign};
use crate::lanes::{Lanes, multiply};
use crate::multiply_add::multiply_add;
use crate::two_step::{Folded, TwoStep};

/// Eight numbers, one per pair of rings.
pub(crate) type Lane = Lanes<LANES>;

/// z and sin θ of the northern rings of eight pairs at ±z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RingPairs {
    pub(crate) z: Lane,
    pub(crate) sin: Lane,
}

/// Σ_l β_{l,±m} P̄_l^m on eight pairs: cosine and sine parts, north and south.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OrderValues {
    pub(crate) cos: [Lane; 2],
    pub(crate) sin: [Lane; 2],
}

/// The sum of the vectors in the given order.
pub(crate) fn add_up(parts: &[Vec<Folded>], length: usize) -> Vec<Folded> {
    let mut sum = vec![[0.0; 4]; length];
    for part in parts {
        for (s, p) in sum.iter_mut().zip(part) {
            for k in 0..4 {
                s[k] += p[k];
            }
        }
    }
    sum
}

/// The sums over l of one order. `power` is sinᵐθ; `folded` holds all orders ([`TwoStep::fold`]).
#[inline(always)]
pub(crate) fn order_sums<S: Simd>(
    two_step: &TwoStep,
    m: usize,
    z: &Lane,
    power: &Lane,
    folded: &[Folded],
) -> OrderValues {
    let folded = &folded[two_step.range(m)];
    let (first, steps) = two_step.recurrence(m);
    let square = squares(z);
    let mut sums = [[0.0; LANES]; 4];
    let (mut before, mut here) = ([0.0; LANES], *power);
    for h in &mut here {
        *h *= first;
    }
    let mut pairs = steps.chunks_exact(2).zip(folded.chunks_exact(2));
    for (steps, folded) in &mut pairs {
        add_scaled::<S>(&mut sums, &here, &folded[0]);
        step::<S>(&mut before, &here, &square, steps[0]);
        add_scaled::<S>(&mut sums, &before, &folded[1]);
        step::<S>(&mut here, &before, &square, steps[1]);
    }
    if folded.len() % 2 == 1 {
        add_scaled::<S>(&mut sums, &here, &folded[folded.len() - 1]);
    }
    let mut out = OrderValues {
        cos: [[0.0; LANES]; 2],
        sin: [[0.0; LANES]; 2],
    };
    for k in 0..LANES {
        out.cos[0][k] = multiply_add::<S>(z[k], sums[2][k], sums[0][k]);
        out.cos[1][k] = multiply_add::<S>(-z[k], sums[2][k], sums[0][k]);
        out.sin[0][k] = multiply_add::<S>(z[k], sums[3][k], sums[1][k]);
        out.sin[1][k] = multiply_add::<S>(-z[k], sums[3][k], sums[1][k]);
    }
    out
}

/// The adjoint of [`order_sums`]: adds Σ_rings value · q_k to `folded`, for [`TwoStep::unfold`].
#[inline(always)]
pub(crate) fn add_order<S: Simd>(
    two_step: &TwoStep,
    m: usize,
    z: &Lane,
    power: &Lane,
    values: &OrderValues,
    folded: &mut [Folded],
) {
    let folded = &mut folded[two_step.range(m)];
    let (first, steps) = two_step.recurrence(m);
    let square = squares(z);
    let (mut before, mut here) = ([0.0; LANES], *power);
    for h in &mut here {
        *h *= first;
    }
    let mut parts = [[0.0; 4]; LANES];
    for (k, part) in parts.iter_mut().enumerate() {
        part[0] = values.cos[0][k] + values.cos[1][k];
        part[1] = values.sin[0][k] + values.sin[1][k];
        part[2] = z[k] * (values.cos[0][k] - values.cos[1][k]);
        part[3] = z[k] * (values.sin[0][k] - values.sin[1][k]);
    }
    let odd = folded.len() % 2 == 1;
    let mut pairs = steps.chunks_exact(2).zip(folded.chunks_exact_mut(2));
    for (steps, folded) in &mut pairs {
        add_dots::<S>(&mut folded[0], &parts, &here);
        step::<S>(&mut before, &here, &square, steps[0]);
        add_dots::<S>(&mut folded[1], &parts, &before);
        step::<S>(&mut here, &before, &square, steps[1]);
    }
    if let (true, Some(last)) = (odd, folded.last_mut()) {
        add_dots::<S>(last, &parts, &here);
    }
}

#[inline(always)]
fn squares(z: &Lane) -> Lane {
    let mut out = [0.0; LANES];
    for k in 0..LANES {
        out[k] = z[k] * z[k];
    }
    out
}

/// before ← (a z² + b) here − before: `before` then holds the next q.
#[inline(always)]
fn step<S: Simd>(before: &mut Lane, here: &Lane, square: &Lane, (a, b): (f64, f64)) {
    for k in 0..LANES {
        let factor = multiply_add::<S>(a, square[k], b);
        before[k] = multiply_add::<S>(factor, here[k], -before[k]);
    }
}

#[inline(always)]
fn add_scaled<S: Simd>(sums: &mut [Lane; 4], values: &Lane, term: &Folded) {
    for (sum, factor) in sums.iter_mut().zip(term) {
        for k in 0..LANES {
            sum[k] = multiply_add::<S>(values[k], *factor, sum[k]);
        }
    }
}

/// Adds Σ_k parts[k] values[k]. The four parts of a lane are in one register, so no sum across the
/// lanes of a register is needed.
#[inline(always)]
fn add_dots<S: Simd>(term: &mut Folded, parts: &[Folded; LANES], values: &Lane) {
    let mut sums = [*term, [0.0; 4]];
    for (k, part) in parts.iter().enumerate() {
        let sum = &mut sums[k % 2];
        for j in 0..4 {
            sum[j] = multiply_add::<S>(part[j], values[k], sum[j]);
        }
    }
    for j in 0..4 {
        term[j] = sums[0][j] + sums[1][j];
    }
}

/// Values of Σ β Y on eight pairs of rings: north real, south imaginary, one element per longitude.
#[inline(always)]
pub(crate) fn synthesis<S: Simd>(
    two_step: &TwoStep,
    fft: &Fft,
    pairs: &RingPairs,
    folded: &[Folded],
    values: &mut [Complex],
    scratch: &mut [Complex],
) {
    let n = fft.length();
    values.fill(Complex::ZERO);
    let mut power = [1.0; LANES];
    for m in 0..=two_step.degree() {
        let sums = order_sums::<S>(two_step, m, &pairs.z, &power, folded);
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

/// The adjoint of [`synthesis`]: adds Σ value · Y over the rings to `folded`; `values` is overwritten.
#[inline(always)]
pub(crate) fn add_analysis<S: Simd>(
    two_step: &TwoStep,
    fft: &Fft,
    pairs: &RingPairs,
    folded: &mut [Folded],
    values: &mut [Complex],
    scratch: &mut [Complex],
) {
    let n = fft.length();
    fft.run(Sign::Minus, values, scratch);
    let mut power = [1.0; LANES];
    for m in 0..=two_step.degree() {
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
        add_order::<S>(two_step, m, &pairs.z, &power, &sums, folded);
        multiply(&mut power, &pairs.sin);
    }
}
