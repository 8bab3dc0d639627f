//! The space of shapes: convex combinations, cones, deformations and the distance of M^rad.

use sph::Coefficients;
use sph::bounds::Range;

use crate::radial::RadialShape;

/// Why weights do not combine shapes inside M^rad.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpaceError {
    /// One weight per shape is needed, and at least one shape.
    #[error("{weights} weights for {shapes} shapes")]
    Counts {
        /// Number of weights.
        weights: usize,
        /// Number of shapes.
        shapes: usize,
    },
    /// A weight is negative, NaN or infinite, or all are zero.
    #[error("weight {index} is {value}; expected finite weights ≥ 0, one of them positive")]
    Weight {
        /// Which weight.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Weights of a convex combination add up to one.
    #[error("the weights add up to {sum}; a convex combination needs 1")]
    Sum {
        /// Their sum.
        sum: f64,
    },
}

/// Σ αᵢ fᵢ with αᵢ ≥ 0, not all zero: a point of Cone(X).
///
/// By Lemma 3.2 of the paper the sum is in M^rad, and its certified bounds are the sums of the
/// bounds; nothing is certified again.
pub fn cone(weights: &[f64], shapes: &[&RadialShape]) -> Result<RadialShape, SpaceError> {
    if weights.len() != shapes.len() || shapes.is_empty() {
        return Err(SpaceError::Counts {
            weights: weights.len(),
            shapes: shapes.len(),
        });
    }
    let bad = |w: &f64| !(w.is_finite() && *w >= 0.0);
    let all_zero = weights.iter().all(|w| *w == 0.0);
    if let Some(index) = weights.iter().position(bad).or(all_zero.then_some(0)) {
        return Err(SpaceError::Weight {
            index,
            value: weights[index],
        });
    }
    let terms = || weights.iter().zip(shapes);
    let beta = Coefficients::combination(terms().map(|(w, s)| (*w, s.coefficients())));
    let sum = |pick: fn(&Range) -> f64| terms().map(|(w, s)| w * pick(&s.range())).sum::<f64>();
    let range = Range {
        lower: sum(|r| r.lower),
        upper: sum(|r| r.upper),
        seen_lower: sum(|r| r.seen_lower),
        seen_upper: sum(|r| r.seen_upper),
    };
    Ok(RadialShape::with_range(beta, range))
}

/// Σ αᵢ fᵢ with αᵢ ≥ 0 and Σ αᵢ = 1 (to 1e-9): a point of Conv(X).
pub fn convex_combination(
    weights: &[f64],
    shapes: &[&RadialShape],
) -> Result<RadialShape, SpaceError> {
    let sum: f64 = weights.iter().sum();
    let off = (sum - 1.0).abs();
    if off.is_nan() || off > 1e-9 {
        return Err(SpaceError::Sum { sum });
    }
    cone(weights, shapes)
}

/// γ(t) = (1−t) f₁ + t f₂ for 0 ≤ t ≤ 1 (Sec. III-A).
pub fn deformation(
    from: &RadialShape,
    to: &RadialShape,
    t: f64,
) -> Result<RadialShape, SpaceError> {
    convex_combination(&[1.0 - t, t], &[from, to])
}

/// d(f₁,f₂) = (∫_{S²} |r₁−r₂|²)^{1/2} = ‖β₁−β₂‖ (Sec. III-B), metres.
pub fn distance(a: &RadialShape, b: &RadialShape) -> f64 {
    a.coefficients().distance(b.coefficients())
}

/// Indices of `library` by distance from `shape`, nearest first, with the distances in metres.
pub fn nearest(shape: &RadialShape, library: &[&RadialShape]) -> Vec<(usize, f64)> {
    let mut order: Vec<(usize, f64)> = library
        .iter()
        .enumerate()
        .map(|(i, other)| (i, distance(shape, other)))
        .collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    order
}
