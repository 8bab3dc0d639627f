//! Functions that several test files share.

use catalogue::{CatalogueObject, library_objects, unseen_objects};

/// All fourteen objects.
pub(crate) fn all_objects() -> impl Iterator<Item = &'static CatalogueObject> {
    library_objects().iter().chain(unseen_objects())
}
