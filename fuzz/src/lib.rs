//! What every fuzz target does with its bytes: there is an answer, and a cloud or mesh keeps its promises.

use shape::io::{Geometry, read_cloud};

/// Reads a cloud or mesh whose name ends in `extension`.
pub fn cloud(bytes: &[u8], extension: &str) {
    let Ok(loaded) = read_cloud(bytes, extension) else {
        return;
    };
    let _ = loaded.implausible();
    for point in loaded.vertices() {
        assert!(point.iter().all(|x| x.is_finite()));
    }
    if let Geometry::Mesh(mesh) = &loaded.geometry {
        let count = mesh.vertices.len();
        assert!(mesh.triangles.iter().flatten().all(|i| (*i as usize) < count));
    }
}

/// Reads a table of numbers, and a written table is read back.
pub fn table(bytes: &[u8]) {
    let _ = run::npy::Table::from_npy_with_columns(bytes, 3);
    if let Ok(table) = run::npy::Table::from_npy_flattened(bytes) {
        let again = run::npy::Table::from_npy(&table.to_npy()).map(|t| t.row_count());
        assert_eq!(again, Ok(table.row_count()));
    }
}

/// Reads a file of grasps, and a written file is read back.
pub fn grasps(bytes: &[u8]) {
    if let Ok(file) = record::GraspsFile::from_json(bytes)
        && let Ok(text) = file.to_json()
    {
        assert!(record::GraspsFile::from_json(&text).is_ok());
    }
}

/// Reads each kind of record.
pub fn records(bytes: &[u8]) {
    let _ = record::ShapeRecord::from_bytes(bytes);
    let _ = record::SphericalRecord::from_bytes(bytes);
    let _ = record::LibraryRecord::from_bytes(bytes);
}

/// Reads a URDF; its meshes are not found.
pub fn urdf(bytes: &[u8]) {
    let _ = hand::load_urdf(&hand::urdf_text(bytes));
}

/// Reads what tells a hand from its URDF.
pub fn hand_spec(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        let _ = hand::HandSpec::from_toml(text);
    }
}
