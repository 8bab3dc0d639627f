//! From a point cloud to a closed surface of genus zero, and a bijective map of it onto the sphere.
//!
//! [`wrap`] carves a block of lattice vertices from outside, each vertex only if the topology of a ball
//! is kept, and meshes what remains. [`sphere_map`] maps such a mesh onto the unit sphere, one to one.
//! Both are deterministic. Lengths are in the unit of the cloud.
//!
//! ```
//! use nalgebra::{Point3, Vector3};
//! use sphere_map::{MapSettings, WrapSettings, sphere_map, wrap};
//!
//! // 3,000 points of an egg.
//! let points: Vec<Point3<f64>> = (0..3000)
//!     .map(|i| {
//!         let (z, angle) = ((2.0 * f64::from(i) + 1.0) / 3000.0 - 1.0, 2.399963 * f64::from(i));
//!         let r = f64::sqrt(1.0 - z * z);
//!         Point3::new(0.03 * r * angle.cos(), 0.04 * r * angle.sin(), 0.05 * z)
//!     })
//!     .collect();
//!
//! let wrap = wrap(&points, &WrapSettings { vertices: 500 })?;
//! assert_eq!(wrap.mesh.euler_characteristic(), 2);
//! assert!(wrap.closed_holes.is_empty());
//!
//! let map = sphere_map(&wrap.mesh, &MapSettings::default())?;
//! let top = map.preimage(&Vector3::z_axis());
//! let tree = sphere_map::Tree::new(&map.mesh);
//! let back = tree.closest(&top).map(|at| map.image(&at));
//! assert!(back.is_some_and(|p| (p.into_inner() - Vector3::z()).norm() < 1e-2));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod carve;
mod decimate;
mod energy;
mod holes;
mod lattice;
mod march;
mod mesh;
mod orient;
mod placement;
mod points;
mod project;
mod rings;
mod sphere_map;
mod tree;
mod wrap;

pub use holes::ClosedHole;
pub use mesh::Mesh;
pub use sphere_map::{MapError, MapSettings, SphereMap, sphere_map};
pub use tree::{Closest, Tree};
pub use wrap::{Wrap, WrapError, WrapSettings, wrap};
