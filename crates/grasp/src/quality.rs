//! Numbers that say how well a grasp resists disturbances.

mod certificate;
mod epsilon;
mod facet;
mod isotropy;
mod linf;
mod margin;
mod min_weight;
mod robustness;
mod volume;
mod workspace;

pub use certificate::{Certificate, CertificateCap, CertificateFacet, epsilon_with_certificate};
pub use epsilon::{Epsilon, QualityError, epsilon, epsilon_of_wrenches};
pub use facet::{ActiveFacet, Carrier};
pub use isotropy::smallest_singular_value;
pub use linf::epsilon_linf;
pub use margin::{Margin, margin, near_active_facets};
pub use min_weight::min_weight;
pub(crate) use min_weight::min_weight_of;
pub use robustness::{closed_radius, least_friction, lipschitz_constant};
pub use volume::volume;
pub use workspace::Workspace;
