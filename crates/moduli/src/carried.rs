//! Grasps transferred from a known object, with the hand that held them there.

use hand::HandState;

use crate::grasp::Grasp;

/// A transferred grasp and its hand.
#[derive(Clone, Debug)]
pub(crate) struct CarriedGrasp {
    /// The grasp; its quality is 0 if it ended open.
    pub(crate) grasp: Grasp,
    /// The hand on the known object, moved rigidly with its contacts; `None` if the grasp was made
    /// by another hand.
    pub(crate) hand: Option<HandState>,
}

/// The `count` best force-closed grasps, the best first.
pub(crate) fn best(mut carried: Vec<CarriedGrasp>, count: usize) -> Vec<CarriedGrasp> {
    carried.retain(|c| c.grasp.quality() > 0.0);
    carried.sort_by(|a, b| b.grasp.quality().total_cmp(&a.grasp.quality()));
    carried.truncate(count);
    carried
}
