//! Normalised associated Legendre functions with the factor sinᵐθ taken out.
//!
//! With P̄_l^m the fully normalised functions of the basis (the azimuthal √2 included for m > 0)
//! this file computes Π_l^m(z) = P̄_l^m / sinᵐθ, a polynomial in z = cos θ:
//!
//! Π_m^m = c_m, Π_l^m = a_lm z Π_{l−1}^m − b_lm Π_{l−2}^m,
//! a_lm = √((4l²−1)/(l²−m²)), b_lm = √((2l+1)((l−1)²−m²) / ((2l−3)(l²−m²))).
//!
//! sinᵐθ is part of the azimuthal factors Re, Im (x+iy)ᵐ, so there is no division by sin θ. Π is
//! below about (1+√2)^l, 1e115 at l = 300. Only (x+iy)ᵐ underflows, and is scaled.

/// Constants of the three-term recurrence, one column per order m.
#[derive(Clone, Debug)]
pub(crate) struct Legendre {
    degree: usize,
    /// c_m = Π_m^m, m = 0 … L.
    sectoral: Vec<f64>,
    /// (a_lm, b_lm) for l = m+1 … L, column after column.
    steps: Vec<(f64, f64)>,
    /// Index in `steps` at which column m begins.
    starts: Vec<usize>,
}

impl Legendre {
    pub(crate) fn new(degree: usize) -> Self {
        let mut sectoral = Vec::with_capacity(degree + 1);
        let mut value = (0.25 / std::f64::consts::PI).sqrt();
        sectoral.push(value);
        for m in 1..=degree {
            // √2 enters once, at m = 1, where the azimuthal pair begins.
            let pair = if m == 1 { 2.0 } else { 1.0 };
            value *= (pair * (2 * m + 1) as f64 / (2 * m) as f64).sqrt();
            sectoral.push(value);
        }
        let mut steps = Vec::with_capacity(degree * (degree + 1) / 2);
        let mut starts = Vec::with_capacity(degree + 1);
        for m in 0..=degree {
            starts.push(steps.len());
            for l in m + 1..=degree {
                steps.push(step(l, m));
            }
        }
        Self {
            degree,
            sectoral,
            steps,
            starts,
        }
    }

    /// L.
    pub(crate) fn degree(&self) -> usize {
        self.degree
    }

    /// Writes Π_l^m(z) for l = m … L into `column` (length L − m + 1).
    pub(crate) fn column(&self, m: usize, z: f64, column: &mut [f64]) {
        debug_assert_eq!(column.len(), self.degree - m + 1);
        let steps = &self.steps[self.starts[m]..self.starts[m] + self.degree - m];
        let mut before = 0.0;
        let mut here = self.sectoral[m];
        column[0] = here;
        for (out, &(a, b)) in column[1..].iter_mut().zip(steps) {
            let next = a * z * here - b * before;
            before = here;
            here = next;
            *out = next;
        }
    }

    /// The recurrence constants of column m: c_m and (a, b) for l = m+1 … L.
    pub(crate) fn recurrence(&self, m: usize) -> (f64, &[(f64, f64)]) {
        let start = self.starts[m];
        (
            self.sectoral[m],
            &self.steps[start..start + self.degree - m],
        )
    }
}

/// (a_lm, b_lm) of the recurrence in l.
fn step(l: usize, m: usize) -> (f64, f64) {
    let (l, m) = (l as f64, m as f64);
    let below = l * l - m * m;
    let a = ((4.0 * l * l - 1.0) / below).sqrt();
    let b = if l - m < 1.5 {
        0.0
    } else {
        ((2.0 * l + 1.0) * ((l - 1.0) * (l - 1.0) - m * m) / ((2.0 * l - 3.0) * below)).sqrt()
    };
    (a, b)
}

/// dΠ_l^m/dz = k Π_l^{m+1}: the factor k.
///
/// √((l−m)(l+m+1)), over √2 at m = 0, where the pair's √2 enters.
pub(crate) fn derivative_factor(l: usize, m: usize) -> f64 {
    let product = ((l - m) * (l + m + 1)) as f64;
    if m == 0 {
        (0.5 * product).sqrt()
    } else {
        product.sqrt()
    }
}

/// Re and Im of (x+iy)ᵐ for m = 0 … L, scaled by powers of two to stay representable.
///
/// The true value is `(re, im) · 2^−exponent`, the exponent a multiple of [`SCALE_STEP`].
pub(crate) struct Azimuth {
    pub(crate) re: Vec<f64>,
    pub(crate) im: Vec<f64>,
    /// The factor that undoes the scaling, as two factors neither of which underflows.
    pub(crate) unscale: Vec<(f64, f64)>,
}

const SCALE_STEP: i32 = 512;

impl Azimuth {
    pub(crate) fn new(degree: usize) -> Self {
        Self {
            re: vec![0.0; degree + 1],
            im: vec![0.0; degree + 1],
            unscale: vec![(1.0, 1.0); degree + 1],
        }
    }

    pub(crate) fn fill(&mut self, x: f64, y: f64) {
        // A direction this close to the axis is treated as the pole, since its powers would
        // underflow between two scale steps.
        let (x, y) = if x.abs().max(y.abs()) < 1e-150 {
            (0.0, 0.0)
        } else {
            (x, y)
        };
        let step = 2.0_f64.powi(SCALE_STEP);
        let small = 2.0_f64.powi(-SCALE_STEP);
        let (mut re, mut im) = (1.0_f64, 0.0_f64);
        let mut exponent = 0;
        for m in 0..self.re.len() {
            if m > 0 {
                (re, im) = (re * x - im * y, re * y + im * x);
                let size = re.abs().max(im.abs());
                if exponent < 3 * SCALE_STEP && size > 0.0 && size < small {
                    re *= step;
                    im *= step;
                    exponent += SCALE_STEP;
                }
            }
            self.re[m] = re;
            self.im[m] = im;
            // Two factors, since 2^-1536 alone is zero although Π may be 1e115.
            let steps = exponent / SCALE_STEP;
            self.unscale[m] = (small.powi(steps / 2), small.powi(steps - steps / 2));
        }
    }

    /// v · 2^−exponent of order m; underflow gives 0.
    pub(crate) fn unscaled(&self, m: usize, v: f64) -> f64 {
        let (first, second) = self.unscale[m];
        v * first * second
    }
}
