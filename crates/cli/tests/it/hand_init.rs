//! From a URDF alone to a grasp, by two commands.

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{fitted, moduli, refused, stdout};
use crate::hands::{CENTRE, URDF, gripper, read};

const TOML: &str = "gripper/urdf/gripper.toml";

#[test]
fn two_commands_lead_from_a_urdf_to_grasps() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    gripper(here);
    std::fs::remove_file(here.join(TOML)).unwrap();
    fitted(here, "egg", [0.03, 0.025, 0.035], CENTRE);
    let synthesize = [
        "synthesize",
        "egg.shape",
        "--hand",
        URDF,
        "--poses",
        "60",
        "-o",
        "out",
    ];
    // Without a TOML the program says how to get one.
    refused(&moduli(here, &synthesize), 3, &["hand init"]);
    let line: Value =
        serde_json::from_str(&stdout(&moduli(here, &["hand", "init", URDF, "--json"]))).unwrap();
    assert_eq!(line["spec"], TOML);
    assert_eq!(line["palm_link"], "base");
    assert_eq!(line["fingers"], serde_json::json!(["left", "right"]));
    stdout(&moduli(here, &synthesize));
    let file = read(here, "out/grasps.json");
    assert!(file["grasps"].as_array().unwrap().len() >= 20);
    let checked = moduli(here, &["hand", "check", URDF, "-o", "p.html"]);
    assert!(stdout(&checked).contains("0 errors, 0 warnings"));
}

#[test]
fn what_exists_is_not_overwritten_unasked() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    gripper(here);
    let before = std::fs::read(here.join(TOML)).unwrap();
    refused(
        &moduli(here, &["hand", "init", URDF]),
        2,
        &["exists already", "-o"],
    );
    assert_eq!(std::fs::read(here.join(TOML)).unwrap(), before);
    // The URDF itself is never written over, whatever is asked.
    let urdf = std::fs::read(here.join(URDF)).unwrap();
    refused(
        &moduli(here, &["hand", "init", URDF, "-o", URDF]),
        2,
        &["gripper.urdf"],
    );
    let mesh = "gripper/meshes/tip.obj";
    refused(
        &moduli(here, &["hand", "init", URDF, "-o", mesh]),
        2,
        &["tip.obj"],
    );
    assert_eq!(std::fs::read(here.join(URDF)).unwrap(), urdf);
    stdout(&moduli(here, &["hand", "init", URDF, "-o", TOML]));
    let once = std::fs::read(here.join(TOML)).unwrap();
    stdout(&moduli(here, &["hand", "init", URDF, "-o", TOML]));
    assert_eq!(std::fs::read(here.join(TOML)).unwrap(), once);
    refused(
        &moduli(
            here,
            &["hand", "init", URDF, "--palm", "wrist", "-o", "x.toml"],
        ),
        3,
        &["no link is named 'wrist'", "base, left, right"],
    );
    assert!(!here.join("x.toml").exists());
}
