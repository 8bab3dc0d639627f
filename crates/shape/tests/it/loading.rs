//! Every real file loads or is refused with a reason, and no bytes at all cause a panic.

use crate::common::{bytes, index, objects};
use crate::mutations::samples;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use shape::io::{Format, Geometry, LoadError, Loaded, Warning, read_cloud};

/// A file below `objects`, by its extension.
fn load(path: &str) -> Result<Loaded, LoadError> {
    let extension = path.rsplit('.').next().unwrap();
    read_cloud(&bytes(path), extension)
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn every_cloud_and_mesh_loads_or_is_refused_with_a_reason() {
    let root = objects();
    let mut seen = 0;
    for folder in ["", "meshes", "formats"] {
        for entry in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
            if path.is_dir() || ["tsv", "md", "txt"].contains(&extension) {
                continue;
            }
            seen += 1;
            let read = read_cloud(&std::fs::read(&path).unwrap(), extension);
            if extension == "wrl" {
                let reason = read.unwrap_err().to_string();
                assert!(reason.contains("this is a VRML file"), "{reason}");
                continue;
            }
            let loaded = read.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            let millimetres = path.ends_with("apple_mm.stl");
            let unit = |w: &Warning| matches!(w, Warning::Unit { .. });
            assert_eq!(loaded.warnings.iter().any(unit), millimetres, "{path:?}");
            let cloud = loaded
                .cloud(1000, &mut ChaCha8Rng::seed_from_u64(1))
                .unwrap();
            assert!(cloud.points().len() >= 400);
        }
    }
    assert_eq!(seen, index().len() + 14 + 5);
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn meshes_have_the_counts_of_the_index() {
    let table = String::from_utf8(bytes("meshes/index.tsv")).unwrap();
    for line in table.lines().skip(1) {
        let fields: Vec<&str> = line.split('\t').collect();
        let (file, vertices, faces) = (fields[0], fields[5], fields[6]);
        if file.ends_with("wrl") {
            continue;
        }
        let loaded = load(&format!("meshes/{file}")).unwrap();
        let Geometry::Mesh(mesh) = &loaded.geometry else {
            panic!("{file} has faces");
        };
        // The index counts after equal corners were merged and empty triangles left out.
        let close = |count: usize, listed: &str| {
            let listed: usize = listed.parse().unwrap();
            (listed..=listed + 16).contains(&count)
        };
        assert!(close(mesh.triangles.len(), faces), "{file}");
        assert!(close(mesh.vertices.len(), vertices), "{file}");
        assert!(loaded.dropped == 0 && mesh.area() > 0.0);
    }
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn a_mesh_sampled_by_area_is_the_cloud_of_the_same_object() {
    let loaded = load("meshes/pear_mesh.ply");
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let sampled = loaded
        .unwrap()
        .cloud(Loaded::MESH_SAMPLES, &mut rng)
        .unwrap();
    let cloud = crate::common::cloud("pear");
    // The standard error of a mean over 25,000 points is 0.2 mm here.
    assert!((sampled.mean() - cloud.mean()).norm() <= 1e-3);
    assert!((sampled.extent() - cloud.extent()).norm() <= 1e-3);
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn five_ways_to_write_one_cloud_give_the_same_points() {
    let first = load("formats/baseball.xyz");
    let first = first.unwrap();
    assert_eq!(first.vertices().len(), 25_000);
    for (file, format) in [
        ("baseball_ascii_normals_rgb.ply", Format::Ply),
        ("baseball_be_double_extra.ply", Format::Ply),
        ("baseball_binary.pcd", Format::Pcd),
    ] {
        let loaded = load(&format!("formats/{file}")).unwrap();
        assert_eq!(loaded.format, format);
        assert_eq!(loaded.vertices().len(), 25_000, "{file}");
        for (a, b) in first.vertices().iter().zip(loaded.vertices()) {
            // The text files are rounded to a micrometre.
            assert!((a - b).norm() <= 1e-6, "{file}: {a} {b}");
        }
    }
    let holes = load("formats/baseball_with_50_nan_rows.ply").unwrap();
    assert_eq!((holes.dropped, holes.vertices().len()), (50, 24_950));
    assert_eq!(holes.warnings, [Warning::Dropped { rows: 50 }]);
}

#[test]
fn unknown_empty_and_truncated_files_name_what_was_expected() {
    assert!(matches!(
        read_cloud(b"x", "step"),
        Err(LoadError::Unsupported { .. })
    ));
    assert!(matches!(read_cloud(b"", ".PLY"), Err(LoadError::Empty)));
    assert!(matches!(
        read_cloud(b"#VRML V2.0", "txt"),
        Err(LoadError::Foreign { .. })
    ));
    for sample in samples() {
        let (extension, whole) = sample;
        assert!(read_cloud(&whole, extension).is_ok(), "{extension}");
        for cut in 1..whole.len() {
            if let Err(error) = read_cloud(&whole[..cut], extension) {
                let text = error.to_string();
                let place = [
                    "line",
                    "byte",
                    "no finite",
                    "the elements",
                    "the arrays",
                    "accessor",
                ];
                assert!(place.iter().any(|p| text.contains(p)), "{text}");
            }
        }
    }
}
