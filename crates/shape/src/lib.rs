//! Objects: clouds, meshes, smooth surfaces, and the space that the surfaces live in.
//!
//! Surfaces live in a centred frame, whose origin is the mean of the cloud (Sec. IV-A of the
//! paper); [`fit::Fit`] stores the transformation to the frame of the cloud.
//!
//! A cloud becomes a surface whose radius is proved positive in every direction:
//!
//! ```
//! use nalgebra::{Point3, Vector3};
//! use shape::{FitSettings, PointCloud, fit::fit};
//!
//! // Points of an egg with half axes of 3, 4 and 5 cm, whose middle is at x = 0.5 m.
//! let directions = sph::direction::even_directions(2000);
//! let points = directions.iter().map(|p| Point3::new(0.5 + 0.03 * p.x, 0.04 * p.y, 0.05 * p.z));
//! let cloud = PointCloud::new(points.collect())?;
//!
//! let egg = fit(&cloud, &FitSettings { degree: 12, lambda: None })?;
//! let (least, largest) = egg.shape.radius_bounds(); // metres, certified
//! assert!(0.028 < least && largest < 0.052);
//! assert!((egg.centre_in_cloud - Point3::new(0.5, 0.0, 0.0)).norm() < 1e-3);
//!
//! let top = sph::Direction::new_normalize(Vector3::z());
//! assert!((egg.shape.radius(&top) - 0.05).abs() < 2e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod acceptance;
pub mod algebra;
mod any;
pub mod closed_patch;
mod crossing;
pub mod embedding;
mod evidence;
pub mod fit;
mod hole_filling;
mod immersion;
mod injectivity;
mod injectivity_cell;
pub mod io;
pub mod mass;
pub mod noise;
mod normals;
pub mod open_sheet;
mod opening;
mod outliers;
mod patch;
pub mod point_cloud;
pub mod radial;
mod radial_field;
mod rotation_field;
pub mod scene;
mod sphere_partition;
mod spherical;
mod spherical_cloud;
mod spherical_field;
mod spherical_fit;
mod spherical_rows;
pub mod surface;
mod third_derivatives;
pub mod triangle_mesh;
pub mod visibility;
mod voxel_grid;

pub use acceptance::{Acceptance, Verdict};
pub use any::{AnyField, AnyShape, SurfaceRef};
pub use closed_patch::ClosedPatch;
pub use evidence::{Evidence, PAD_RADIUS, evidence};
pub use fit::{Fit, FitError, FitSettings};
pub use immersion::{Immersion, SphericalError};
pub use injectivity::Embedding;
pub use open_sheet::Walls;
pub use opening::{OpenContainer, Opening};
pub use point_cloud::{CloudError, PointCloud};
pub use radial::{RadialError, RadialShape};
pub use radial_field::RadialField;
pub use scene::{Scene, SceneError, SceneSettings, Support, SupportRule, SupportSource};
pub use spherical::SphericalShape;
pub use spherical_cloud::{
    SphericalCloudError, SphericalCloudFit, SphericalSettings, fit_spherical_cloud,
};
pub use spherical_field::SphericalField;
pub use spherical_fit::{SphericalFit, SphericalFitError, fit_spherical};
pub use surface::{Differential, Surface};
pub use triangle_mesh::TriangleMesh;
pub use visibility::{Crossing, Visibility, measure_visibility};
