//! The double Fourier sphere: functions as fine grids on a torus, ready for local interpolation.
//!
//! With θ running around the whole circle, (θ, φ) and (2π−θ, φ+π) are the same point, and a
//! function of degree D is a trigonometric polynomial of degree D in both angles. Its modes are
//! divided by the window's transform and summed on a grid σ times finer than they need. The sum of
//! that grid with the window at any point is the function's value there, to the window's accuracy.
//! The adjoint converts spread points to moments.

mod simd;

use pulp::Arch;
use rayon::prelude::*;

use self::simd::{
    AddDegrees, ModesFromRows, RingsFromRows, RowsFromModes, RowsFromRings, SumDegrees,
};
use crate::fft::{Complex, Fft, LANES, smooth_length};
use crate::kernel::{Kernel, OVERSAMPLING, TAPS, TAPS_BEFORE};
use crate::ring_pairs::{OrderValues, RingPairs, add_up};
use crate::two_step::{Folded, TwoStep};

/// Fine grid values: rows of equal θ from just before the north pole to just beyond the south pole,
/// columns of equal φ with the first and last few repeated.
#[derive(Clone, Debug)]
pub(crate) struct FineGrid {
    pub(crate) values: Vec<f64>,
}

/// The transform between coefficients of one degree and fine grids, in both directions.
#[derive(Clone, Debug)]
pub(crate) struct DoubleFourier {
    degree: usize,
    two_step: TwoStep,
    kernel: Kernel,
    /// The transform along the θ circle through the rings on which harmonics are summed.
    coarse: Fft,
    theta: Fft,
    phi: Fft,
    /// 1 / transform of the window at mode k, for θ (with the coarse circle's 1/n) and for φ.
    corrections: [Vec<f64>; 2],
    blocks: Vec<RingPairs>,
}

/// Complex modes m = 0 … D of every ring or row, `stride` numbers per row.
struct Modes {
    stride: usize,
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Modes {
    fn zeros(rows: usize, stride: usize) -> Self {
        Self {
            stride,
            re: vec![0.0; rows * stride],
            im: vec![0.0; rows * stride],
        }
    }
}

impl DoubleFourier {
    pub(crate) fn new(degree: usize) -> Self {
        let kernel = Kernel::new();
        let needed = (2 * degree + 1) as f64 * OVERSAMPLING;
        // The window must be narrower than the circle.
        let fine = smooth_length((needed.ceil() as usize).max(2 * TAPS));
        let coarse = smooth_length(2 * degree + 2);
        let correction = |share: f64| -> Vec<f64> {
            (0..=degree)
                .map(|k| share / kernel.transform(k as f64 / fine as f64))
                .collect()
        };
        let corrections = [correction(1.0 / coarse as f64), correction(1.0)];
        let step = std::f64::consts::TAU / coarse as f64;
        let pairs = coarse / 4 + 1;
        let blocks = (0..pairs.div_ceil(LANES))
            .map(|b| RingPairs {
                z: std::array::from_fn(|k| (step * (b * LANES + k) as f64).cos()),
                sin: std::array::from_fn(|k| (step * (b * LANES + k) as f64).sin()),
            })
            .collect();
        Self {
            degree,
            two_step: TwoStep::new(degree),
            kernel,
            coarse: Fft::new(coarse),
            theta: Fft::new(fine),
            phi: Fft::new(fine),
            corrections,
            blocks,
        }
    }

    pub(crate) fn degree(&self) -> usize {
        self.degree
    }

    pub(crate) fn kernel(&self) -> &Kernel {
        &self.kernel
    }

    /// Grid steps around the circle, in θ and in φ.
    pub(crate) fn steps(&self) -> usize {
        self.theta.length()
    }

    /// Number of stored rows: θ from −TAPS_BEFORE to half the circle + TAPS/2.
    pub(crate) fn rows(&self) -> usize {
        self.steps() / 2 + TAPS
    }

    /// Distance between the starts of consecutive rows, in numbers.
    pub(crate) fn stride(&self) -> usize {
        self.steps() + TAPS
    }

    /// The grid whose window sums are Σ β Y.
    pub(crate) fn synthesis(&self, beta: &[f64]) -> FineGrid {
        let rings = self.ring_modes(beta);
        let rows = self.row_modes(&rings);
        let mut values = vec![0.0; self.rows() * self.stride()];
        values
            .par_chunks_mut(2 * LANES * self.stride())
            .enumerate()
            .for_each(|(block, values)| {
                Arch::new().dispatch(RowsFromModes {
                    fourier: self,
                    modes: &rows,
                    first: block * 2 * LANES,
                    values,
                });
            });
        FineGrid { values }
    }

    /// The adjoint of [`DoubleFourier::synthesis`]: Σ grid value · (response of the grid to Y_{lm}).
    pub(crate) fn analysis(&self, mut grid: FineGrid) -> Vec<f64> {
        let mut rows = Modes::zeros(self.rows(), self.mode_stride());
        let stride = rows.stride;
        grid.values
            .par_chunks_mut(2 * LANES * self.stride())
            .zip(rows.re.par_chunks_mut(2 * LANES * stride))
            .zip(rows.im.par_chunks_mut(2 * LANES * stride))
            .for_each(|((values, re), im)| {
                Arch::new().dispatch(ModesFromRows {
                    fourier: self,
                    values,
                    re,
                    im,
                });
            });
        let rings = self.rings_from_rows(&rows);
        self.sum_rings(&rings)
    }

    fn mode_stride(&self) -> usize {
        (self.degree + 1).next_multiple_of(LANES)
    }

    fn ring_count(&self) -> usize {
        self.coarse.length() / 2 + 1
    }

    /// c_m − i s_m on the coarse rings, ring after ring; halved for m > 0.
    fn ring_modes(&self, beta: &[f64]) -> Modes {
        let folded = &self.two_step.fold(beta);
        let blocks: Vec<Vec<OrderValues>> = self
            .blocks
            .par_iter()
            .map(|pairs| {
                Arch::new().dispatch(SumDegrees {
                    two_step: &self.two_step,
                    pairs,
                    folded,
                })
            })
            .collect();
        let last = self.ring_count() - 1;
        let mut modes = Modes::zeros(self.ring_count(), self.mode_stride());
        for (j, north, south) in self.pair_list(last) {
            for (m, sums) in blocks[j / LANES].iter().enumerate() {
                let share = if m == 0 { 1.0 } else { 0.5 };
                for (side, ring) in [(0, north), (1, south)] {
                    let at = ring * modes.stride + m;
                    modes.re[at] = share * sums.cos[side][j % LANES];
                    modes.im[at] = if m == 0 {
                        0.0
                    } else {
                        -share * sums.sin[side][j % LANES]
                    };
                }
            }
        }
        modes
    }

    /// (pair, northern ring, southern ring).
    fn pair_list(&self, last: usize) -> impl Iterator<Item = (usize, usize, usize)> {
        (0..=last / 2).map(move |j| (j, j, last - j))
    }

    /// Sums rings · P̄_l^m; the adjoint of [`DoubleFourier::ring_modes`] without its halving.
    fn sum_rings(&self, rings: &Modes) -> Vec<f64> {
        let last = self.ring_count() - 1;
        let parts: Vec<Vec<Folded>> = (0..self.blocks.len())
            .into_par_iter()
            .map(|block| {
                let mut folded = vec![[0.0; 4]; self.two_step.len()];
                let mut values = vec![ZERO_ORDER; self.degree + 1];
                for (j, north, south) in self.pair_list(last) {
                    if j / LANES != block {
                        continue;
                    }
                    for (m, value) in values.iter_mut().enumerate() {
                        for (side, ring) in [(0, north), (1, south)] {
                            // The equator is its own mirror image and is counted once.
                            if side == 0 || north != south {
                                let at = ring * rings.stride + m;
                                value.cos[side][j % LANES] = rings.re[at];
                                value.sin[side][j % LANES] = -rings.im[at];
                            }
                        }
                    }
                }
                Arch::new().dispatch(AddDegrees {
                    two_step: &self.two_step,
                    pairs: &self.blocks[block],
                    values: &values,
                    folded: &mut folded,
                });
                folded
            })
            .collect();
        self.two_step.unfold(&add_up(&parts, self.two_step.len()))
    }

    /// Modes of the fine rows from those of the coarse rings, order by order.
    fn row_modes(&self, rings: &Modes) -> Modes {
        let columns: Vec<Vec<Complex>> = (0..rings.stride / LANES)
            .into_par_iter()
            .map(|block| {
                Arch::new().dispatch(RowsFromRings {
                    fourier: self,
                    rings,
                    first: block * LANES,
                })
            })
            .collect();
        let mut rows = Modes::zeros(self.rows(), rings.stride);
        for (block, column) in columns.iter().enumerate() {
            for (r, value) in column.iter().enumerate() {
                let at = r * rows.stride + block * LANES;
                rows.re[at..at + LANES].copy_from_slice(&value.re);
                rows.im[at..at + LANES].copy_from_slice(&value.im);
            }
        }
        rows
    }

    /// The adjoint of [`DoubleFourier::row_modes`].
    fn rings_from_rows(&self, rows: &Modes) -> Modes {
        let columns: Vec<Vec<Complex>> = (0..rows.stride / LANES)
            .into_par_iter()
            .map(|block| {
                Arch::new().dispatch(RingsFromRows {
                    fourier: self,
                    rows,
                    first: block * LANES,
                })
            })
            .collect();
        let mut rings = Modes::zeros(self.ring_count(), rows.stride);
        for (block, column) in columns.iter().enumerate() {
            for (j, value) in column.iter().enumerate() {
                let at = j * rings.stride + block * LANES;
                rings.re[at..at + LANES].copy_from_slice(&value.re);
                rings.im[at..at + LANES].copy_from_slice(&value.im);
            }
        }
        rings
    }

    /// Index on the θ circle of a stored row.
    #[inline(always)]
    fn circle_position(&self, row: usize) -> usize {
        let n = self.steps();
        (row + n - TAPS_BEFORE) % n
    }

    /// Correction of θ mode k and order m.
    #[inline(always)]
    fn correct(&self, value: &Complex, k: usize, first: usize) -> Complex {
        let mut out = *value;
        for lane in 0..LANES {
            let m = (first + lane).min(self.degree);
            let factor = self.corrections[0][k] * self.corrections[1][m];
            out.re[lane] *= factor;
            out.im[lane] *= factor;
        }
        out
    }
}

const ZERO_ORDER: OrderValues = OrderValues {
    cos: [[0.0; LANES]; 2],
    sin: [[0.0; LANES]; 2],
};
