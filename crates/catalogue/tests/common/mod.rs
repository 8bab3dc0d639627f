//! What several test files share: all objects, and even directions.

use catalogue::{CatalogueObject, library_objects, unseen_objects};
use nalgebra::{Unit, Vector3};
use std::f64::consts::PI;

/// All fourteen objects.
pub(crate) fn all_objects() -> impl Iterator<Item = &'static CatalogueObject> {
    library_objects().iter().chain(unseen_objects())
}

/// Midpoints of `rows` × `columns` cells of equal area on the sphere, row by row from −z.
pub(crate) fn equal_area_directions(
    rows: usize,
    columns: usize,
) -> impl Iterator<Item = Unit<Vector3<f64>>> {
    (0..rows).flat_map(move |row| {
        let z = -1.0 + 2.0 * (row as f64 + 0.5) / rows as f64;
        let ring = (1.0 - z * z).sqrt();
        (0..columns).map(move |column| {
            let (sin, cos) = (2.0 * PI * (column as f64 + 0.5) / columns as f64).sin_cos();
            Unit::new_normalize(Vector3::new(ring * cos, ring * sin, z))
        })
    })
}
