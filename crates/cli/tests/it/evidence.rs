//! `moduli quality` with more than contacts: the cloud of the object, and hands of `isaac_grasp` files.

use std::path::Path;

use tempfile::TempDir;

use crate::common::{fitted, moduli, refused, stdout};

fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let arguments = [arguments, &["--json"]].concat();
    serde_json::from_str(&stdout(&moduli(folder, &arguments))).unwrap()
}

fn warnings(said: &serde_json::Value) -> String {
    said["warnings"].to_string()
}

/// A folder with NAME.xyz, NAME.shape and the grasps of a hand on it.
fn grasped(hand: &str, axes: [f64; 3], centre: [f64; 3]) -> TempDir {
    let folder = TempDir::new().unwrap();
    fitted(folder.path(), "egg", axes, centre);
    let words = [
        "synthesize",
        "egg.shape",
        "--poses",
        "80",
        "--support",
        "none",
        "--hand",
        hand,
    ];
    let found = json(folder.path(), &[&words[..], &["-o", "out"]].concat());
    assert!(found["stable"].as_u64().unwrap() > 0, "{found}");
    folder
}

#[test]
fn a_cloud_adds_its_evidence_to_all_metrics() {
    let folder = grasped("sdh", [0.035, 0.030, 0.045], [0.5, 0.0, 0.2]);
    let here = folder.path();
    let dense: String = sph::direction::even_directions(20_000)
        .iter()
        .map(|p| {
            format!(
                "{} {} {}\n",
                0.5 + 0.035 * p.x,
                0.030 * p.y,
                0.2 + 0.045 * p.z
            )
        })
        .collect();
    std::fs::write(here.join("dense.xyz"), dense).unwrap();
    let said = json(
        here,
        &[
            "quality",
            "out/grasps.json",
            "--all",
            "--cloud",
            "dense.xyz",
        ],
    );
    let columns: Vec<&str> = said["columns"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c.as_str().unwrap())
        .collect();
    let added = ["robust_quality", "distance_to_cloud_m", "normal_spread_deg"];
    assert_eq!(columns[9..], added);
    let rows = said["rows"].as_array().unwrap();
    for row in rows {
        let cell = |k: usize| row[k].as_f64().unwrap();
        assert!(cell(9) <= cell(1) && cell(9) >= 0.0, "{row}");
        assert!(cell(10) < 1e-3 && (0.0..=90.0).contains(&cell(11)), "{row}");
    }
    assert!(rows.iter().any(|row| row[9].as_f64().unwrap() > 0.0));
    assert_eq!(said["warnings"].as_array().unwrap().len(), 0, "{said}");
    // The cloud of another object, and one without --all.
    fitted(here, "far", [0.035, 0.030, 0.045], [0.0, 0.0, 0.0]);
    let other = json(
        here,
        &["quality", "out/grasps.json", "--all", "--cloud", "far.xyz"],
    );
    assert!(
        warnings(&other).contains("grasps of another object"),
        "{other}"
    );
    let alone = moduli(here, &["quality", "out/grasps.json", "--cloud", "egg.xyz"]);
    refused(&alone, 2, &["--all"]);
}

#[test]
fn grasps_in_millimetres_or_on_another_object_are_noted_in_the_result() {
    let folder = grasped("sdh", [0.035, 0.030, 0.045], [0.0; 3]);
    let here = folder.path();
    let text = std::fs::read_to_string(here.join("out/grasps.json")).unwrap();
    let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut moved = |name: &str, change: &dyn Fn(f64) -> f64| {
        for grasp in file["grasps"].as_array_mut().unwrap() {
            for contact in grasp["contacts_m"].as_array_mut().unwrap() {
                contact[0] = change(contact[0].as_f64().unwrap()).into();
            }
        }
        std::fs::write(here.join(name), file.to_string()).unwrap();
    };
    moved("beside.json", &|x| x + 0.02);
    moved("millimetres.json", &|x| 1e3 * (x - 0.02));
    let clean = json(here, &["quality", "out/grasps.json"]);
    assert_eq!(clean["warnings"].as_array().unwrap().len(), 0, "{clean}");
    for (name, word) in [
        ("beside.json", "another object"),
        ("millimetres.json", "millimetres"),
    ] {
        let said = json(here, &["quality", name]);
        assert!(warnings(&said).contains(word), "{name}: {said}");
    }
    let climbed = json(here, &["ascend", "egg.shape", "beside.json", "-q"]);
    assert!(warnings(&climbed).contains("another object"), "{climbed}");
}

/// The contacts come from the surface and the hand: the qualities are those of the grasps.json that was
/// written with the file, which has the contacts.
#[test]
fn grasps_of_isaac_sim_are_measured_on_a_shape() {
    for (hand, axes) in [
        ("sdh", [0.035, 0.030, 0.045]),
        ("panda", [0.02, 0.025, 0.03]),
    ] {
        let folder = grasped(hand, axes, [0.5, 0.0, 0.2]);
        let here = folder.path();
        let words = [
            "quality",
            "out/grasps.yaml",
            "--shape",
            "egg.shape",
            "--hand",
            hand,
        ];
        let ours = json(here, &["quality", "out/grasps.json"]);
        let theirs = json(here, &words);
        assert_eq!(ours["grasps"], theirs["grasps"]);
        assert_eq!(ours["closed"], theirs["closed"], "{hand}: {theirs}");
        let [a, b] = [&ours, &theirs].map(|said| said["mean"].as_f64().unwrap());
        assert!((a - b).abs() <= 1e-6 * a, "{hand}: {a} and {b}");
        assert_eq!(theirs["warnings"].as_array().unwrap().len(), 0, "{theirs}");
        refused(
            &moduli(here, &["quality", "out/grasps.yaml"]),
            3,
            &["--shape SHAPE"],
        );
        // A hand far from the object, and another hand.
        let text = std::fs::read_to_string(here.join("out/grasps.yaml")).unwrap();
        let far = text.replace("position: [0.", "position: [9.");
        std::fs::write(here.join("far.yaml"), far).unwrap();
        let far = [&["quality", "far.yaml"], &words[2..]].concat();
        refused(&moduli(here, &far), 3, &["two tips within 5 mm"]);
        let other = if hand == "sdh" { "panda" } else { "sdh" };
        let wrong = [&words[..5], &[other]].concat();
        refused(&moduli(here, &wrong), 3, &["has no joint", "--hand"]);
    }
}
