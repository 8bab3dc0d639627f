//! Fast Fourier transforms of eight sequences at once, with one sequence per vector lane.
//!
//! Lengths are products of 2, 3 and 5. Everything is inlined into the caller, which runs inside a pulp
//! dispatch, so that an array of lanes becomes one or two vector registers.

use crate::lanes::Lanes;

/// Number of sequences transformed together.
pub(crate) const LANES: usize = 8;

/// One element of eight complex sequences.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Complex {
    pub(crate) re: Lanes<LANES>,
    pub(crate) im: Lanes<LANES>,
}

impl Complex {
    pub(crate) const ZERO: Self = Self {
        re: [0.0; LANES],
        im: [0.0; LANES],
    };
}

/// y_k = Σ_j x_j e^{±2πi jk/n}, unscaled.
#[derive(Clone, Debug)]
pub(crate) struct Fft {
    length: usize,
    /// Radix of every pass, in the order of the passes.
    radices: Vec<usize>,
    /// (cos, sin) of 2πj/n, j = 0 … n−1.
    twiddles: Vec<(f64, f64)>,
}

/// The sign of the exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sign {
    /// e^{−2πi jk/n}: from values to modes.
    Minus,
    /// e^{+2πi jk/n}: from modes to values.
    Plus,
}

/// The least even number ≥ `least` whose prime factors are 2, 3 and 5 only.
pub(crate) fn smooth_length(least: usize) -> usize {
    let smooth = |mut n: usize| {
        for p in [2, 3, 5] {
            while n.is_multiple_of(p) {
                n /= p;
            }
        }
        n == 1
    };
    let mut n = least.max(2).next_multiple_of(2);
    while !smooth(n) {
        n += 2;
    }
    n
}

impl Fft {
    /// A transform of a length whose prime factors are 2, 3 and 5 only.
    pub(crate) fn new(length: usize) -> Self {
        let mut rest = length;
        let mut radices = Vec::new();
        for radix in [4, 2, 3, 5] {
            while rest.is_multiple_of(radix) {
                radices.push(radix);
                rest /= radix;
            }
        }
        debug_assert_eq!(rest, 1, "length {length} has another factor");
        let step = std::f64::consts::TAU / length as f64;
        let twiddle = |j: usize| {
            let (sin, cos) = (step * j as f64).sin_cos();
            (cos, sin)
        };
        Self {
            length,
            radices,
            twiddles: (0..length).map(twiddle).collect(),
        }
    }

    /// n.
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// Transforms `data` in place; both slices have the transform's length.
    #[inline(always)]
    pub(crate) fn run(&self, sign: Sign, data: &mut [Complex], scratch: &mut [Complex]) {
        let flip = if sign == Sign::Plus { 1.0 } else { -1.0 };
        let (mut from, mut to) = (&mut data[..self.length], &mut scratch[..self.length]);
        let (mut rest, mut stride) = (self.length, 1);
        for &radix in &self.radices {
            let pass = Pass {
                twiddles: &self.twiddles,
                flip,
                part: rest / radix,
                stride,
            };
            match radix {
                4 => pass.run(from, to, four),
                2 => pass.run(from, to, two),
                3 => pass.run(from, to, three),
                _ => pass.run(from, to, five),
            }
            rest /= radix;
            stride *= radix;
            std::mem::swap(&mut from, &mut to);
        }
        if self.radices.len() % 2 == 1 {
            to.copy_from_slice(from);
        }
    }
}

/// One self-sorting (Stockham) pass.
struct Pass<'a> {
    twiddles: &'a [(f64, f64)],
    flip: f64,
    /// Length of the sequences after this pass.
    part: usize,
    /// Sequences interleaved before this pass.
    stride: usize,
}

impl Pass<'_> {
    #[inline(always)]
    fn run<const R: usize>(
        &self,
        from: &[Complex],
        to: &mut [Complex],
        butterfly: impl Fn([(f64, f64); R], f64) -> [(f64, f64); R],
    ) {
        let (part, stride) = (self.part, self.stride);
        for p in 0..part {
            let twiddles: [(f64, f64); R] = std::array::from_fn(|k| {
                let (cos, sin) = self.twiddles[p * k * stride];
                (cos, self.flip * sin)
            });
            for q in 0..stride {
                let inputs: [Complex; R] =
                    std::array::from_fn(|j| from[q + stride * (p + part * j)]);
                let mut outputs = [Complex::ZERO; R];
                for lane in 0..LANES {
                    let x = std::array::from_fn(|j| (inputs[j].re[lane], inputs[j].im[lane]));
                    let y = butterfly(x, self.flip);
                    for k in 0..R {
                        let (c, s) = twiddles[k];
                        outputs[k].re[lane] = y[k].0 * c - y[k].1 * s;
                        outputs[k].im[lane] = y[k].0 * s + y[k].1 * c;
                    }
                }
                for (k, output) in outputs.iter().enumerate() {
                    to[q + stride * (R * p + k)] = *output;
                }
            }
        }
    }
}

#[inline(always)]
fn plus(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 + b.0, a.1 + b.1)
}

#[inline(always)]
fn minus(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 - b.0, a.1 - b.1)
}

/// a · (i·factor).
#[inline(always)]
fn quarter(a: (f64, f64), factor: f64) -> (f64, f64) {
    (-factor * a.1, factor * a.0)
}

#[inline(always)]
fn two(x: [(f64, f64); 2], _flip: f64) -> [(f64, f64); 2] {
    [plus(x[0], x[1]), minus(x[0], x[1])]
}

#[inline(always)]
fn three(x: [(f64, f64); 3], flip: f64) -> [(f64, f64); 3] {
    const SIN: f64 = 0.866_025_403_784_438_6;
    let sum = plus(x[1], x[2]);
    let across = quarter(minus(x[1], x[2]), flip * SIN);
    let middle = (x[0].0 - 0.5 * sum.0, x[0].1 - 0.5 * sum.1);
    [plus(x[0], sum), plus(middle, across), minus(middle, across)]
}

#[inline(always)]
fn four(x: [(f64, f64); 4], flip: f64) -> [(f64, f64); 4] {
    let (even, odd) = (plus(x[0], x[2]), plus(x[1], x[3]));
    let even_rest = minus(x[0], x[2]);
    let odd_rest = quarter(minus(x[1], x[3]), flip);
    [
        plus(even, odd),
        plus(even_rest, odd_rest),
        minus(even, odd),
        minus(even_rest, odd_rest),
    ]
}

#[inline(always)]
fn five(x: [(f64, f64); 5], flip: f64) -> [(f64, f64); 5] {
    const COS1: f64 = 0.309_016_994_374_947_45;
    const COS2: f64 = -0.809_016_994_374_947_5;
    const SIN1: f64 = 0.951_056_516_295_153_5;
    const SIN2: f64 = 0.587_785_252_292_473_1;
    let (sum1, sum2) = (plus(x[1], x[4]), plus(x[2], x[3]));
    let (rest1, rest2) = (minus(x[1], x[4]), minus(x[2], x[3]));
    let mix = |a: f64, b: f64| {
        (
            x[0].0 + a * sum1.0 + b * sum2.0,
            x[0].1 + a * sum1.1 + b * sum2.1,
        )
    };
    let across = |a: f64, b: f64| {
        let re = a * rest1.0 + b * rest2.0;
        let im = a * rest1.1 + b * rest2.1;
        quarter((re, im), flip)
    };
    let (first, second) = (mix(COS1, COS2), mix(COS2, COS1));
    let (first_across, second_across) = (across(SIN1, SIN2), across(SIN2, -SIN1));
    [
        plus(x[0], plus(sum1, sum2)),
        plus(first, first_across),
        plus(second, second_across),
        minus(second, second_across),
        minus(first, first_across),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_plain_sum() {
        for length in [1, 2, 3, 4, 5, 6, 12, 20, 30, 54, 216, 250] {
            let data: Vec<Complex> = (0..length)
                .map(|j| Complex {
                    re: std::array::from_fn(|k| ((j * 7 + k * 3) as f64).sin()),
                    im: std::array::from_fn(|k| ((j * 5 + k) as f64).cos()),
                })
                .collect();
            for (sign, factor) in [(Sign::Plus, 1.0), (Sign::Minus, -1.0)] {
                let mut fast = data.clone();
                Fft::new(length).run(sign, &mut fast, &mut data.clone());
                for k in 0..length {
                    let (mut re, mut im) = (0.0, 0.0);
                    for (j, x) in data.iter().enumerate() {
                        let angle = factor * std::f64::consts::TAU * ((j * k) % length) as f64
                            / length as f64;
                        let (sin, cos) = angle.sin_cos();
                        re += x.re[3] * cos - x.im[3] * sin;
                        im += x.re[3] * sin + x.im[3] * cos;
                    }
                    let error = (fast[k].re[3] - re).hypot(fast[k].im[3] - im);
                    assert!(error <= 1e-12, "length {length} mode {k}: {error:.1e}");
                }
            }
        }
    }

    #[test]
    fn smooth_lengths_are_even_and_tight() {
        assert_eq!(smooth_length(0), 2);
        assert_eq!(smooth_length(201), 216);
        assert_eq!(smooth_length(404), 432);
        assert_eq!(smooth_length(809), 810);
    }
}
