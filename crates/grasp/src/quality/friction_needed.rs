//! The least friction with which a grasp can hold anything.

use super::epsilon::QualityError;
use super::workspace::Workspace;
use crate::convention::Convention;
use crate::grasp_model::GraspModel;
use crate::hull::min_norm::Nearest;
use crate::wrench::WrenchError;
use nalgebra::Vector3;

/// The friction coefficients at which a grasp begins to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionNeeded {
    /// The least μ at which the contacts can be in balance at all: forces in their cones, not all
    /// zero, that add up to no force and no torque. None if they cannot up to the largest μ asked for.
    pub balance: Option<f64>,
    /// The least μ above which the grasp is force-closed; None if it is not up to the largest μ.
    pub closure: Option<f64>,
}

/// Both are found to this, relatively.
const RELATIVE: f64 = 1e-9;
/// Contacts with a smaller share of the balance do not count as taking part.
const SHARE: f64 = 1e-6;
/// Contacts whose positions are nearer to one line than this, relative to their spread, lie on it.
const COLLINEAR: f64 = 1e-6;

/// How much friction a grasp needs, up to a relative 1e-9 and between 0 and `largest`.
///
/// Point contacts with one common μ are meant; contact models are ignored. Cones grow with μ, so both
/// numbers are found by bisection, balance by the distance of the origin from the hull of the wrenches.
/// If three contacts that do not lie on one line take part in the balance, the grasp is closed as soon
/// as μ exceeds it, because their forces are then inside their cones and their wrenches span R⁶; otherwise
/// closure is found by bisection too. Some tens of microseconds, a few hundred in the second case.
///
/// # Errors
/// As `epsilon`, with `largest` for the friction.
pub fn friction_needed(
    model: &GraspModel<'_>,
    largest: f64,
    workspace: &mut Workspace,
) -> Result<FrictionNeeded, QualityError> {
    let none = FrictionNeeded {
        balance: None,
        closure: None,
    };
    let mut convention = Convention {
        friction: largest,
        ..model.convention.clone()
    };
    let mut carried = false;
    let balance = bisect(0.0, largest, |friction| {
        load(model, &mut convention, friction, workspace)?;
        let balanced = balanced(workspace);
        if balanced {
            carried = carries(model, workspace);
        }
        Ok(balanced)
    })?;
    let Some(balance) = balance else {
        return Ok(none);
    };
    if carried {
        return Ok(FrictionNeeded {
            balance: Some(balance),
            closure: Some(balance),
        });
    }
    let closure = bisect(balance * (1.0 - RELATIVE), largest, |friction| {
        load(model, &mut convention, friction, workspace)?;
        Ok(workspace.ball(f64::INFINITY).closed)
    })?;
    Ok(FrictionNeeded {
        balance: Some(balance),
        closure,
    })
}

fn load(
    model: &GraspModel<'_>,
    convention: &mut Convention,
    friction: f64,
    workspace: &mut Workspace,
) -> Result<(), WrenchError> {
    convention.friction = friction;
    workspace.load(&GraspModel {
        convention,
        contact_models: &[],
        ..*model
    })
}

/// The least number in (low, high] at which `holds`, which stays true above it.
fn bisect(
    mut low: f64,
    mut high: f64,
    mut holds: impl FnMut(f64) -> Result<bool, WrenchError>,
) -> Result<Option<f64>, WrenchError> {
    if !holds(high)? {
        return Ok(None);
    }
    while high - low > RELATIVE * high {
        let middle = 0.5 * (low + high);
        if middle <= f64::MIN_POSITIVE {
            break;
        }
        if holds(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    // The last question is the one whose answer is returned.
    holds(high)?;
    Ok(Some(high))
}

/// Whether the origin lies in the hull of the wrenches, up to rounding.
fn balanced(workspace: &mut Workspace) -> bool {
    let tolerance = workspace.rounding();
    match workspace.separate(tolerance) {
        Nearest::Inside => true,
        Nearest::Outside { floor, .. } => floor <= tolerance,
    }
}

/// Whether contacts off a common line take part in the balance that was found last.
fn carries(model: &GraspModel<'_>, workspace: &Workspace) -> bool {
    let corral = &workspace.search.corral;
    let share = |contact: usize| {
        let own = (0..corral.len).filter(|&k| workspace.owner(corral.tags[k]) == contact);
        own.map(|k| corral.weights[k]).sum::<f64>()
    };
    let place = |contact: usize| model.contacts[contact].position.coords - model.centre.coords;
    let mut taking = (0..model.contacts.len()).filter(|&c| share(c) > SHARE);
    let Some(first) = taking.next() else {
        return false;
    };
    let arms = || {
        (0..model.contacts.len())
            .filter(|&c| share(c) > SHARE)
            .map(|c| place(c) - place(first))
    };
    let longest = arms().fold(Vector3::zeros(), |best: Vector3<f64>, arm| {
        if arm.norm() > best.norm() { arm } else { best }
    });
    arms().any(|arm| arm.cross(&longest).norm() > COLLINEAR * longest.norm_squared())
}
