//! Arrays of numbers that go through the same arithmetic together, one number per lane.
//!
//! Loops over a fixed number of lanes become vector instructions when they are inlined into a pulp
//! dispatch. Each algorithm has its own number of lanes, chosen so that its intermediate values fit
//! the vector registers.

use crate::direction::Direction;

/// N numbers, one per lane.
pub(crate) type Lanes<const N: usize> = [f64; N];

/// a ← a b, lane by lane.
#[inline(always)]
pub(crate) fn multiply<const N: usize>(a: &mut Lanes<N>, b: &Lanes<N>) {
    for k in 0..N {
        a[k] *= b[k];
    }
}

/// re + i im ← (re + i im)(x + i y), lane by lane.
#[inline(always)]
pub(crate) fn multiply_complex<const N: usize>(
    re: &mut Lanes<N>,
    im: &mut Lanes<N>,
    x: &Lanes<N>,
    y: &Lanes<N>,
) {
    for k in 0..N {
        (re[k], im[k]) = (re[k] * x[k] - im[k] * y[k], re[k] * y[k] + im[k] * x[k]);
    }
}

/// x, y and z of up to N points; the lanes beyond the last point hold the north pole.
#[inline(always)]
pub(crate) fn coordinates<const N: usize>(points: &[Direction]) -> [Lanes<N>; 3] {
    let mut out = [[0.0; N], [0.0; N], [1.0; N]];
    for (k, p) in points.iter().enumerate() {
        out[0][k] = p.x;
        out[1][k] = p.y;
        out[2][k] = p.z;
    }
    out
}
