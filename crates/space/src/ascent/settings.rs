//! How our ascent steps and when it stops.

/// Settings of the monotone ascent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonotoneAscent {
    /// Most steps tried, taken or not, from one start.
    pub steps: usize,
    /// Longest move of all contacts together in one step, radians.
    pub largest_move: f64,
    /// Stop when no direction promises a slope above this, per radian.
    pub stationarity: f64,
    /// Stop when the model promises less than this.
    pub least_gain: f64,
    /// New starts when a climb ends open, or from an open start below [`crate::Quality::stable_above`]:
    /// around where it began, ever farther.
    pub restarts: usize,
}

impl Default for MonotoneAscent {
    /// Enough steps for household objects: some 80 qualities an ascent.
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
