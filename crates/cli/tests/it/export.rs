//! Grasps in the formats of other programs.

use tempfile::TempDir;

use crate::common::{fitted, moduli, refused, stdout};
use crate::hands::{CENTRE, read};

#[test]
fn grasps_are_written_for_other_programs() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let synthesize = ["synthesize", "egg.shape", "--poses", "40", "-o", "out"];
    stdout(&moduli(here, &synthesize));
    let export = |kind: &str, output: &str| {
        let arguments = ["export", kind, "out/grasps.json", "-o", output];
        stdout(&moduli(here, &arguments));
        std::fs::read(here.join(output)).unwrap()
    };
    let isaac = export("isaac", "isaac.yaml");
    assert_eq!(isaac, std::fs::read(here.join("out/grasps.yaml")).unwrap());
    let file = read(here, "out/grasps.json");
    let grasps = file["grasps"].as_array().unwrap();

    let moveit = String::from_utf8(export("moveit", "moveit.yaml")).unwrap();
    assert_eq!(moveit.matches("  - id: ").count(), grasps.len());
    let hand = &grasps[0]["hand"];
    let position = hand["object_from_palm"]["translation_m"]
        .as_array()
        .unwrap();
    let x = position[0].as_f64().unwrap();
    assert!(moveit.contains(&format!("position: {{x: {x},")), "{moveit}");
    // The joint that follows another is not commanded.
    assert!(moveit.contains("\"sdh_knuckle_joint\""));
    assert!(!moveit.contains("\"sdh_finger_21_joint\""));
    assert_eq!(moveit.matches("pre_grasp_approach:").count(), grasps.len());

    let npz = export("npz", "grasps.npz");
    assert!(npz.starts_with(b"PK\x03\x04"));
    let text = String::from_utf8_lossy(&npz).into_owned();
    let count = grasps.len();
    for (name, shape) in [
        ("quality", format!("({count},)")),
        ("object_from_palm", format!("({count}, 7,)")),
        ("joints", format!("({count}, 8,)")),
        ("contacts_m", format!("({count}, 3, 3,)")),
        ("joint_names", "(8,)".to_owned()),
    ] {
        assert!(text.contains(&format!("{name}.npy")), "{name}");
        assert!(text.contains(&format!("'shape': {shape}")), "{shape}");
    }
    let again = export("npz", "again.npz");
    assert_eq!(again, npz);
}

#[test]
fn what_cannot_be_exported_is_refused() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let synthesize = ["synthesize", "egg.shape", "--poses", "40", "-o", "out"];
    stdout(&moduli(here, &synthesize));
    let json = "out/grasps.json";
    let run = |kind: &str, from: &str, to: &str| moduli(here, &["export", kind, from, "-o", to]);
    refused(&run("moveit", json, json), 2, &["grasps.json"]);
    refused(&run("ros", json, "x"), 2, &["isaac", "moveit", "npz"]);
    refused(&run("npz", "egg.shape", "x"), 3, &["egg.shape"]);
    // Grasps without hands have no pose.
    let text = std::fs::read_to_string(here.join(json)).unwrap();
    let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
    for grasp in file["grasps"].as_array_mut().unwrap() {
        grasp["hand"] = serde_json::Value::Null;
    }
    std::fs::write(here.join("bare.json"), file.to_string()).unwrap();
    refused(
        &run("moveit", "bare.json", "x"),
        3,
        &["bare.json", "has a hand"],
    );
    assert!(!here.join("x").exists());
}

/// Joints with units, and tips at least a centimetre from the object before the hand closes.
#[test]
fn the_file_says_what_a_robot_needs() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.025, 0.020, 0.03], CENTRE);
    let arguments = "synthesize egg.shape --hand panda --poses 60 -o out";
    stdout(&moduli(here, &arguments.split(' ').collect::<Vec<_>>()));
    let file = read(here, "out/grasps.json");
    assert_eq!(file["version"], 2);
    for grasp in file["grasps"].as_array().unwrap() {
        let hand = &grasp["hand"];
        let value = |key: &str| {
            let joint = &hand[key]["panda_finger_joint1"];
            assert_eq!(joint["unit"], "m");
            joint["value"].as_f64().unwrap()
        };
        // At the grasp joints the tips touch, which is up to a millimetre further.
        let further = value("joints") - value("grasp_joints");
        assert!((0.0..=1.1e-3).contains(&further), "{further}");
        // The jaws open to 40 mm each and hold at most 30 of them.
        assert!(value("pregrasp_joints") - value("joints") >= 0.00999);
        let way: Vec<f64> = hand["approach_direction"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| c.as_f64().unwrap())
            .collect();
        let length = way.iter().map(|c| c * c).sum::<f64>().sqrt();
        assert!((length - 1.0).abs() < 1e-9);
        assert!(hand["clearance_to_support_m"].as_f64().unwrap() >= 3e-3 - 1e-9);
    }
}
