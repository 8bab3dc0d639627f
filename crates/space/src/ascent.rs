//! Climbing in quality on one surface.

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
    /// The directions of the contacts.
    pub directions: &'a [Direction],
    /// Q there.
    pub quality: f64,
    /// Slope of Q that is left, per radian: of the one gradient in the paper's ascent, of what all
    /// deciding facets and limits allow in ours (see [`Ascent::stationarity`]); 0 at a maximum.
    pub stationarity: f64,
}

/// Where an ascent ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Ascent {
    /// The directions of the contacts at the end.
    pub directions: Vec<Direction>,
    /// Q at the start.
    pub start_quality: f64,
    /// Q at the end.
    pub quality: f64,
    /// Q at the end, or minus the distance from force closure where the grasp is open.
    pub margin: f64,
    /// Slope of Q left at the end, per radian: the norm of the gradient in the paper's ascent; in
    /// ours |u|/ρ for the u that maximises the least of the linearised facets less |u|²/2ρ within
    /// the limits, ρ = 0.01 (the gradient of the Moreau envelope). 0 exactly at a maximum.
    ///
    /// Q of friction pyramids is discontinuous where their frames are
    /// ([`Quality::discontinuities`]). Those across which the climb found Q to fall count as limits,
    /// so this is the slope on the side where the grasp is: 0 also where Q has no maximum but a
    /// supremum at a discontinuity.
    ///
    /// [`Quality::discontinuities`]: crate::Quality::discontinuities
    pub stationarity: f64,
    /// Qualities computed on the way.
    pub evaluations: usize,
}
