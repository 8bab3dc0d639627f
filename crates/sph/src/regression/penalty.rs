//! Penalties on roughness.

use super::RegressionError;

/// λ Σ (l(l+1))^power β_{lm}²: the spherical thin-plate spline for power 2.
///
/// With ΔY = −l(l+1)Y this is λ ∫ |Δ^{power/2} f|². The constant is never penalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// λ ≥ 0, relative to a sum over samples: twice as many samples need twice the λ.
    pub lambda: f64,
    /// Exponent of l(l+1).
    pub power: i32,
}

impl Penalty {
    /// No penalty: plain least squares.
    pub const NONE: Self = Self {
        lambda: 0.0,
        power: 2,
    };

    /// λ (l(l+1))^power.
    pub fn weight(&self, l: usize) -> f64 {
        self.lambda * roughness(l, self.power)
    }

    /// An error if λ is negative or not finite.
    pub(super) fn check(&self) -> Result<(), RegressionError> {
        if self.lambda >= 0.0 && self.lambda.is_finite() {
            Ok(())
        } else {
            Err(RegressionError::Penalty {
                lambda: self.lambda,
            })
        }
    }
}

/// (l(l+1))^power.
pub(super) fn roughness(l: usize, power: i32) -> f64 {
    ((l * (l + 1)) as f64).powi(power)
}
