//! The vectorised steps of a [`DoubleFourier`] transform, each with its adjoint.

use pulp::{Simd, WithSimd};

use super::{DoubleFourier, Modes};
use crate::fft::{Complex, LANES, Sign};
use crate::kernel::TAPS_BEFORE;
use crate::lanes::multiply;
use crate::ring_pairs::{Lane, OrderValues, RingPairs, add_order, order_sums};
use crate::two_step::{Folded, TwoStep};

/// Eight orders of one ring or row, from order `first` on.
#[inline(always)]
fn load(modes: &Modes, row: usize, first: usize) -> Complex {
    let at = row * modes.stride + first;
    let mut out = Complex::ZERO;
    out.re.copy_from_slice(&modes.re[at..at + LANES]);
    out.im.copy_from_slice(&modes.im[at..at + LANES]);
    out
}

/// Signs (−1)^m of eight orders.
fn parities(first: usize) -> Lane {
    std::array::from_fn(|lane| {
        if (first + lane).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        }
    })
}

pub(super) struct SumDegrees<'a> {
    pub(super) two_step: &'a TwoStep,
    pub(super) pairs: &'a RingPairs,
    pub(super) folded: &'a [Folded],
}

impl WithSimd for SumDegrees<'_> {
    type Output = Vec<OrderValues>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Self::Output {
        let mut power = [1.0; LANES];
        let mut out = Vec::with_capacity(self.two_step.degree() + 1);
        for m in 0..=self.two_step.degree() {
            out.push(order_sums::<S>(
                self.two_step,
                m,
                &self.pairs.z,
                &power,
                self.folded,
            ));
            multiply(&mut power, &self.pairs.sin);
        }
        out
    }
}

pub(super) struct AddDegrees<'a> {
    pub(super) two_step: &'a TwoStep,
    pub(super) pairs: &'a RingPairs,
    pub(super) values: &'a [OrderValues],
    pub(super) folded: &'a mut [Folded],
}

impl WithSimd for AddDegrees<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let mut power = [1.0; LANES];
        for (m, values) in self.values.iter().enumerate() {
            add_order::<S>(self.two_step, m, &self.pairs.z, &power, values, self.folded);
            multiply(&mut power, &self.pairs.sin);
        }
    }
}

/// Eight orders from coarse rings to fine rows.
pub(super) struct RowsFromRings<'a> {
    pub(super) fourier: &'a DoubleFourier,
    pub(super) rings: &'a Modes,
    pub(super) first: usize,
}

impl WithSimd for RowsFromRings<'_> {
    type Output = Vec<Complex>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Vec<Complex> {
        let (fourier, first) = (self.fourier, self.first);
        let (coarse, fine) = (fourier.coarse.length(), fourier.theta.length());
        let mut circle = vec![Complex::ZERO; coarse];
        let parity = parities(first);
        for (j, slot) in circle.iter_mut().enumerate() {
            *slot = load(self.rings, j.min(coarse - j), first);
            if 2 * j > coarse {
                multiply(&mut slot.re, &parity);
                multiply(&mut slot.im, &parity);
            }
        }
        let mut scratch = vec![Complex::ZERO; fine];
        fourier.coarse.run(Sign::Minus, &mut circle, &mut scratch);
        let mut data = vec![Complex::ZERO; fine];
        data[0] = fourier.correct(&circle[0], 0, first);
        for k in 1..=fourier.degree {
            data[k] = fourier.correct(&circle[k], k, first);
            data[fine - k] = fourier.correct(&circle[coarse - k], k, first);
        }
        fourier.theta.run(Sign::Plus, &mut data, &mut scratch);
        (0..fourier.rows())
            .map(|r| data[fourier.circle_position(r)])
            .collect()
    }
}

/// The adjoint of [`RowsFromRings`].
pub(super) struct RingsFromRows<'a> {
    pub(super) fourier: &'a DoubleFourier,
    pub(super) rows: &'a Modes,
    pub(super) first: usize,
}

impl WithSimd for RingsFromRows<'_> {
    type Output = Vec<Complex>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Vec<Complex> {
        let (fourier, first) = (self.fourier, self.first);
        let (coarse, fine) = (fourier.coarse.length(), fourier.theta.length());
        let mut data = vec![Complex::ZERO; fine];
        for r in 0..fourier.rows() {
            data[fourier.circle_position(r)] = load(self.rows, r, first);
        }
        let mut scratch = vec![Complex::ZERO; fine];
        fourier.theta.run(Sign::Minus, &mut data, &mut scratch);
        let mut circle = vec![Complex::ZERO; coarse];
        circle[0] = fourier.correct(&data[0], 0, first);
        for k in 1..=fourier.degree {
            circle[k] = fourier.correct(&data[k], k, first);
            circle[coarse - k] = fourier.correct(&data[fine - k], k, first);
        }
        fourier.coarse.run(Sign::Plus, &mut circle, &mut scratch);
        let parity = parities(first);
        for j in 1..coarse / 2 {
            let mut mirror = circle[coarse - j];
            multiply(&mut mirror.re, &parity);
            multiply(&mut mirror.im, &parity);
            for lane in 0..LANES {
                circle[j].re[lane] += mirror.re[lane];
                circle[j].im[lane] += mirror.im[lane];
            }
        }
        circle.truncate(coarse / 2 + 1);
        circle
    }
}

/// Sixteen rows of fine values from their modes.
pub(super) struct RowsFromModes<'a> {
    pub(super) fourier: &'a DoubleFourier,
    pub(super) modes: &'a Modes,
    pub(super) first: usize,
    pub(super) values: &'a mut [f64],
}

impl WithSimd for RowsFromModes<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let fourier = self.fourier;
        let (n, stride) = (fourier.steps(), fourier.stride());
        let rows = self.values.len() / stride;
        let mut data = vec![Complex::ZERO; n];
        let mut scratch = vec![Complex::ZERO; n];
        let at = |row: usize, m: usize| {
            let at = (self.first + row) * self.modes.stride + m;
            (self.modes.re[at], self.modes.im[at])
        };
        for m in 0..=fourier.degree {
            for lane in 0..LANES.min(rows) {
                let (ar, ai) = at(lane, m);
                let (br, bi) = if lane + LANES < rows {
                    at(lane + LANES, m)
                } else {
                    (0.0, 0.0)
                };
                data[m].re[lane] = ar - bi;
                data[m].im[lane] = ai + br;
                if m > 0 {
                    data[n - m].re[lane] = ar + bi;
                    data[n - m].im[lane] = br - ai;
                }
            }
        }
        fourier.phi.run(Sign::Plus, &mut data, &mut scratch);
        for (r, row) in self.values.chunks_mut(stride).enumerate() {
            for (k, value) in row.iter_mut().enumerate() {
                let element = &data[(k + n - TAPS_BEFORE) % n];
                *value = if r < LANES {
                    element.re[r]
                } else {
                    element.im[r - LANES]
                };
            }
        }
    }
}

/// The adjoint of [`RowsFromModes`], with modes Σ value e^{−imφ}.
pub(super) struct ModesFromRows<'a> {
    pub(super) fourier: &'a DoubleFourier,
    pub(super) values: &'a [f64],
    pub(super) re: &'a mut [f64],
    pub(super) im: &'a mut [f64],
}

impl WithSimd for ModesFromRows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let fourier = self.fourier;
        let (n, stride) = (fourier.steps(), fourier.stride());
        let mode_stride = fourier.mode_stride();
        let mut data = vec![Complex::ZERO; n];
        let mut scratch = vec![Complex::ZERO; n];
        for (r, row) in self.values.chunks(stride).enumerate() {
            for (k, value) in row.iter().enumerate() {
                let element = &mut data[(k + n - TAPS_BEFORE) % n];
                if r < LANES {
                    element.re[r] += value;
                } else {
                    element.im[r - LANES] += value;
                }
            }
        }
        fourier.phi.run(Sign::Minus, &mut data, &mut scratch);
        let rows = self.values.len() / stride;
        for m in 0..=fourier.degree {
            let (up, down) = (&data[m], &data[(n - m) % n]);
            for lane in 0..LANES.min(rows) {
                let at = lane * mode_stride + m;
                self.re[at] = 0.5 * (up.re[lane] + down.re[lane]);
                self.im[at] = 0.5 * (up.im[lane] - down.im[lane]);
                if lane + LANES < rows {
                    let at = at + LANES * mode_stride;
                    self.re[at] = 0.5 * (up.im[lane] + down.im[lane]);
                    self.im[at] = 0.5 * (down.re[lane] - up.re[lane]);
                }
            }
        }
    }
}
