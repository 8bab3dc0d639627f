//! The condition number of a preconditioned system from the steps of conjugate gradients.

/// The tridiagonal matrix of the Lanczos process that conjugate gradients run. Its extreme eigenvalues
/// lie within the spectrum of the preconditioned system and converge to its ends.
#[derive(Default)]
pub(super) struct Lanczos {
    diagonal: Vec<f64>,
    /// Squares of the off-diagonal entries; the first one is zero.
    beside: Vec<f64>,
    /// The contribution of the last step to the next row: on the diagonal, and off it squared.
    carried: (f64, f64),
}

impl Lanczos {
    /// Adds a step of length α after which the energy is β times the energy before.
    pub(super) fn push(&mut self, alpha: f64, beta: f64) {
        self.diagonal.push(1.0 / alpha + self.carried.0);
        self.beside.push(self.carried.1);
        self.carried = (beta / alpha, beta / (alpha * alpha));
    }

    /// Largest eigenvalue over smallest, to a few per cent; 1 before the first step.
    pub(super) fn condition(&self) -> f64 {
        let ends = self.diagonal.iter().zip(&self.beside);
        let (least, most) = ends.fold((f64::INFINITY, 0.0_f64), |(least, most), (d, e)| {
            (least.min(*d), most.max(d + 2.0 * e.sqrt()))
        });
        if self.diagonal.is_empty() {
            return 1.0;
        }
        // By Gershgorin's theorem no eigenvalue exceeds 1.5 `most`; every diagonal entry is at
        // least the smallest.
        let largest = self.bisect(least, 2.0 * most, |below| below < self.diagonal.len());
        let smallest = self.bisect(1e-18 * least, least, |below| below == 0);
        largest / smallest
    }

    /// The point, to 2 %, at which `keep` of the number of smaller eigenvalues turns from true to false.
    fn bisect(&self, mut low: f64, mut high: f64, keep: impl Fn(usize) -> bool) -> f64 {
        while high > 1.02 * low {
            let middle = (low * high).sqrt();
            if keep(self.eigenvalues_below(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// Number of eigenvalues below x, by Sturm's sequence.
    fn eigenvalues_below(&self, x: f64) -> usize {
        let mut count = 0;
        let mut pivot = 1.0_f64;
        for (d, e) in self.diagonal.iter().zip(&self.beside) {
            pivot = d - x - e / pivot;
            if pivot.abs() < f64::MIN_POSITIVE {
                pivot = -f64::MIN_POSITIVE;
            }
            count += usize::from(pivot < 0.0);
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_ends_of_a_known_matrix() {
        // α = 1 and β = ¼ after the first row give 1.25 on the diagonal and ½ beside it.
        let mut steps = Lanczos::default();
        assert_eq!(steps.condition(), 1.0);
        for _ in 0..400 {
            steps.push(1.0, 0.25);
        }
        // The spectrum fills [1.25 − 1, 1.25 + 1] as it grows.
        assert!((steps.condition() / 9.0 - 1.0).abs() <= 0.1);
    }
}
