//! The built-in objects: twelve library objects, two unseen objects, and spheres.
//!
//! The laser scans and meshes of Sec. IV-A of the paper are not published. The objects here are
//! modelled as analytic solids, whose true radial functions and normals are known; scans of any
//! density and noise can be drawn from them.
//!
//! ```
//! let shampoo = catalogue::by_id("S5").expect("S5 is in the library");
//! let cloud = shampoo.scan(7);
//! assert_eq!(cloud.len(), catalogue::SCAN_POINTS);
//! ```

mod chart;
mod field;
mod library;
mod noise;
mod object;
mod primitive;
mod solid;
mod sphere;
mod unseen;

pub use noise::ScanNoise;
pub use object::{CatalogueObject, SCAN_POINTS, SurfacePoint};
pub use sphere::{sphere_radii, sphere_scan};

use std::sync::LazyLock;

static LIBRARY: LazyLock<Vec<CatalogueObject>> = LazyLock::new(library::build);
static UNSEEN: LazyLock<Vec<CatalogueObject>> = LazyLock::new(unseen::build);

/// The twelve library objects S1 to S12, in this order.
///
/// ```
/// let ids: Vec<&str> = catalogue::library_objects().iter().map(|o| o.id).collect();
/// assert_eq!((ids.len(), ids[0], ids[11]), (12, "S1", "S12"));
/// ```
pub fn library_objects() -> &'static [CatalogueObject] {
    &LIBRARY
}

/// The two objects U1 and U2, which are not in the library and represent unknown objects.
pub fn unseen_objects() -> &'static [CatalogueObject] {
    &UNSEEN
}

/// The object with the given id ("S1" to "S12", "U1", "U2"; capital letters), if there is one.
pub fn by_id(id: &str) -> Option<&'static CatalogueObject> {
    library_objects()
        .iter()
        .chain(unseen_objects())
        .find(|object| object.id == id)
}
