//! Numbers that say how well a grasp resists disturbances.

mod epsilon;
mod margin;
mod volume;
mod workspace;

pub use epsilon::{
    BatchError, Epsilon, QualityError, epsilon, epsilon_batch, epsilon_of, epsilon_of_wrenches,
    epsilon_quality,
};
pub use margin::{ActiveFacet, Carrier, Margin, margin, near_active_facets};
pub use volume::volume;
pub use workspace::Workspace;
