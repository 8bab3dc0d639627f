//! Grasps that were carried from a known object, with the hand that held them there.

use hand::HandState;

use crate::grasp::Grasp;

/// A grasp carried over, and the hand that came along.
#[derive(Clone, Debug)]
pub(crate) struct CarriedGrasp {
    /// The grasp; of quality 0 when it ended open.
    pub(crate) grasp: Grasp,
    /// The hand on the known object, moved rigidly with its contacts; `None` for another hand.
    pub(crate) hand: Option<HandState>,
}

/// The `count` best force-closed ones, the best first.
pub(crate) fn best(mut carried: Vec<CarriedGrasp>, count: usize) -> Vec<CarriedGrasp> {
    carried.retain(|c| c.grasp.quality() > 0.0);
    carried.sort_by(|a, b| b.grasp.quality().total_cmp(&a.grasp.quality()));
    carried.truncate(count);
    carried
}
