//! Climbing in quality on one surface.

mod bundle;
mod monotone;
mod paper;

pub use monotone::MonotoneAscent;
pub use paper::PaperAscent;

use sph::Direction;

/// One state of an ascent, for traces.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// Where the contacts are.
    pub contacts: &'a [Direction],
    /// Q there.
    pub quality: f64,
    /// Slope of Q that is left, per radian: of the one gradient in the paper's ascent, of what all
    /// deciding facets allow in ours; 0 at a maximum.
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
    /// Qualities computed on the way.
    pub evaluations: usize,
}
