//! Epsilon quality (Ferrari and Canny's L¹): the largest ball around the origin in the hull.

use super::workspace::{Workspace, requested_gap};
use crate::convention::Convention;
use crate::grasp_model::GraspModel;
use crate::hull::HullError;
use crate::hull::search::Ball;
use crate::wrench::{Wrench, WrenchError};
use thiserror::Error;

/// The epsilon quality of a grasp as a certified interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Epsilon {
    /// The radius of the largest origin-centred ball inside the hull of the wrenches, 0 when the
    /// grasp is not force-closed: the best estimate in the interval where the search converged, its
    /// lower end where it did not.
    pub quality: f64,
    /// Proved to be no larger than the true radius.
    pub lower: f64,
    /// Proved to be no smaller than the true radius.
    pub upper: f64,
    /// Whether `lower` is positive: the origin lies strictly inside and the grasp resists any small
    /// wrench.
    pub closed: bool,
    /// Whether the interval is as narrow as the convention asks for. If not, the search met a limit of
    /// its size, and `quality` is `lower`.
    pub converged: bool,
    /// The unit wrench direction in which the hull reaches only `upper` far; where the grasp is not
    /// closed, one along which it can push not at all.
    pub direction: Wrench,
}

impl Epsilon {
    /// The number that the convention prints: `not_closed` in place of 0.
    pub fn value(&self, convention: &Convention) -> f64 {
        if self.closed {
            self.quality
        } else {
            convention.not_closed
        }
    }

    pub(crate) fn from_ball(ball: &Ball) -> Self {
        Epsilon {
            quality: if ball.closed { ball.quality } else { 0.0 },
            lower: ball.lower,
            upper: ball.upper,
            closed: ball.closed,
            converged: ball.converged,
            direction: ball.direction.into(),
        }
    }
}

/// The epsilon quality Q = min over unit u of max_ij w_ij·u, 0 when that is negative.
///
/// Polygonal cones give the exact radius (an interval of some ulps of the longest wrench), round
/// cones an interval of the width that the convention asks for. The result does not depend on the
/// order of the contacts, and coplanar or repeated wrenches need no special care. A closed grasp of
/// three contacts and eight edges costs some ten microseconds, an open one about one.
pub fn epsilon(model: &GraspModel<'_>, workspace: &mut Workspace) -> Result<Epsilon, QualityError> {
    workspace.load_next(model)?;
    let ball = workspace.ball(requested_gap(model.convention.edges));
    Ok(Epsilon::from_ball(&ball))
}

/// The epsilon quality of a plain list of wrenches, whatever they come from.
pub fn epsilon_of_wrenches(
    wrenches: &[Wrench],
    workspace: &mut Workspace,
) -> Result<Epsilon, QualityError> {
    if let Some(index) = wrenches
        .iter()
        .position(|w| !w.iter().all(|x| x.is_finite()))
    {
        return Err(HullError::NotFinite { index }.into());
    }
    if wrenches.is_empty() {
        return Err(HullError::Flat.into());
    }
    workspace.load_wrenches(wrenches);
    Ok(Epsilon::from_ball(&workspace.ball(0.0)))
}

/// Why a grasp has no quality.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum QualityError {
    /// The grasp has no wrenches.
    #[error(transparent)]
    Wrench(#[from] WrenchError),
    /// The hull could not be built.
    #[error(transparent)]
    Hull(#[from] HullError),
}
