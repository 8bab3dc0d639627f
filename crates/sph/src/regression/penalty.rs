//! Penalties on roughness, and the choice of their weight from the data.

/// λ Σ (l(l+1))^power β_{lm}²: the spherical thin-plate spline for power 2.
///
/// With ΔY = −l(l+1)Y this is λ ∫ |Δ^{power/2} f|². The constant is never penalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// λ ≥ 0, in units of samples: it competes with Σᵢ.
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
}

/// (l(l+1))^power.
pub(super) fn roughness(l: usize, power: i32) -> f64 {
    ((l * (l + 1)) as f64).powi(power)
}

/// Minimiser of a function with one dip on [low, high], by golden-section search.
///
/// Stops when the bracket is narrower than `width`; about 1.44 log₂((high−low)/width) evaluations.
pub(super) fn golden_section<E>(
    (mut low, mut high): (f64, f64),
    width: f64,
    mut cost: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut left = high - ratio * (high - low);
    let mut right = low + ratio * (high - low);
    let (mut cost_left, mut cost_right) = (cost(left)?, cost(right)?);
    while high - low > width {
        if cost_left <= cost_right {
            (high, right, cost_right) = (right, left, cost_left);
            left = high - ratio * (high - low);
            cost_left = cost(left)?;
        } else {
            (low, left, cost_left) = (left, right, cost_right);
            right = low + ratio * (high - low);
            cost_right = cost(right)?;
        }
    }
    Ok(if cost_left <= cost_right { left } else { right })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn golden_section_finds_the_dip() {
        let cost = |x: f64| Ok::<_, ()>((x - 0.7) * (x - 0.7));
        let found = golden_section((-3.0, 5.0), 1e-6, cost).unwrap();
        assert!((found - 0.7).abs() < 1e-6);
    }
}
