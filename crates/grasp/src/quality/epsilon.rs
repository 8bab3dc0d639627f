//! Epsilon quality (Ferrari and Canny's L¹): the largest ball around the origin in the hull.

use crate::contact::{Contact, Grasp};
use crate::convention::Convention;
use crate::hull::HullError;
use crate::hull::min_norm::PointList;
use crate::hull::plane::{V6, add_scaled, norm};
use crate::hull::search::{Ball, Search};
use crate::wrench::{Wrench, WrenchError, wrenches_into};
use nalgebra::Point3;
use thiserror::Error;

/// Scratch of quality computations: make one for each thread and pass it to every call.
///
/// It grows to the largest grasp seen and then no call allocates.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    wrenches: Vec<Wrench>,
    points: Vec<V6>,
    search: Search,
}

impl Workspace {
    /// Empty scratch.
    pub fn new() -> Self {
        Self::default()
    }
}

/// The epsilon quality of a grasp as a certified interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Epsilon {
    /// The radius of the largest origin-centred ball inside the hull of the wrenches, 0 when the
    /// grasp is not force-closed. The lower end of the interval.
    pub quality: f64,
    /// No larger than the true radius.
    pub lower: f64,
    /// No smaller than the true radius.
    pub upper: f64,
    /// Whether the origin lies strictly inside: the grasp resists any small wrench.
    pub closed: bool,
    /// The unit wrench direction in which the grasp is weakest; where it is not closed, one along
    /// which it can push not at all.
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

    fn from_ball(ball: &Ball) -> Self {
        match *ball {
            Ball::Open { direction } => Epsilon {
                quality: 0.0,
                lower: 0.0,
                upper: 0.0,
                closed: false,
                direction: direction.into(),
            },
            Ball::Closed {
                lower,
                upper,
                direction,
                ..
            } => Epsilon {
                quality: lower,
                lower,
                upper,
                closed: true,
                direction: direction.into(),
            },
        }
    }
}

/// The epsilon quality Q = min over unit u of max_ij w_ij·u, 0 when that is negative.
pub fn epsilon(
    contacts: &[Contact],
    centre: &Point3<f64>,
    convention: &Convention,
    workspace: &mut Workspace,
) -> Result<Epsilon, QualityError> {
    let mut wrenches = std::mem::take(&mut workspace.wrenches);
    let filled = wrenches_into(contacts, centre, convention, &mut wrenches);
    let result = filled
        .map_err(QualityError::from)
        .map(|()| epsilon_of_wrenches(&wrenches, workspace));
    workspace.wrenches = wrenches;
    result
}

/// The same for a plain list of wrenches (finite numbers), whatever they come from.
pub fn epsilon_of_wrenches(wrenches: &[Wrench], workspace: &mut Workspace) -> Epsilon {
    workspace.points.clear();
    workspace
        .points
        .extend(wrenches.iter().map(|w| V6::from(*w)));
    let points = &workspace.points;
    let reach = points.iter().map(norm).fold(0.0, f64::max);
    let toward = points.iter().fold([0.0; 6], |s, p| add_scaled(&s, 1.0, p));
    let mut source = PointList(points);
    let ball = workspace.search.ball(&mut source, &toward, reach, 0.0);
    Epsilon::from_ball(&ball)
}

/// The number that the convention prints for a grasp, with scratch of its own.
pub fn epsilon_quality(grasp: &Grasp, convention: &Convention) -> Result<f64, QualityError> {
    let mut workspace = Workspace::new();
    let found = epsilon(&grasp.contacts, &grasp.centre, convention, &mut workspace)?;
    Ok(found.value(convention))
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
