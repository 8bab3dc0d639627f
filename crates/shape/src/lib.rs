//! Objects: clouds, meshes, smooth surfaces, and the space that the surfaces live in.
//!
//! Surfaces live in a centred frame, whose origin is the mean of the cloud (Sec. IV-A of the
//! paper); [`fit::Fit`] keeps the way back to the frame of the cloud.

pub mod algebra;
mod cells;
pub mod embedding;
pub mod fit;
mod immersion;
pub mod io;
pub mod mass;
pub mod noise;
mod normals;
mod outliers;
mod patch;
pub mod point_cloud;
pub mod radial;
mod radial_field;
mod rotation_field;
mod spherical;
mod spherical_fit;
pub mod star;
pub mod surface;
pub mod triangle_mesh;
mod unseen;
pub mod vessel;

pub use fit::{Fit, FitError, FitSettings};
pub use immersion::{Immersion, SphericalError};
pub use point_cloud::{CloudError, PointCloud};
pub use radial::{RadialError, RadialShape};
pub use radial_field::RadialField;
pub use spherical::SphericalShape;
pub use spherical_fit::{SphericalFit, SphericalFitError, fit_spherical};
pub use star::{Crossing, StarShape, star_shape};
pub use surface::{Differential, Surface};
pub use triangle_mesh::TriangleMesh;
pub use vessel::{Opening, Vessel};
