//! The Kaiser–Bessel window that spreads a point over its grid neighbours.
//!
//! φ(d) = I₀(β √(1−(2d/w)²)) / I₀(β) for |d| ≤ w/2 grid steps, β = π w (1 − 1/2σ) for a grid σ times
//! finer than the highest mode needs. Between two grid points every tap is one smooth function of
//! the position, so it is tabulated as a polynomial. (Barnett, Magland and af Klinteberg 2019
//! compare such windows; this one's derivatives stay finite at its ends.)

/// Taps kept in registers; narrower windows are filled with zeros.
pub(crate) const TAPS: usize = 16;

/// One weight a tap.
pub(crate) type Taps = [f64; TAPS];

/// A window of even width.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    width: usize,
    beta: f64,
    /// Coefficients of u^d of every tap, the highest power first: of φ, φ′ and φ″. The derivatives
    /// have tables of their own, since differentiating a table loses digits.
    powers: Vec<[Taps; 3]>,
}

impl Kernel {
    /// A window of `width` taps, even and at most [`TAPS`], for a grid `oversampling` times finer
    /// than the modes need.
    pub(crate) fn new(width: usize, oversampling: f64) -> Self {
        debug_assert!(width.is_multiple_of(2) && width <= TAPS);
        let beta = std::f64::consts::PI * width as f64 * (1.0 - 0.5 / oversampling);
        let degree = width + 4;
        let mut powers = vec![[[0.0; TAPS]; 3]; degree + 1];
        let cosines = cosines(degree + 1);
        for tap in 0..width {
            let centre = 0.5 * (width as f64 - 1.0) - tap as f64;
            // Chebyshev points of [−½, ½].
            let jets: Vec<[f64; 3]> = (0..=degree)
                .map(|i| window_jet(beta, width, 0.5 * cosines[2 * i + 1] + centre))
                .collect();
            for part in 0..3 {
                let values: Vec<f64> = jets.iter().map(|jet| jet[part]).collect();
                for (d, c) in monomials(&values, &cosines).into_iter().enumerate() {
                    powers[degree - d][part][tap] = c;
                }
            }
        }
        Self {
            width,
            beta,
            powers,
        }
    }

    /// Number of taps.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// Steps from the first tap's grid point to the one at or below the position.
    pub(crate) fn reach(&self) -> usize {
        self.width / 2 - 1
    }

    /// φ at the taps' distances; u ∈ [−½, ½] is the position past the grid point, less ½.
    #[inline(always)]
    pub(crate) fn weights(&self, u: f64) -> Taps {
        let mut sum = self.powers[0][0];
        for power in &self.powers[1..] {
            for k in 0..TAPS {
                sum[k] = sum[k] * u + power[0][k];
            }
        }
        sum
    }

    /// φ, φ′ and φ″ at the taps' distances, per grid step.
    #[inline(always)]
    pub(crate) fn jets(&self, u: f64) -> [Taps; 3] {
        let mut sums = self.powers[0];
        for power in &self.powers[1..] {
            for part in 0..3 {
                for k in 0..TAPS {
                    sums[part][k] = sums[part][k] * u + power[part][k];
                }
            }
        }
        sums
    }

    /// ∫ φ(d) e^{−2πiξd} dd at ξ cycles a grid step, |ξ| below 1 − 1/2σ.
    pub(crate) fn transform(&self, frequency: f64) -> f64 {
        let w = self.width as f64;
        let root = (self.beta * self.beta - (std::f64::consts::PI * w * frequency).powi(2))
            .max(1e-300)
            .sqrt();
        w * root.sinh() / (root * bessel(0, self.beta))
    }
}

/// φ, φ′ and φ″ at a distance of d grid steps, |d| ≤ w/2.
///
/// With x = 2d/w and z = β√(1−x²): dI₀/dx = −β² x I₁(z)/z, d²I₀/dx² = −β² I₁(z)/z + β⁴ x² I₂(z)/z².
fn window_jet(beta: f64, width: usize, d: f64) -> [f64; 3] {
    let per_step = 2.0 / width as f64;
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
    use super::*;

    #[test]
    fn tabulated_windows_are_the_windows() {
        for width in [4, 8, 12, 16] {
            let kernel = Kernel::new(width, 2.0);
            for i in 0..=40 {
                let u = f64::from(i) / 40.0 - 0.5;
                let (taps, jets) = (kernel.weights(u), kernel.jets(u));
                for (tap, weight) in taps.iter().enumerate().take(width) {
                    let d = u + 0.5 * (width as f64 - 1.0) - tap as f64;
                    let exact = window_jet(kernel.beta, width, d);
                    let allowed = 3e-14 + 10.0_f64.powi(-(width as i32));
                    assert!((weight - exact[0]).abs() <= allowed, "width {width}");
                    for part in 0..3 {
                        let error = (jets[part][tap] - exact[part]).abs();
                        assert!(error <= 10.0 * allowed, "width {width} part {part}");
                    }
                }
                assert!(taps[width..].iter().all(|&w| w == 0.0));
                assert_eq!(jets[0], taps);
            }
        }
    }

    #[test]
    fn derivatives_of_the_window_agree_with_differences() {
        for d in [-3.2, -1.0, 0.0, 0.4, 2.9] {
            let at = |d: f64| window_jet(20.0, 8, d);
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
        for (width, allowed) in [(8, 1e-6), (12, 2e-10), (16, 1e-13)] {
            let kernel = Kernel::new(width, 2.0);
            for mode in [0.0, 0.1, 0.25] {
                for u in [-0.5, -0.2, 0.4] {
                    let turn = std::f64::consts::TAU * mode;
                    let sum: f64 = kernel
                        .weights(u)
                        .iter()
                        .take(width)
                        .enumerate()
                        .map(|(tap, w)| {
                            let d = u + 0.5 * (width as f64 - 1.0) - tap as f64;
                            w * (turn * d).cos()
                        })
                        .sum();
                    let error = (sum / kernel.transform(mode) - 1.0).abs();
                    assert!(error <= allowed, "width {width} mode {mode}: {error:.1e}");
                }
            }
        }
    }
}
