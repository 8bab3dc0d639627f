//! Numbers that say how well a grasp resists disturbances.

mod epsilon;
mod isotropy;
mod linf;
mod margin;
mod min_weight;
mod polish;
mod robustness;
mod volume;
mod workspace;

pub use epsilon::{
    BatchError, Epsilon, QualityError, epsilon, epsilon_batch, epsilon_of, epsilon_of_wrenches,
    epsilon_quality,
};
pub use isotropy::smallest_singular_value;
pub use linf::epsilon_linf;
pub use margin::{ActiveFacet, Carrier, Margin, margin, near_active_facets};
pub use min_weight::min_weight;
pub(crate) use min_weight::min_weight_of;
pub use robustness::{closed_radius, least_friction, lipschitz_constant};
pub use volume::volume;
pub use workspace::Workspace;
