//! Robust quality: a lower bound for every surface near the measured one.
//!
//! Let the true contact i be within ε of the nominal position and its normal within the angle δ of the
//! nominal normal n, and let α = atan μ. Write θ for the angle between a force f and n.
//!
//! **Forces.** If θ ≤ α − δ then f is within α of the true normal n′: the cone of half angle α − δ
//! around n lies in the true friction cone. Of these forces take those with f·n = s,
//!
//!   s = cos(α − δ) / cos(max(α − 2δ, 0)).
//!
//! The angle between f and n′ is at least max(θ − δ, 0), so f·n′ ≤ |f| cos max(θ − δ, 0) =
//! s cos max(θ − δ, 0) / cos θ. That is largest at θ = α − δ (below δ it grows as 1/cos θ; above, the
//! derivative of cos(θ − δ)/cos θ is sin δ/cos² θ ≥ 0), where it is one. So f is a force of the true
//! contact with a normal component of one at most.
//!
//! **Torques.** The torque of f at the true position differs from that at the nominal one by at most
//! ε |f| / L ≤ ε s √(1 + tan²(α − δ)) / L = ε / (L cos max(α − 2δ, 0)).
//!
//! **Hulls.** Let D′ be the hull of the true wrenches of normal component one and H′ that of D′ and the
//! origin. Every wrench of the reduced cones is within η = max ε s √(1 + tan²(α − δ)) / L of H′. If the
//! ball of radius Q₀ lies in the hull of the reduced cones, the support function of H′ is at least
//! Q₀ − η. If that is positive the origin is inside H′; then it is inside D′ too, for otherwise D′ and
//! with it H′ would lie in a half-space u·w ≤ 0; so H′ = D′ and the true quality is at least Q₀ − η.
//!
//! **Conventions.** Edges of unit length scale forces, s and η alike by 1/√(1 + μ²). A pyramid of k
//! edges holds the round cone of μ cos(π/k) in whatever frame, so μ cos(π/k) takes the place of μ; the
//! reduced cones are round. If the torque length is the largest distance of a contact from the centre,
//! the true one may be longer by max ε, which costs a factor L/(L + max ε).
//!
//! **Contact models.** A soft contact allows |f_t| ≤ μ cos ψ f_n′ together with |τ| ≤ γ sin ψ f_n′ for
//! any ψ; ψ = 45° is taken, with f_n′ ≥ s cos α′/cos(α′ − δ), α′ = atan(μ cos ψ). The axis of the torque
//! is n′ instead of n, which adds 2 sin(δ/2) τ/L to η. A patch counts as a point contact in its middle,
//! whose wrenches are means of those of its corners.

use super::epsilon::QualityError;
use super::workspace::Workspace;
use crate::cone::{Cone, Limits};
use crate::contact_model::ContactModel;
use crate::convention::{EdgeNorm, Edges, TorqueLength};
use crate::grasp_model::GraspModel;
use crate::wrench::WrenchError;

/// How well a contact is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uncertainty {
    /// No true contact is farther from the nominal position, in the unit of the positions; ≥ 0.
    pub position: f64,
    /// No true normal makes a larger angle with the nominal one, in radians; 0 to π.
    pub normal: f64,
}

/// The width of the interval in which the quality of the reduced cones is sought, in units of quality.
const GAP: f64 = 1e-4;

/// A lower bound of the epsilon quality on **every** surface whose contacts and normals lie within
/// `uncertainty` of those of the model, one entry per contact; 0 where no quality is certain.
///
/// The proof is in the module's documentation: cones reduced by the angle of the normals, scaled so that
/// no true normal component exceeds one, less what the torques may move by. A contact whose normal is
/// as uncertain as its friction cone is wide carries nothing, so a grasp on edges has a robust quality
/// of 0. The bound loses up to 1e-4 to the search. Costs one search with round cones.
///
/// # Errors
/// As `epsilon`, and if there is another number of uncertainties than of contacts or one is out of range.
pub fn robust_quality(
    model: &GraspModel<'_>,
    uncertainty: &[Uncertainty],
    workspace: &mut Workspace,
) -> Result<f64, QualityError> {
    let length = model.validate()?;
    validate(model, uncertainty)?;
    workspace.start_cones(model)?;
    let mut moved = 0.0_f64;
    let mut farthest = 0.0_f64;
    for (contact, known) in uncertainty.iter().enumerate() {
        farthest = farthest.max(known.position);
        let Some(reduced) = reduce(model, contact, known.normal) else {
            continue;
        };
        moved = moved.max(known.position * reduced.force + reduced.twist);
        let cone = Cone::with_limits(model, contact, [0.0, 0.0], reduced.limits, length);
        workspace.add_cone(cone);
    }
    if workspace.cones.len() < 2 {
        return Ok(0.0);
    }
    let ball = workspace.round_ball(GAP);
    let shrunk = match model.convention.torque_length {
        TorqueLength::Metres(_) => 1.0,
        TorqueLength::MaxContactDistance => length / (length + farthest),
    };
    Ok(((ball.lower - moved / length) * shrunk).max(0.0))
}

fn validate(model: &GraspModel<'_>, uncertainty: &[Uncertainty]) -> Result<(), WrenchError> {
    let (contacts, given) = (model.contacts.len(), uncertainty.len());
    if contacts != given {
        return Err(WrenchError::Uncertainties { contacts, given });
    }
    let bad = |u: &Uncertainty| {
        let angle = (0.0..=std::f64::consts::PI).contains(&u.normal);
        !(angle && (0.0..f64::INFINITY).contains(&u.position))
    };
    match uncertainty.iter().position(bad) {
        Some(index) => Err(WrenchError::Uncertainty {
            index,
            position: uncertainty[index].position,
            normal: uncertainty[index].normal,
        }),
        None => Ok(()),
    }
}

/// A cone inside all admissible ones.
struct Reduced {
    limits: Limits,
    /// The longest force.
    force: f64,
    /// How far the torque about the normal may be off.
    twist: f64,
}

/// The cone of one contact for normals within `delta`; None if it carries nothing.
fn reduce(model: &GraspModel<'_>, contact: usize, delta: f64) -> Option<Reduced> {
    let contact_model = model.contact_model(contact);
    let mut friction = contact_model.friction();
    let scale = match model.convention.edge_norm {
        EdgeNorm::UnitNormalComponent => 1.0,
        EdgeNorm::UnitLength => 1.0 / friction.hypot(1.0),
    };
    if let Edges::Polygon(count) = model.convention.edges {
        friction *= (std::f64::consts::PI / count as f64).cos();
    }
    let mut gamma = 0.0;
    if let ContactModel::Soft { torsion, .. } = contact_model {
        friction *= std::f64::consts::FRAC_1_SQRT_2;
        gamma = torsion * std::f64::consts::FRAC_1_SQRT_2;
    }
    let alpha = friction.atan();
    if delta > alpha || (delta >= alpha && alpha > 0.0) {
        return None;
    }
    let most = (alpha - 2.0 * delta).max(0.0).cos();
    let unit = scale * (alpha - delta).cos() / most;
    // The torsion of the ellipsoid is per unit of its normal force.
    let torsion = gamma * alpha.cos() / (alpha - delta).cos();
    Some(Reduced {
        limits: Limits {
            unit,
            friction: (alpha - delta).tan(),
            torsion,
        },
        force: scale / most,
        twist: 2.0 * (0.5 * delta).sin() * torsion * unit,
    })
}
