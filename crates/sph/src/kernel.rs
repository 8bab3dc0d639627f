//! The Kaiser–Bessel window that spreads a point over its grid neighbours.
//!
//! φ(d) = I₀(β √(1−(2d/w)²)) / I₀(β) for |d| ≤ w/2 grid steps, β = π w (1 − 1/2σ) for a grid σ
//! times finer than the highest mode needs. Between two grid points the weight of every tap is a
//! smooth function of the position, which is tabulated as a polynomial. Barnett, Magland and af
//! Klinteberg 2019 compare such windows. The derivatives of this window stay finite at its ends.

use pulp::Simd;

use crate::multiply_add::multiply_add;

/// Width of the window in grid points. On a grid twice as fine as the modes need, sums have a relative
/// error of about 1e-14.
pub(crate) const TAPS: usize = 16;

/// σ: how many times finer the grid is than the modes need.
pub(crate) const OVERSAMPLING: f64 = 2.0;

/// Grid steps from the first tap to the grid point at or below the position.
pub(crate) const TAPS_BEFORE: usize = TAPS / 2 - 1;

/// One weight per tap.
pub(crate) type Taps = [f64; TAPS];

/// The first half of the taps; the second is its mirror image.
type Half = [f64; TAPS / 2];

/// The window of [`TAPS`] taps for a grid at least [`OVERSAMPLING`] times finer than the modes need.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    beta: f64,
    /// Coefficients of u^{2d} and of u^{2d+1} of the first half of the taps, the highest d first,
    /// for φ, φ′ and φ″. The derivatives have their own tables, since differentiating a table loses
    /// digits.
    powers: Vec<[[Half; 2]; 3]>,
}

impl Kernel {
    pub(crate) fn new() -> Self {
        let beta = std::f64::consts::PI * TAPS as f64 * (1.0 - 0.5 / OVERSAMPLING);
        let pairs = TAPS / 2 + 2;
        let nodes = 2 * pairs;
        let mut powers = vec![[[[0.0; TAPS / 2]; 2]; 3]; pairs];
        let cosines = cosines(nodes);
        for tap in 0..TAPS / 2 {
            let centre = 0.5 * (TAPS as f64 - 1.0) - tap as f64;
            // Chebyshev points of [−½, ½].
            let jets: Vec<[f64; 3]> = (0..nodes)
                .map(|i| window_jet(beta, 0.5 * cosines[2 * i + 1] + centre))
                .collect();
            for part in 0..3 {
                let values: Vec<f64> = jets.iter().map(|jet| jet[part]).collect();
                for (d, c) in monomials(&values, &cosines).into_iter().enumerate() {
                    powers[pairs - 1 - d / 2][part][d % 2][tap] = c;
                }
            }
        }
        Self { beta, powers }
    }

    /// φ at the taps' distances; u ∈ [−½, ½] is the position past the grid point, less ½.
    #[inline(always)]
    pub(crate) fn weights<S: Simd>(&self, u: f64) -> Taps {
        let [weights] = self.derivatives::<S, 1>(u);
        weights
    }

    /// φ and its first derivatives, `PARTS` of φ, φ′, φ″, at the taps' distances, per grid step.
    #[inline(always)]
    pub(crate) fn derivatives<S: Simd, const PARTS: usize>(&self, u: f64) -> [Taps; PARTS] {
        let square = u * u;
        let mut sums = [[[0.0; TAPS / 2]; 2]; PARTS];
        for power in &self.powers {
            for (sum, power) in sums.iter_mut().zip(power) {
                for k in 0..TAPS / 2 {
                    sum[0][k] = multiply_add::<S>(sum[0][k], square, power[0][k]);
                    sum[1][k] = multiply_add::<S>(sum[1][k], square, power[1][k]);
                }
            }
        }
        // φ(−d) = φ(d), so the mirrored tap at u is the tap at −u; odd derivatives change sign.
        let mut out = [[0.0; TAPS]; PARTS];
        for (part, (out, [even, odd])) in out.iter_mut().zip(&sums).enumerate() {
            let sign = if part % 2 == 0 { 1.0 } else { -1.0 };
            for k in 0..TAPS / 2 {
                out[k] = multiply_add::<S>(odd[k], u, even[k]);
                out[TAPS - 1 - k] = sign * multiply_add::<S>(-odd[k], u, even[k]);
            }
        }
        out
    }

    /// ∫ φ(d) e^{−2πiξd} dd at ξ cycles per grid step, |ξ| below 1 − 1/2σ.
    pub(crate) fn transform(&self, frequency: f64) -> f64 {
        let w = TAPS as f64;
        let root = (self.beta * self.beta - (std::f64::consts::PI * w * frequency).powi(2))
            .max(1e-300)
            .sqrt();
        w * root.sinh() / (root * bessel(0, self.beta))
    }
}

/// φ, φ′ and φ″ at a distance of d grid steps, |d| ≤ w/2.
///
/// With x = 2d/w and z = β√(1−x²): dI₀/dx = −β² x I₁(z)/z, d²I₀/dx² = −β² I₁(z)/z + β⁴ x² I₂(z)/z².
fn window_jet(beta: f64, d: f64) -> [f64; 3] {
    let per_step = 2.0 / TAPS as f64;
    let x = per_step * d;
    let z = beta * ((1.0 - x) * (1.0 + x)).max(0.0).sqrt();
    let square = beta * beta;
    let (i0, i1, i2) = (bessel(0, z), bessel(1, z), bessel(2, z));
    let top = bessel(0, beta);
    [
        i0 / top,
        -square * x * i1 / top * per_step,
        square * (square * x * x * i2 - i1) / top * per_step * per_step,
    ]
}

/// I_n(x) / xⁿ by its series; all terms are positive.
fn bessel(order: usize, x: f64) -> f64 {
    let quarter = 0.25 * x * x;
    let mut term = 1.0;
    for n in 1..=order {
        term /= 2.0 * n as f64;
    }
    let (mut sum, mut k) = (term, 1.0);
    while term > 1e-17 * sum {
        term *= quarter / (k * (k + order as f64));
        sum += term;
        k += 1.0;
    }
    sum
}

/// cos(π j / 2n) for j = 0 … 4n − 1.
fn cosines(nodes: usize) -> Vec<f64> {
    (0..4 * nodes)
        .map(|j| (std::f64::consts::PI * j as f64 / (2 * nodes) as f64).cos())
        .collect()
}

/// Coefficients of 1, u, u², … of the interpolant of values at the Chebyshev points of [−½, ½].
fn monomials(values: &[f64], cosines: &[f64]) -> Vec<f64> {
    let nodes = values.len();
    let degree = nodes - 1;
    let mut sum = vec![0.0; nodes];
    // T_0 and T_1 as polynomials in t = 2u; T_{k+1} = 2 t T_k − T_{k−1}.
    let (mut before, mut here) = (vec![0.0; nodes], vec![0.0; nodes]);
    before[0] = 1.0;
    if degree > 0 {
        here[1] = 1.0;
    }
    for k in 0..nodes {
        let projection: f64 = (0..nodes)
            .map(|i| values[i] * cosines[k * (2 * i + 1) % cosines.len()])
            .sum();
        let scale = if k == 0 { 1.0 } else { 2.0 } / nodes as f64;
        for (s, t) in sum.iter_mut().zip(&before) {
            *s += scale * projection * t;
        }
        let mut next: Vec<f64> = before.iter().map(|b| -b).collect();
        for (n, h) in next[1..].iter_mut().zip(&here) {
            *n += 2.0 * h;
        }
        before = std::mem::replace(&mut here, next);
    }
    let mut power = 1.0;
    for s in &mut sum {
        *s *= power;
        power *= 2.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use pulp::Scalar;

    use super::*;

    #[test]
    fn the_tabulated_window_is_the_window() {
        let kernel = Kernel::new();
        for i in 0..=40 {
            let u = f64::from(i) / 40.0 - 0.5;
            let taps = kernel.weights::<Scalar>(u);
            let jets = kernel.derivatives::<Scalar, 3>(u);
            for tap in 0..TAPS {
                let d = u + 0.5 * (TAPS as f64 - 1.0) - tap as f64;
                let exact = window_jet(kernel.beta, d);
                assert!((taps[tap] - exact[0]).abs() <= 3e-14);
                for part in 0..3 {
                    let error = (jets[part][tap] - exact[part]).abs();
                    assert!(error <= 3e-13, "part {part}: {error:.1e}");
                }
            }
            assert_eq!(jets[0], taps);
        }
    }

    #[test]
    fn derivatives_of_the_window_agree_with_differences() {
        for d in [-3.2, -1.0, 0.0, 0.4, 2.9] {
            let at = |d: f64| window_jet(20.0, d);
            let (here, step) = (at(d), 1e-4);
            let (before, after) = (at(d - step), at(d + step));
            for part in 0..2 {
                let difference = (after[part] - before[part]) / (2.0 * step);
                assert!((difference - here[part + 1]).abs() <= 1e-6);
            }
        }
    }

    #[test]
    fn the_taps_sum_modes_to_the_stated_accuracy() {
        let kernel = Kernel::new();
        for mode in [0.0, 0.1, 0.25] {
            for u in [-0.5, -0.2, 0.4] {
                let turn = std::f64::consts::TAU * mode;
                let sum: f64 = kernel
                    .weights::<Scalar>(u)
                    .iter()
                    .enumerate()
                    .map(|(tap, w)| {
                        let d = u + 0.5 * (TAPS as f64 - 1.0) - tap as f64;
                        w * (turn * d).cos()
                    })
                    .sum();
                let error = (sum / kernel.transform(mode) - 1.0).abs();
                assert!(error <= 1e-13, "mode {mode}: {error:.1e}");
            }
        }
    }
}
