//! Ascents: local maximisation of quality on one surface.

mod bundle;
mod climber;
mod discontinuities;
mod monotone;
mod paper;
mod settings;

pub use monotone::AscentError;
pub use paper::PaperAscent;
pub use settings::MonotoneAscent;

use sph::Direction;

/// One state of an ascent, for traces.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// Directions of the contacts.
    pub directions: &'a [Direction],
    /// Q at these directions.
    pub quality: f64,
    /// Slope of Q that remains, per radian; 0 at a maximum. The paper's ascent reports the norm of
    /// its one gradient. Our ascent reports the slope that all near-active facets and limits allow
    /// (see [`Ascent::stationarity`]).
    pub stationarity: f64,
}

/// The result of an ascent.
#[derive(Clone, Debug, PartialEq)]
pub struct Ascent {
    /// Directions of the contacts at the end.
    pub directions: Vec<Direction>,
    /// Q at the start.
    pub start_quality: f64,
    /// Q at the end.
    pub quality: f64,
    /// Q at the end; for an open grasp minus its distance from force closure.
    pub margin: f64,
    /// Slope of Q that remains at the end, per radian; exactly 0 at a maximum.
    ///
    /// The paper's ascent reports the norm of the gradient. Our ascent reports |u|/ρ for the u that
    /// maximises (the least linearised facet) − |u|²/2ρ within the limits, with ρ = 0.01: the
    /// gradient of the Moreau envelope.
    ///
    /// Under friction pyramids Q is discontinuous where their frames are
    /// ([`Quality::discontinuities`]). A discontinuity across which the ascent found Q to fall
    /// counts as a limit, so this is the slope on the side where the grasp is. It is therefore also
    /// 0 where Q has a supremum at a discontinuity and not a maximum.
    ///
    /// [`Quality::discontinuities`]: crate::Quality::discontinuities
    pub stationarity: f64,
    /// Number of qualities computed.
    pub evaluations: usize,
}
