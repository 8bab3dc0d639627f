//! Climbing in quality on one surface.

mod bundle;
mod climber;
mod monotone;
mod paper;
mod settings;
mod walls;

pub use monotone::AscentError;
pub use paper::PaperAscent;
pub use settings::MonotoneAscent;

use sph::Direction;

/// One state of an ascent, for traces.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// Where the contacts are.
    pub contacts: &'a [Direction],
    /// Q there.
    pub quality: f64,
    /// Slope of Q that is left, per radian: of the one gradient in the paper's ascent, of what all
    /// deciding facets and limits allow in ours (see [`Ascent::stationarity`]); 0 at a maximum.
    pub stationarity: f64,
}

/// Where an ascent ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Ascent {
    /// Final contacts.
    pub contacts: Vec<Direction>,
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
    /// Q of friction pyramids jumps where their frames do ([`Quality::walls`]). Jumps over which the
    /// climb found Q to fall count as limits, so this is the slope on the side of the jump where the
    /// grasp is: 0 also where Q has no maximum but a supremum against a jump.
    ///
    /// [`Quality::walls`]: crate::Quality::walls
    pub stationarity: f64,
    /// Qualities computed on the way.
    pub evaluations: usize,
}
