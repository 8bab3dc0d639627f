//! Coefficient vectors β and their algebra.

use crate::index;

/// Why a list of numbers is not a coefficient vector.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CoefficientsError {
    /// The length is not (L+1)² for any L.
    #[error("{length} coefficients are not (L+1)² for any degree L")]
    Length {
        /// Number of values given.
        length: usize,
    },
    /// A value is NaN or infinite.
    #[error("coefficient {position} is {value}; expected a finite number")]
    NotFinite {
        /// Its position l²+l+m.
        position: usize,
        /// The value found.
        value: f64,
    },
}

/// β = (β_{0,0}, β_{1,−1}, …, β_{L,L}): a function on the sphere of degree at most L.
///
/// Since the basis is orthonormal, ‖β‖ is the L² norm of the function (Sec. III-B of the paper).
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    degree: usize,
    values: Vec<f64>,
}

impl Coefficients {
    /// Coefficients from values at positions l²+l+m.
    ///
    /// # Errors
    /// The length is not (L+1)² for any L, or a value is not finite.
    pub fn new(values: Vec<f64>) -> Result<Self, CoefficientsError> {
        let root = values.len().isqrt();
        if root == 0 || root * root != values.len() {
            return Err(CoefficientsError::Length {
                length: values.len(),
            });
        }
        if let Some(position) = values.iter().position(|v| !v.is_finite()) {
            return Err(CoefficientsError::NotFinite {
                position,
                value: values[position],
            });
        }
        Ok(Self {
            degree: root - 1,
            values,
        })
    }

    /// The zero function of a degree.
    pub fn zeros(degree: usize) -> Self {
        Self {
            degree,
            values: vec![0.0; index::count(degree)],
        }
    }

    /// The constant function c: β_{0,0} = c √(4π).
    pub fn constant(degree: usize, c: f64) -> Self {
        let mut beta = Self::zeros(degree);
        beta.values[0] = c * (4.0 * std::f64::consts::PI).sqrt();
        beta
    }

    /// L.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The values, position l²+l+m.
    pub fn as_slice(&self) -> &[f64] {
        &self.values
    }

    /// The values, mutable. The caller must keep them finite.
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// β_{l,m}; 0 for l > L. Needs |m| ≤ l.
    pub fn get(&self, l: usize, m: isize) -> f64 {
        if l > self.degree {
            0.0
        } else {
            self.values[index::position(l, m)]
        }
    }

    /// The function truncated to a lower degree, or the same function at a higher degree.
    pub fn with_degree(&self, degree: usize) -> Self {
        let mut values = self.values.clone();
        values.resize(index::count(degree), 0.0);
        Self { degree, values }
    }

    /// Σ αᵢ βᵢ, of the highest degree among the terms; without terms the zero function of degree 0.
    pub fn combination<'a>(terms: impl IntoIterator<Item = (f64, &'a Self)>) -> Self {
        let mut sum = Self::zeros(0);
        for (weight, beta) in terms {
            if beta.degree > sum.degree {
                sum = sum.with_degree(beta.degree);
            }
            for (s, b) in sum.values.iter_mut().zip(&beta.values) {
                *s += weight * b;
            }
        }
        sum
    }

    /// ‖β₁ − β₂‖ = (∫_{S²} |f₁ − f₂|²)^{1/2}. The degrees may differ.
    ///
    /// ```
    /// use sph::Coefficients;
    ///
    /// let (a, b) = (Coefficients::constant(3, 0.03), Coefficients::constant(3, 0.05));
    /// // A constant function c has the single coefficient c √(4π).
    /// let expected = 0.02 * (4.0 * std::f64::consts::PI).sqrt();
    /// assert!((a.distance(&b) - expected).abs() < 1e-15);
    /// ```
    pub fn distance(&self, other: &Self) -> f64 {
        let shared = self.values.len().min(other.values.len());
        let inside = self.values[..shared].iter().zip(&other.values[..shared]);
        let beyond = self.values[shared..].iter().chain(&other.values[shared..]);
        let squares = inside.map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        (squares + beyond.map(|a| a * a).sum::<f64>()).sqrt()
    }

    /// Power per degree, Σ_m β_{l,m}², l = 0 … L; unchanged by rotations.
    pub fn power_spectrum(&self) -> Vec<f64> {
        (0..=self.degree)
            .map(|l| {
                self.values[l * l..(l + 1) * (l + 1)]
                    .iter()
                    .map(|b| b * b)
                    .sum()
            })
            .collect()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A function with power in every harmonic; identical on every call.
    pub(crate) fn some_coefficients(degree: usize) -> Coefficients {
        let values = (0..index::count(degree)).map(|i| (i as f64 * 1.3).sin());
        Coefficients::new(values.collect()).unwrap()
    }

    #[test]
    fn refuses_wrong_lengths_and_nan() {
        assert!(matches!(
            Coefficients::new(vec![0.0; 5]),
            Err(CoefficientsError::Length { length: 5 })
        ));
        assert!(Coefficients::new(vec![]).is_err());
        assert!(matches!(
            Coefficients::new(vec![1.0, f64::NAN, 0.0, 0.0]),
            Err(CoefficientsError::NotFinite { position: 1, .. })
        ));
    }

    #[test]
    fn combination_and_distance_accept_mixed_degrees() {
        let a = Coefficients::constant(1, 2.0);
        let b = Coefficients::new((0..9).map(f64::from).collect()).unwrap();
        let mix = Coefficients::combination([(0.5, &a), (2.0, &b)]);
        assert_eq!(mix.degree(), 2);
        assert_eq!(mix.get(2, 2), 16.0);
        assert!((a.distance(&b) - a.with_degree(2).distance(&b)).abs() < 1e-15);
        assert_eq!(a.distance(&b), b.distance(&a));
    }
}
