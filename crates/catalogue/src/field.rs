//! Values of an implicit function with their gradients, and blends of two of them.

use nalgebra::Vector3;

/// Value and gradient of an implicit function at one point: negative inside, zero on the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    /// Approximately the signed distance to the surface, metres.
    pub(crate) value: f64,
    /// Gradient of the value; on the surface it points outwards.
    pub(crate) gradient: Vector3<f64>,
}

impl Field {
    /// The complement: exchanges inside and outside.
    pub(crate) fn complement(self) -> Self {
        Self {
            value: -self.value,
            gradient: -self.gradient,
        }
    }

    /// Union with a fillet: min(a, b) − k h²/4 with h = max(0, 1 − |a − b|/k).
    ///
    /// Continuously differentiable for k > 0; k is about the width over which the surfaces merge,
    /// metres, and k = 0 gives the sharp union.
    pub(crate) fn blend(self, other: Self, k: f64) -> Self {
        let (near, far) = if self.value <= other.value {
            (self, other)
        } else {
            (other, self)
        };
        let gap = far.value - near.value;
        if gap >= k {
            return near;
        }
        let h = 1.0 - gap / k;
        Self {
            value: near.value - 0.25 * k * h * h,
            gradient: near.gradient * (1.0 - 0.5 * h) + far.gradient * (0.5 * h),
        }
    }

    /// Intersection with a rounded edge; k as in [`Field::blend`].
    pub(crate) fn intersect(self, other: Self, k: f64) -> Self {
        self.complement().blend(other.complement(), k).complement()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(value: f64) -> Field {
        Field {
            value,
            gradient: Vector3::new(value, 1.0, 0.0),
        }
    }

    #[test]
    fn blend_is_symmetric_and_below_the_minimum() {
        for (a, b) in [(0.1, 0.13), (-0.2, -0.25), (0.0, 0.0)] {
            let there = field(a).blend(field(b), 0.1);
            let back = field(b).blend(field(a), 0.1);
            assert!((there.value - back.value).abs() <= 1e-15);
            assert!((there.gradient - back.gradient).norm() <= 1e-15);
            assert!(there.value < a.min(b));
        }
    }

    #[test]
    fn distant_fields_do_not_blend() {
        assert!(field(0.1).blend(field(0.3), 0.1).value == 0.1);
        assert!(field(0.1).intersect(field(0.3), 0.1).value == 0.3);
    }
}
