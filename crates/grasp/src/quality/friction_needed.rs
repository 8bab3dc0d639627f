//! The least friction with which a grasp can hold anything.

use super::epsilon::QualityError;
use super::workspace::Workspace;
use crate::convention::{Convention, EdgeNorm};
use crate::grasp_model::GraspModel;
use crate::hull::min_norm::Nearest;
use crate::hull::plane::{V6, norm, scale};
use crate::wrench::Wrench;
use nalgebra::Vector3;

/// The friction coefficients at which a grasp begins to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionNeeded {
    /// The least μ found at which the contacts can be in balance: forces in their cones, not all zero,
    /// that add up to no force and no torque. None if they cannot up to the largest μ asked for.
    pub balance: Option<f64>,
    /// The least μ above which the grasp is force-closed; None if it is not up to the largest μ.
    pub closure: Option<f64>,
    /// What proves that less friction does not balance the contacts.
    pub no_balance_below: FrictionBound,
    /// What proves that less friction does not close the grasp.
    pub no_closure_below: FrictionBound,
}

/// A proof that the contacts need at least this friction.
///
/// With n the wrench of a unit normal force and T those of the unit tangents, max (n·u + μ |Tᵀu|) over the
/// contacts is the farthest that wrenches reach along the direction u. It is negative for every μ below
/// `friction`, so these wrenches cannot balance (for closure: not positive, so that some wrench along u
/// cannot be resisted). For pyramids |Tᵀu| is the largest height of the edges.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionBound {
    /// The proved lower end of the friction needed, up to rounding; not more than the largest friction
    /// asked for. It is within a relative 1e-9 of the friction needed, except where contacts take part in
    /// the balance with a share that vanishes at it.
    pub friction: f64,
    /// The unit vector u; zero where the bound is 0.
    pub direction: Wrench,
}

/// Both are found to this, relatively.
const RELATIVE: f64 = 1e-9;
/// Most evaluations of one search; about ten suffice.
const MOST: usize = 200;
/// Every so many evaluations the interval is halved.
const HALVED: usize = 5;
/// Wrenches whose weighted sum is shorter than this, relative to the longest wrench, are in balance.
const BALANCED: f64 = 1e-11;
/// Contacts with a smaller share of the balance do not count as taking part.
const SHARE: f64 = 1e-6;
/// Contacts whose positions are nearer to one line than this, relative to their spread, lie on it.
const COLLINEAR: f64 = 1e-6;

/// How much friction a grasp needs, up to a relative 1e-9 and between 0 and `largest`.
///
/// Point contacts with one common μ are meant; contact models are ignored. Below `balance` a direction
/// proves that the wrenches cannot be in balance, and at `balance` the weights of wrenches whose sum
/// vanishes prove that they can. A direction u that separates the wrenches at one μ still separates them
/// at all smaller than min −(n·u)/|Tᵀu| (Dinkelbach); the distance of the origin from the hull says
/// which μ to try next (secant).
///
/// **Closure.** For every larger μ the forces of the balance are inside their cones. If their contacts do not
/// lie on one line, their wrenches span R⁶ and the grasp is closed. If they lie on one line, they span the
/// wrenches without a torque about it, and the grasp is closed as soon as other contacts can make torques
/// of both signs about the line: from the larger of the two numbers min −(n·u)/|Tᵀu|, u being either
/// torque. Costs about a hundred microseconds, a few hundred where the share of a contact vanishes.
///
/// # Errors
/// As `epsilon`, with `largest` for the friction.
pub fn friction_needed(
    model: &GraspModel<'_>,
    largest: f64,
    workspace: &mut Workspace,
) -> Result<FrictionNeeded, QualityError> {
    let convention = Convention {
        friction: largest,
        edge_norm: EdgeNorm::UnitNormalComponent,
        ..model.convention.clone()
    };
    let model = GraspModel {
        convention: &convention,
        contact_models: &[],
        ..*model
    };
    let length = model.validate()?;
    workspace.load_for_friction(&model)?;
    let mut carriers = Carriers::None;
    let (balance, below) = least(workspace, 0.0, largest, |workspace| {
        let apart = apart(workspace);
        if apart.is_none() {
            carriers = Carriers::of(&model, length, workspace);
        }
        apart
    });
    let mut needed = FrictionNeeded {
        balance,
        closure: None,
        no_balance_below: below,
        no_closure_below: below,
    };
    let Some(balance) = balance else {
        return Ok(needed);
    };
    let (closure, bound) = match carriers {
        Carriers::Spanning => (Some(balance), below),
        Carriers::OnLine { torque } => about_line(workspace, balance, largest, &torque),
        Carriers::None => least(workspace, balance, largest, |workspace| {
            let ball = workspace.ball(f64::INFINITY);
            (!ball.closed).then_some((ball.direction, 0.0))
        }),
    };
    needed.closure = closure;
    if bound.friction > below.friction {
        needed.no_closure_below = bound;
    }
    Ok(needed)
}

/// The least friction from `low` to `largest` at which `against` has no direction to object with, and
/// what proves that there is none below. `against` also returns the distance of the origin from the hull,
/// 0 if it does not know it. The last evaluation is the one of the result.
fn least(
    workspace: &mut Workspace,
    from: f64,
    largest: f64,
    mut against: impl FnMut(&mut Workspace) -> Option<(V6, f64)>,
) -> (Option<f64>, FrictionBound) {
    let mut bound = FrictionBound {
        friction: from,
        direction: Wrench::zeros(),
    };
    let (mut low, mut high, mut next) = (from, f64::INFINITY, from);
    let mut before: Option<(f64, f64)> = None;
    for step in 1..MOST {
        workspace.set_friction(next);
        let mut guess = None;
        match against(workspace) {
            None => {
                high = next;
                if high - low <= RELATIVE * high {
                    return (Some(high), bound);
                }
            }
            Some((direction, distance)) => {
                let until = workspace.separates_until(&direction).min(largest);
                if until > bound.friction {
                    let direction = direction.into();
                    bound = FrictionBound {
                        friction: until,
                        direction,
                    };
                }
                low = low.max(next).max(until);
                if low >= largest {
                    return (None, bound);
                }
                guess = before.map(|(at, d)| next + distance * (next - at) / (d - distance));
                before = Some((next, distance));
            }
        }
        let ahead = (low * (1.0 + 0.5 * RELATIVE)).max(f64::MIN_POSITIVE);
        next = match guess {
            _ if step % HALVED == 0 && high.is_finite() => 0.5 * (low + high),
            _ if step % HALVED == 0 => (10.0 * low).clamp(1e-3 * largest, largest),
            Some(guess) if guess > ahead => (guess * (1.0 + 0.5 * RELATIVE)).min(largest),
            _ => ahead,
        };
        if next >= high {
            next = if ahead < high {
                ahead.max(0.5 * (low + high))
            } else {
                high
            };
        }
    }
    (high.is_finite().then_some(high), bound)
}

/// A direction along which all wrenches are negative, and the distance of the origin from their hull;
/// none where wrenches are in balance, up to rounding. Where rounding leaves both open, the contacts
/// count as not in balance.
fn apart(workspace: &mut Workspace) -> Option<(V6, f64)> {
    let balanced = BALANCED * workspace.reach();
    match workspace.nearest() {
        Nearest::Outside { point, .. } if norm(&point) > balanced => {
            let distance = norm(&point);
            Some((scale(&point, -1.0 / distance), distance))
        }
        _ => None,
    }
}

/// From when contacts beside a line make torques of both signs about it.
fn about_line(
    workspace: &Workspace,
    balance: f64,
    largest: f64,
    torque: &V6,
) -> (Option<f64>, FrictionBound) {
    // A little more than the largest friction, where the torque is never reached.
    let beyond = largest.next_up();
    let bounds = [1.0, -1.0].map(|sign| {
        let direction = scale(torque, sign);
        FrictionBound {
            friction: workspace.separates_until(&direction).min(beyond),
            direction: direction.into(),
        }
    });
    let [one, other] = bounds;
    let bound = if one.friction >= other.friction {
        one
    } else {
        other
    };
    let closure = bound.friction.max(balance);
    ((closure <= largest).then_some(closure), bound)
}

/// The contacts that take part in a balance.
enum Carriers {
    /// They do not lie on one line.
    Spanning,
    /// They lie on one line; the unit wrench of a torque about it.
    OnLine { torque: V6 },
    /// They lie at one point.
    None,
}

impl Carriers {
    /// Those of the balance that was found last.
    fn of(model: &GraspModel<'_>, length: f64, workspace: &Workspace) -> Self {
        let corral = &workspace.search.corral;
        let share = |contact: usize| {
            let own = (0..corral.len).filter(|&k| workspace.owner(corral.tags[k]) == contact);
            own.map(|k| corral.weights[k]).sum::<f64>()
        };
        let place = |contact: usize| model.contacts[contact].position - model.centre;
        let taking = || (0..model.contacts.len()).filter(|&c| share(c) > SHARE);
        let Some(first) = taking().next().map(place) else {
            return Carriers::None;
        };
        let arms = || taking().map(|c| place(c) - first);
        let longest = arms().fold(Vector3::zeros(), |best: Vector3<f64>, arm| {
            if arm.norm() > best.norm() { arm } else { best }
        });
        if arms().any(|arm| arm.cross(&longest).norm() > COLLINEAR * longest.norm_squared()) {
            return Carriers::Spanning;
        }
        let Some(line) = longest.try_normalize(0.0) else {
            return Carriers::None;
        };
        // line · (torque − first × force), where a wrench holds torque / length.
        let (f, t) = (first.cross(&line), line * length);
        let torque = [f.x, f.y, f.z, t.x, t.y, t.z];
        Carriers::OnLine {
            torque: scale(&torque, 1.0 / norm(&torque)),
        }
    }
}
