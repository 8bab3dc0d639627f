//! Every real file loads or is refused with a reason, and no bytes at all cause a panic.

use crate::common::{bytes, index, objects};
use proptest::prelude::*;
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
    assert!(matches!(
        read_cloud(b"", ".PLY"),
        Err(LoadError::Empty { .. })
    ));
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
                let place = ["line", "byte", "no finite", "the elements", "the arrays"];
                assert!(place.iter().any(|p| text.contains(p)), "{text}");
            }
        }
    }
}

/// Small files of every format, to be damaged.
fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let text = |s: &str| s.as_bytes().to_vec();
    let mut ply = text(
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nelement extra 2\nproperty list ushort double a\nend_header\n",
    );
    for x in [0.0_f32, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.1, 0.0] {
        ply.extend(x.to_le_bytes());
    }
    ply.extend([3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 1, 0]);
    ply.extend(2.5_f64.to_le_bytes());
    let pcd = |kind: &str| {
        text(&format!(
            "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA {kind}\n"
        ))
    };
    let mut pcd_binary = pcd("binary");
    pcd_binary.extend([0; 24]);
    let mut pcd_packed = pcd("binary_compressed");
    pcd_packed.extend(5_u32.to_le_bytes());
    pcd_packed.extend(24_u32.to_le_bytes());
    pcd_packed.extend([0, 0, 7 << 5, 14, 0]);
    let mut pcd_text = pcd("ascii");
    pcd_text.extend(b"0 0 0\n0 0.1 nan\n");
    let mut stl = vec![b' '; 80];
    stl.extend(1_u32.to_le_bytes());
    stl.extend([0; 50]);
    vec![
        ("ply", ply),
        (
            "ply",
            text(
                "ply\nformat ascii 1.0\ncomment c\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n0.1 0 0\n0 nan 0\n3 0 1 2\n",
            ),
        ),
        ("pcd", pcd_binary),
        ("pcd", pcd_packed),
        ("pcd", pcd_text),
        ("xyz", text("x,y,z\n0,0,0\n1,2,3 # c\n")),
        ("obj", text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2//2 -1\n")),
        ("off", text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")),
        ("stl", stl),
        (
            "stl",
            text(
                "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n",
            ),
        ),
    ]
}

fn survives(bytes: &[u8], extension: &str) {
    if let Ok(loaded) = read_cloud(bytes, extension) {
        assert!(
            loaded
                .vertices()
                .iter()
                .all(|p| p.iter().all(|x| x.is_finite()))
        );
        if let Geometry::Mesh(mesh) = &loaded.geometry {
            let count = mesh.vertices.len();
            assert!(
                mesh.triangles
                    .iter()
                    .flatten()
                    .all(|i| (*i as usize) < count)
            );
        }
        // An error is as good an answer as a cloud.
        let cloud = loaded.cloud(10, &mut ChaCha8Rng::seed_from_u64(3));
        assert!(cloud.map_or(true, |c| c.points().len() >= 4));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_bytes_are_survived(
        bytes in proptest::collection::vec(any::<u8>(), 0..400),
        extension in prop::sample::select(vec!["ply", "pcd", "xyz", "obj", "off", "stl", ""]),
    ) {
        survives(&bytes, extension);
    }

    #[test]
    fn damaged_files_are_survived(
        which in 0_usize..10,
        edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0_u8..3), 1..8),
    ) {
        let (extension, mut bytes) = samples().swap_remove(which);
        for (at, byte, kind) in edits {
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => { bytes.truncate(at.max(1)); }
            }
        }
        survives(&bytes, extension);
    }

    #[test]
    fn absurd_numbers_are_survived(
        which in 0_usize..10,
        number in prop::sample::select(vec!["4294967295", "18446744073709551615", "99999999999999999999", "-1", "1e309", "65536", "nan", ""]),
        at in any::<prop::sample::Index>(),
    ) {
        let (extension, bytes) = samples().swap_remove(which);
        let digits: Vec<usize> = (0..bytes.len()).filter(|i| bytes[*i].is_ascii_digit()).collect();
        prop_assume!(!digits.is_empty());
        let at = digits[at.index(digits.len())];
        let mut changed = bytes[..at].to_vec();
        changed.extend(number.as_bytes());
        changed.extend(&bytes[at + 1..]);
        survives(&changed, extension);
    }
}
