//! Numbers that say how well a grasp resists disturbances.

mod certificate;
mod epsilon;
mod facet;
mod friction_needed;
mod isotropy;
mod linf;
mod margin;
mod min_weight;
mod robust;
mod robustness;
mod volume;
mod workspace;

pub use certificate::{Certificate, CertificateCap, CertificateFacet, epsilon_with_certificate};
pub use epsilon::{Epsilon, QualityError, epsilon, epsilon_of_wrenches};
pub use facet::{ActiveFacet, Carrier};
pub use friction_needed::{FrictionBound, FrictionNeeded, friction_needed};
pub use isotropy::smallest_singular_value;
pub use linf::epsilon_linf;
pub use margin::{Margin, margin, near_active_facets};
pub use min_weight::min_weight;
pub(crate) use min_weight::min_weight_of;
pub use robust::{Uncertainty, robust_quality};
pub use robustness::{closed_radius, lipschitz_constant};
pub use volume::volume;
pub use workspace::Workspace;
