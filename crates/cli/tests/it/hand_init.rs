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

#[test]
fn a_hand_that_grasps_nothing_cannot_be_used() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    gripper(here);
    let check = ["hand", "check", URDF, "-o", "p.html"];
    // Two hard points hold no ball of any size.
    let points = moduli(here, &[&check[..], &["--contact", "point"]].concat());
    refused(&points, 3, &["cannot be used"]);
    let said = String::from_utf8_lossy(&points.stdout).into_owned();
    assert!(said.contains("--contact soft:RADIUS"), "{said}");
    assert!(said.contains("no other ball can be grasped"), "{said}");
    // A ball that is too large is no fault of the hand.
    let large = moduli(here, &[&check[..], &["--ball", "400"]].concat());
    assert!(stdout(&large).contains("mm can be grasped"));
}

/// A bottle beside another one: what stands beside the object is in the way of hands.
#[test]
fn other_pieces_of_the_scene_are_obstacles() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let ball = |centre: [f64; 3], radius: f64, count: usize| {
        let rows = sph::direction::even_directions(count);
        let row = |d: &sph::Direction| {
            let at = |k: usize| centre[k] + radius * d[k];
            format!("{} {} {}\n", at(0), at(1), at(2))
        };
        rows.iter().map(row).collect::<String>()
    };
    let object = ball([0.5, 0.2, 0.05], 0.035, 4000);
    let rejected = |name: &str, text: String| {
        std::fs::write(here.join(name), text).unwrap();
        let output = format!("{name}.out");
        let arguments = [
            "grasp",
            name,
            "--neighbours",
            "0",
            "--poses",
            "150",
            "--json",
            "-o",
            &output,
        ];
        let said: Value = serde_json::from_str(&stdout(&moduli(here, &arguments))).unwrap();
        said["rejected"]["obstacle"].as_u64().unwrap()
    };
    assert_eq!(rejected("alone.xyz", object.clone()), 0);
    let beside = object + &ball([0.575, 0.2, 0.05], 0.02, 800);
    let found = rejected("beside.xyz", beside);
    assert!(found >= 5, "{found}");
}
