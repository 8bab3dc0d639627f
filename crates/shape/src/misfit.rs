//! How far a fitted surface is from explaining its cloud.

use std::fmt;

/// A fit with a root mean square residual above this share of the mean radius is refused. The worst
/// surfaces of test objects that a radius can half describe, a power drill, have 0.41; a needle of
/// 100 : 1, whose surface is a ball, has 0.7.
const REFUSED_RMS: f64 = 0.5;
/// Above this share the surface is doubtful. The smooth and the boxy objects of the tests stay below
/// 0.02.
const DOUBTFUL_RMS: f64 = 0.05;
/// A largest residual above this share of the mean radius is doubtful. Scans with a table, a second
/// object or outliers in them have 0.7 and more, the objects of the tests that a radius describes
/// 0.3 and less.
const DOUBTFUL_MAX: f64 = 0.5;

/// Residuals that are large beside the surface.
///
/// A proof that a radius is positive says nothing about the points: a ball is a valid surface and no
/// description of a needle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misfit {
    /// Root mean square residual, metres.
    pub rms: f64,
    /// Largest residual, metres.
    pub max_abs: f64,
    /// Mean radius of the surface, metres.
    pub radius: f64,
}

impl Misfit {
    /// What is doubtful about a surface of this mean radius as a description of its cloud; `None` where
    /// the residuals are small: at most 5 % of the mean radius in the root mean square and 50 % at the
    /// worst point. All lengths are metres.
    pub fn found(rms: f64, max_abs: f64, radius: f64) -> Option<Self> {
        let misfit = Self {
            rms,
            max_abs,
            radius,
        };
        Some(misfit).filter(Self::is_doubtful)
    }

    fn is_doubtful(&self) -> bool {
        !(self.rms <= DOUBTFUL_RMS * self.radius && self.max_abs <= DOUBTFUL_MAX * self.radius)
    }

    pub(crate) fn is_refused(&self) -> bool {
        !(self.rms <= REFUSED_RMS * self.radius)
    }
}

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the surface does not explain all points: residuals of {:.1} mm (root mean square) and up to {:.1} mm at a mean radius of {:.1} mm; remove a table, other objects and outliers from the cloud, or check whether every direction from its mean meets the object once",
            1e3 * self.rms,
            1e3 * self.max_abs,
            1e3 * self.radius
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_residuals_are_doubtful_and_larger_ones_refused() {
        let of = |rms, max_abs| Misfit {
            rms,
            max_abs,
            radius: 0.05,
        };
        assert!(!of(0.002, 0.02).is_doubtful());
        assert!(of(0.003, 0.02).is_doubtful());
        assert!(of(0.002, 0.03).is_doubtful());
        assert!(!of(0.024, 0.03).is_refused() && of(0.026, 0.03).is_refused());
        assert!(of(f64::NAN, 0.0).is_refused());
        assert!(of(0.003, 0.03).to_string().contains("3.0 mm"));
    }
}
