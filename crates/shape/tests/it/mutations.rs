//! Files of every format, damaged in thousands of ways: whatever they hold, there is an answer.

use nalgebra::Point3;
use proptest::prelude::*;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use shape::TriangleMesh;
use shape::io::{Geometry, MeshFormat, read_cloud, write_mesh};

/// Small files of every format, to be damaged.
pub(crate) fn samples() -> Vec<(&'static str, Vec<u8>)> {
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
    let mut files = vec![
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
    ];
    files.extend(more_samples());
    files
}

/// Files of the formats that are made of parts: strips, columns, arrays, archives and scenes.
fn more_samples() -> Vec<(&'static str, Vec<u8>)> {
    let text = |s: &str| s.as_bytes().to_vec();
    let corner = |x, y, z| Point3::new(x, y, z);
    let mesh = TriangleMesh {
        vertices: vec![
            corner(0.0, 0.0, 0.0),
            corner(0.5, 0.0, 0.0),
            corner(0.0, 0.25, 0.0),
            corner(0.0, 0.0, 0.5),
        ],
        triangles: vec![[0, 1, 2], [1, 0, 3]],
    };
    let mut glb = Vec::new();
    write_mesh(&mesh, MeshFormat::Glb, &mut glb).unwrap();
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";
    let mut npy = b"\x93NUMPY\x01\x00".to_vec();
    npy.extend((header.len() as u16).to_le_bytes());
    npy.extend(header.bytes());
    npy.extend([0, 0, 128, 63].repeat(6));
    vec![
        (
            "ply",
            text(
                "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0 1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 2\n",
            ),
        ),
        (
            "off",
            text("OFF6 1 0\n0 0 0 4 0 0 4 4 0 2 1 0 0 4 0 9 9 9\n5 0 1 2 3 4\n"),
        ),
        (
            "csv",
            text("id;pos_x;pos_y;pos_z\n1;0,5;1,5;2,5\n2;1,0;1,0;1,0\n"),
        ),
        ("glb", glb),
        ("gltf", text(GLTF)),
        ("npz", archive(&npy)),
        ("npy", npy),
    ]
}

/// A scene with one triangle in a node that is moved; 36 bytes of positions and 3 of indices.
const GLTF: &str = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1]},{"mesh":0,"translation":[1,2,3],"rotation":[0,0,0,1],"scale":[2,2,2]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":4}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":0,"byteOffset":36,"componentType":5121,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":39}],
"buffers":[{"byteLength":39,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAEC"}]}"#;

/// A ZIP archive with one file that is stored as it is.
fn archive(content: &[u8]) -> Vec<u8> {
    let name = b"points.npy";
    let size = (content.len() as u32).to_le_bytes();
    let mut facts = vec![20, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    facts.extend([size, size].concat());
    facts.extend([name.len() as u8, 0, 0, 0]);
    let mut bytes = b"PK\x03\x04".to_vec();
    bytes.extend(&facts);
    bytes.extend(name);
    bytes.extend(content);
    let directory = bytes.len() as u32;
    bytes.extend(b"PK\x01\x02\x14\x00");
    bytes.extend(&facts);
    bytes.extend([0; 14]);
    bytes.extend(name);
    let length = bytes.len() as u32 - directory;
    bytes.extend(b"PK\x05\x06\0\0\0\0\x01\0\x01\0");
    bytes.extend(length.to_le_bytes());
    bytes.extend(directory.to_le_bytes());
    bytes.extend([0, 0]);
    bytes
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

/// Words that stand where numbers stood.
const ABSURD: [&str; 12] = [
    "4294967295",
    "18446744073709551615",
    "99999999999999999999",
    "-1",
    "1e309",
    "1e155",
    "65536",
    "nan",
    "",
    "0",
    " ",
    "\n",
];

/// One small damage: a byte changed, added or lost, a part lost, repeated or moved, a number
/// replaced.
fn damage(bytes: &mut Vec<u8>, rng: &mut ChaCha8Rng) {
    if bytes.is_empty() {
        return;
    }
    let at = rng.random_range(0..bytes.len());
    let end = (at + rng.random_range(1..16)).min(bytes.len());
    match rng.random_range(0..9) {
        0 => bytes[at] = rng.random(),
        1 => bytes[at] ^= 1 << rng.random_range(0..8),
        2 => bytes.insert(at, rng.random()),
        3 => bytes.truncate(at),
        4 => drop(bytes.drain(at..end)),
        5 => {
            let part = bytes[at..end].to_vec();
            let to = rng.random_range(0..bytes.len());
            drop(bytes.splice(to..to, part));
        }
        6 => bytes[at..end].fill(*[0, 255, b' ', b'9'].choose(rng).unwrap_or(&0)),
        _ => {
            let digits = (at..bytes.len()).chain(0..at);
            let digit = digits.into_iter().find(|i| bytes[*i].is_ascii_digit());
            let word = ABSURD.choose(rng).unwrap_or(&"").bytes();
            if let Some(digit) = digit {
                drop(bytes.splice(digit..=digit, word));
            }
        }
    }
}

#[test]
fn ten_thousand_damaged_files_are_survived() {
    const FILES: usize = 10_000;
    let samples = samples();
    let mut rng = ChaCha8Rng::seed_from_u64(20);
    for i in 0..FILES {
        let (extension, mut bytes) = samples[i % samples.len()].clone();
        for _ in 0..rng.random_range(1..8) {
            damage(&mut bytes, &mut rng);
        }
        survives(&bytes, extension);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_bytes_are_survived(
        bytes in proptest::collection::vec(any::<u8>(), 0..400),
        extension in prop::sample::select(vec!["ply", "pcd", "xyz", "obj", "off", "stl", "npy", ""]),
    ) {
        survives(&bytes, extension);
    }
}
