//! Numbers that say how well a grasp resists disturbances.

mod epsilon;
mod volume;

pub use epsilon::{
    Epsilon, QualityError, Workspace, epsilon, epsilon_of_wrenches, epsilon_quality,
};
pub use volume::volume;
