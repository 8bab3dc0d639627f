//! Derivatives of quality by the contacts' coordinates.

use grasp::{Contact, QualityError};
use shape::Surface;

use crate::chart::from_pair;
use crate::objective::Objective;
use crate::point::contact_on;

/// Forward differences of Q in the chart (θ,φ): (Q(x+δeᵢ) − Q(x))/δ (Sec. IV-D).
///
/// `contacts` are those at `angles`, and `here` is their Q; both are unchanged on return. Costs one
/// quality per angle; only the contact that moves is realised again.
///
/// # Errors
/// A quality cannot be computed.
pub fn forward_differences(
    surface: &impl Surface,
    angles: &[f64],
    contacts: &mut [Contact],
    here: f64,
    delta: f64,
    objective: &mut Objective,
    gradient: &mut [f64],
) -> Result<(), QualityError> {
    for (i, slope) in gradient.iter_mut().enumerate() {
        let finger = i / 2;
        let mut pair = [angles[2 * finger], angles[2 * finger + 1]];
        pair[i % 2] += delta;
        let kept = contacts[finger];
        contacts[finger] = contact_on(surface, &from_pair(&pair));
        let there = objective.quality(contacts);
        contacts[finger] = kept;
        *slope = (there? - here) / delta;
    }
    Ok(())
}
