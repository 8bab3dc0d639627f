//! Built-in grippers, names of hands, and what `hand check` says of hulls, as a user sees it.

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{fitted, moduli, refused, stdout};
use crate::hands::{CENTRE, URDF, gripper, read};

#[test]
fn unknown_names_are_answered_with_the_known_ones() {
    let folder = TempDir::new().unwrap();
    for arguments in [["grasp", "--hand", "shadow"], ["hand", "check", "shadow"]] {
        let output = moduli(folder.path(), &arguments);
        refused(&output, 2, &["no hand is named `shadow`", "sdh", "URDF"]);
    }
}

/// The tips reach past a ball that a hull of the base's mesh fills.
#[test]
fn a_hull_that_fills_the_hand_is_linked_to_what_it_does() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    gripper(here);
    let urdf = std::fs::read_to_string(here.join(URDF)).unwrap();
    let palm = r#"<box size="0.04 0.3 0.02"/>"#;
    let mesh = r#"<mesh filename="package://gripper/meshes/u.obj"/>"#;
    std::fs::write(here.join(URDF), urdf.replace(palm, mesh)).unwrap();
    let corner = |k: usize| {
        let side = |bit: usize, low: f64, high: f64| if k >> bit & 1 == 0 { low } else { high };
        format!(
            "v {} {} {}\n",
            side(0, -0.05, 0.05),
            side(1, -0.15, 0.15),
            side(2, -0.01, 0.1)
        )
    };
    let u: String = (0..8).map(corner).collect();
    std::fs::write(here.join("gripper/meshes/u.obj"), u).unwrap();
    // The package is found without being told where it is.
    let output = moduli(here, &["hand", "check", URDF, "-o", "p.html"]);
    // Nothing can be grasped with that hull.
    refused(&output, 3, &["cannot be used"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let words = "the convex hull of the mesh 'package://gripper/meshes/u.obj' stands in for 'base' and fills its hollows";
    assert!(said.contains(words), "{said}");
}

#[test]
fn a_built_in_gripper_writes_all_its_joints_and_its_contact_model() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let arguments = "synthesize egg.shape --hand panda --poses 60 -o out";
    stdout(&moduli(here, &arguments.split(' ').collect::<Vec<_>>()));
    let file = read(here, "out/grasps.json");
    assert_eq!(file["convention"]["contact"]["radius_m"], 0.009);
    let grasps = file["grasps"].as_array().unwrap();
    assert!(grasps.len() >= 20, "{}", grasps.len());
    for grasp in grasps {
        let joints = &grasp["hand"]["joints"];
        let [one, two] = [1, 2].map(|k| &joints[format!("panda_finger_joint{k}")]);
        assert_eq!(one["value"], two["value"]);
        assert_eq!((&one["unit"], &two["unit"]), (&"m".into(), &"m".into()));
        assert!(one["follows"].is_null());
        assert_eq!(two["follows"], "panda_finger_joint1");
        // The older keys and the YAML hold what is driven.
        let older = grasp["hand"]["joints_rad"].as_object().unwrap();
        assert_eq!(older.keys().collect::<Vec<_>>(), ["panda_finger_joint1"]);
    }
    let yaml = std::fs::read_to_string(here.join("out/grasps.yaml")).unwrap();
    assert!(yaml.contains("panda_finger_joint1") && !yaml.contains("panda_finger_joint2"));
    let page = std::fs::read_to_string(here.join("out/index.html")).unwrap();
    assert!(page.contains("panda_finger_joint2"));

    // The file says how its contacts were taken, and quality takes them so.
    let again = ["quality", "out/grasps.json", "--json", "-o", "q.csv"];
    let line: Value = serde_json::from_str(&stdout(&moduli(here, &again))).unwrap();
    assert_eq!(line["closed"], grasps.len());
    let best = line["best"].as_f64().unwrap();
    assert!((best - grasps[0]["quality"].as_f64().unwrap()).abs() < 1e-9);
    let points = ["quality", "out/grasps.json", "--json", "--contact", "point"];
    let line: Value = serde_json::from_str(&stdout(&moduli(here, &points))).unwrap();
    assert_eq!(line["closed"], 0);
}

#[test]
fn hands_stay_above_the_support_unless_there_is_none() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let run = |more: &[&str]| -> Value {
        let mut arguments = vec!["synthesize", "egg.shape", "--poses", "60", "-o", "out"];
        arguments.extend(more);
        stdout(&moduli(here, &arguments));
        read(here, "out/grasps.json")
    };
    // The foot of the object, 45 mm below its centre.
    let auto = run(&[]);
    let support = &auto["object"]["support"];
    assert_eq!(support["normal"], serde_json::json!([0.0, 0.0, 1.0]));
    let foot = support["offset_m"].as_f64().unwrap();
    assert!((foot - (CENTRE[2] - 0.045)).abs() < 5e-4, "{foot}");
    let grasps = auto["grasps"].as_array().unwrap();
    assert!(!grasps.is_empty());
    for grasp in grasps {
        let hand = &grasp["hand"];
        assert!(hand["clearance_to_support_m"].as_f64().unwrap() >= 3e-3);
        assert!(hand["approach_direction"][2].as_f64().unwrap() <= 1e-9);
    }
    // Lower by 20 cm, the plane is in nobody's way.
    let given = run(&["--support", "0,0,2,0.09"]);
    let offset = given["object"]["support"]["offset_m"].as_f64().unwrap();
    assert!((offset + 0.045).abs() < 1e-12, "{offset}");
    let none = run(&["--support", "none"]);
    assert!(none["object"]["support"].is_null());
    assert!(none["grasps"][0]["hand"]["clearance_to_support_m"].is_null());
    let count = |file: &Value| file["grasps"].as_array().unwrap().len();
    assert_eq!(count(&given), count(&none));
    for bad in ["0,0,0,1", "table"] {
        let arguments = ["synthesize", "egg.shape", "--support", bad, "-o", "x"];
        refused(&moduli(here, &arguments), 2, &["--support", bad]);
    }
}
