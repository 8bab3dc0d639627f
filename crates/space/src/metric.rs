//! The two metrics of Sec. III-C: on grasps, and on shapes together with grasps.

use grasp::{ContactCounts, Grasp};
use shape::{RadialShape, SphericalShape, algebra};

/// Why two points have no distance.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MetricError {
    /// The weight is not in [0, 1].
    #[error("weight {weight}; expected a number in [0, 1]")]
    Weight {
        /// The weight given.
        weight: f64,
    },
    /// The grasps have different numbers of contacts.
    #[error(transparent)]
    Contacts(#[from] ContactCounts),
}

/// w d(f, f′) + (1−w) d(g, g′) with w ∈ [0, 1].
///
/// d(f, f′) = ‖β−β′‖, and d(g, g′) is the largest change of a contact, a normal or the centre
/// ([`grasp::distance`]). As in the paper, metres and unit normals are added without scaling.
///
/// # Errors
/// The weight is outside [0, 1], or the numbers of contacts differ.
pub fn distance(
    weight: f64,
    (shape_a, grasp_a): (&RadialShape, &Grasp),
    (shape_b, grasp_b): (&RadialShape, &Grasp),
) -> Result<f64, MetricError> {
    weighted(
        weight,
        algebra::distance(shape_a, shape_b),
        grasp_a,
        grasp_b,
    )
}

/// The same on M^sph × (S²)^m, with d(f, f′) = (∫ |f−f′|²)^{1/2}.
///
/// # Errors
/// As [`distance`].
pub fn distance_spherical(
    weight: f64,
    (shape_a, grasp_a): (&SphericalShape, &Grasp),
    (shape_b, grasp_b): (&SphericalShape, &Grasp),
) -> Result<f64, MetricError> {
    weighted(weight, shape_a.distance(shape_b), grasp_a, grasp_b)
}

fn weighted(
    weight: f64,
    shapes: f64,
    grasp_a: &Grasp,
    grasp_b: &Grasp,
) -> Result<f64, MetricError> {
    if !(0.0..=1.0).contains(&weight) {
        return Err(MetricError::Weight { weight });
    }
    let grasps = grasp::distance(grasp_a, grasp_b)?;
    Ok(weight * shapes + (1.0 - weight) * grasps)
}
