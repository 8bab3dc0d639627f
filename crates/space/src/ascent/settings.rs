//! Settings of the monotone ascent.

/// Step lengths, stopping rules and restarts of the monotone ascent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonotoneAscent {
    /// Largest number of trial steps from one start, accepted or rejected.
    pub steps: usize,
    /// Largest norm of the moves of all contacts together in one step, radians.
    pub largest_move: f64,
    /// The ascent stops when the model's slope is at most this, per radian.
    pub stationarity: f64,
    /// The ascent stops when the predicted gain is at most this.
    pub least_gain: f64,
    /// Largest number of restarts, at growing distance around the first start. They are made when
    /// an ascent ends open, or when it began open and ended below [`crate::Quality::stable_above`].
    pub restarts: usize,
}

impl Default for MonotoneAscent {
    /// Enough steps for household objects: about 80 qualities per ascent.
    fn default() -> Self {
        Self {
            steps: 200,
            largest_move: 0.3,
            stationarity: 1e-4,
            least_gain: 1e-7,
            restarts: 8,
        }
    }
}
