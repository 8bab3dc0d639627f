//! Files as people bring them: clouds by their content, tables of grasps, units, standard input.

use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{fitted, moduli, moduli_fed, npy, read_npy, refused, stdout};

/// Two grasps of three contacts on a circle of 4 cm, the second one turned.
fn grasps() -> Vec<f64> {
    let grasp = |turn: f64| {
        let at = (0..3).map(move |i| f64::from(i) * std::f64::consts::TAU / 3.0 + turn);
        let unit: Vec<f64> = at.flat_map(|a| [a.cos(), a.sin(), 0.0]).collect();
        let positions: Vec<f64> = unit.iter().map(|x| 0.04 * x).collect();
        let normals: Vec<f64> = unit.iter().map(|x| -x).collect();
        [positions, normals, vec![0.0; 3]].concat()
    };
    [grasp(0.1), grasp(0.5)].concat()
}

fn rows(separator: &str, number: impl Fn(&f64) -> String) -> String {
    let grasps = grasps();
    let rows = grasps.chunks(21);
    let row = |r: &[f64]| r.iter().map(&number).collect::<Vec<_>>().join(separator);
    rows.map(|r| row(r) + "\n").collect()
}

/// The qualities of a file of grasps, and the warnings.
fn qualities(folder: &Path, name: &str, bytes: &[u8]) -> (Vec<f64>, Vec<String>) {
    std::fs::write(folder.join(name), bytes).unwrap();
    let line = stdout(&moduli(folder, &["quality", name, "--json", "-o", "q.npy"]));
    let said: Value = serde_json::from_str(&line).unwrap();
    let warnings = serde_json::from_value(said["warnings"].clone()).unwrap();
    let q = read_npy(&folder.join("q.npy"), 3);
    (q.chunks(3).map(|row| row[0]).collect(), warnings)
}

#[test]
fn tables_of_grasps_of_many_programs() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let table = npy(21, &grasps());
    let (expected, warnings) = qualities(here, "g.npy", &table);
    assert_eq!((expected.len(), warnings), (2, vec![]));
    let plain = rows(",", f64::to_string);
    let names: Vec<String> = (0..21).map(|i| format!("\"a{i}\"")).collect();
    let header = names.join(",");
    for text in [
        plain.clone(),
        rows(" ", f64::to_string),
        rows("\t", f64::to_string),
        rows("; ", f64::to_string),
        rows(";", |x| x.to_string().replace('.', ",")),
        format!("\u{feff}{plain}"),
        format!("\u{feff}{header}\n{plain}"),
        format!(
            "# made by hand\n{header}\r\n{}",
            plain.replace('\n', "\r\n")
        ),
        plain.replace('\n', ",\n\n"),
        format!(",{header}\n0,{}", plain.replacen('\n', "\n1,", 1)),
    ] {
        for name in ["g.csv", "g.txt", "g"] {
            let (found, warnings) = qualities(here, name, text.as_bytes());
            assert_eq!((found, warnings), (expected.clone(), vec![]), "{text}");
        }
    }
    // One axis is one grasp, three axes are rows.
    let reshaped = |from: &str, to: &str, table: &[u8]| {
        let at = table.windows(from.len()).position(|w| w == from.as_bytes());
        let at = at.unwrap();
        let mut bytes = table.to_vec();
        bytes[at..at + from.len()].copy_from_slice(to.as_bytes());
        bytes
    };
    let single = reshaped("(1, 21, )", "(21, )   ", &npy(21, &grasps()[..21]));
    assert_eq!(qualities(here, "one.npy", &single).0, expected[..1]);
    let deep = reshaped("(2, 21, )", "(2, 7, 3)", &table);
    assert_eq!(qualities(here, "deep.npy", &deep).0, expected);
    for (text, word) in [
        ("1,2,3\n", "line 1"),
        ("1,2,x\n", "column 2"),
        ("solid\0\u{1}", "grasps.json"),
        ("version https://git-lfs.github.com/spec/v1\n", "LFS"),
        ("format: isaac_grasp\n", "`grasps` is missing"),
    ] {
        std::fs::write(here.join("bad.csv"), text).unwrap();
        refused(
            &moduli(here, &["quality", "bad.csv"]),
            3,
            &["bad.csv", word],
        );
    }
}

#[test]
fn normals_of_few_digits_are_normalised_with_a_note() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let text = rows(",", |x| format!("{x:.4}"));
    let (_, warnings) = qualities(here, "short.csv", text.as_bytes());
    assert!(
        warnings[0].contains("normals") && warnings[0].contains("normalised"),
        "{warnings:?}"
    );
    let long = rows(",", |x| {
        if x.abs() > 0.05 {
            (1.05 * x).to_string()
        } else {
            x.to_string()
        }
    });
    std::fs::write(here.join("long.csv"), long).unwrap();
    refused(
        &moduli(here, &["quality", "long.csv"]),
        3,
        &["line 1", "normal"],
    );
}

#[test]
fn a_unit_that_is_hardly_metres_is_refused_unless_it_was_given() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.04, 0.03, 0.05], [0.0; 3]);
    let text = std::fs::read_to_string(here.join("egg.xyz")).unwrap();
    let scaled = |factor: f64| -> String {
        let row = |line: &str| {
            let numbers = line.split(' ').map(|x| factor * x.parse::<f64>().unwrap());
            numbers.map(|x| x.to_string()).collect::<Vec<_>>().join(" ") + "\n"
        };
        text.lines().map(row).collect()
    };
    std::fs::write(here.join("mm.xyz"), scaled(1000.0)).unwrap();
    std::fs::write(here.join("tiny.xyz"), scaled(0.01)).unwrap();
    let fit = |name, more: &[&str]| moduli(here, &[&["fit", name, "--degree", "4"], more].concat());
    refused(
        &fit("mm.xyz", &[]),
        3,
        &["mm.xyz", "99.9", "millimetres", "--unit"],
    );
    refused(&fit("tiny.xyz", &[]), 3, &["tiny.xyz", "--unit"]);
    stdout(&fit("mm.xyz", &["--unit", "mm"]));
    stdout(&fit("mm.xyz", &["--unit", "m"]));
    stdout(&fit("tiny.xyz", &["--unit", "m"]));
    // One point far away is no reason.
    std::fs::write(here.join("far.xyz"), format!("{text}0 0 900\n")).unwrap();
    stdout(&fit("far.xyz", &[]));
}

#[test]
fn standard_input_is_read_by_its_content() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.04, 0.03, 0.05], [0.0; 3]);
    let cloud = std::fs::read(here.join("egg.xyz")).unwrap();
    let fit = moduli_fed(
        here,
        &["fit", "-", "--degree", "8", "-q", "-o", "in.shape"],
        &cloud,
    );
    stdout(&fit);
    let distance = stdout(&moduli(
        here,
        &["distance", "egg.shape", "in.shape", "--json"],
    ));
    assert!(distance.contains('0'), "{distance}");
    let info = stdout(&moduli_fed(here, &["info", "-", "--json"], &cloud));
    let info: Value = serde_json::from_str(&info).unwrap();
    assert_eq!(
        (&info["points"], &info["format"]),
        (&1200.into(), &"XYZ".into())
    );
    let quality = moduli_fed(here, &["quality", "-", "--json"], &npy(21, &grasps()));
    let quality: Value = serde_json::from_str(&stdout(&quality)).unwrap();
    assert_eq!(quality["grasps"], 2);
    refused(
        &moduli_fed(here, &["fit", "-"], b""),
        3,
        &["standard input"],
    );
}

#[test]
fn a_mesh_is_written_and_read_as_glb() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.04, 0.03, 0.05], [0.5, 0.0, 0.25]);
    let written = |name: &str| {
        let arguments = [
            "mesh",
            "egg.shape",
            "-o",
            name,
            "--rows",
            "20",
            "--columns",
            "20",
        ];
        stdout(&moduli(here, &arguments));
        let info = stdout(&moduli(here, &["info", name, "--json"]));
        serde_json::from_str::<Value>(&info).unwrap()
    };
    let (glb, ply) = (written("egg.glb"), written("egg.ply"));
    assert_eq!(glb["format"], "glTF");
    for key in ["vertices", "triangles"] {
        assert_eq!(glb[key], ply[key]);
    }
    let extent = |info: &Value| serde_json::from_value::<[f64; 3]>(info["extent"].clone()).unwrap();
    for (a, b) in extent(&glb).into_iter().zip(extent(&ply)) {
        assert!((a - b).abs() <= 1e-6, "{a} {b}");
    }
    refused(
        &moduli(here, &["mesh", "egg.shape", "-o", "egg.fbx"]),
        2,
        &[".glb"],
    );
}

#[test]
fn info_says_what_was_left_out() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let text = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 9 9 9\nf 1 2 3\n";
    std::fs::write(here.join("part.stl"), text).unwrap();
    let said = stdout(&moduli(here, &["info", "part.stl"]));
    assert!(
        said.contains("no face uses") && said.contains("OBJ"),
        "{said}"
    );
    let json: Value =
        serde_json::from_str(&stdout(&moduli(here, &["info", "part.stl", "--json"]))).unwrap();
    assert_eq!(json["warnings"].as_array().unwrap().len(), 2, "{json}");
}
