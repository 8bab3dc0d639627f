//! `synthesize`, `hand check` and hands of one's own, as a user runs them.

use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{fitted, moduli, refused, stdout};

/// Where objects stand in their clouds.
pub(crate) const CENTRE: [f64; 3] = [1.0, 0.0, 0.2];

/// A gripper of two fingers that slide towards each other, with tips from a mesh in a package.
pub(crate) fn gripper(folder: &Path) {
    let finger = |side: &str, y: f64| {
        format!(
            r#"<link name="{side}"><collision><origin xyz="0 0 0.06"/><geometry>
<mesh filename="package://gripper/meshes/tip.obj" scale="0.01 0.01 0.05"/></geometry></collision></link>
<joint name="{side}_slide" type="prismatic"><parent link="base"/><child link="{side}"/>
<origin xyz="0 {y} 0"/><axis xyz="0 {} 0"/><limit lower="0" upper="0.09" effort="1" velocity="1"/></joint>"#,
            -y.signum()
        )
    };
    let urdf = format!(
        r#"<robot name="gripper"><link name="base"><collision><geometry>
<box size="0.04 0.3 0.02"/></geometry></collision></link>{}{}</robot>"#,
        finger("left", 0.1),
        finger("right", -0.1)
    );
    let spec = r#"
name = "gripper"
palm = "base"
approach_axis = [0.0, 0.0, 1.0]
standoff_m = [0.05, 0.06]
[[finger]]
name = "left"
tips = ["left"]
closing = { left_slide = 1.0 }
[[finger]]
name = "right"
tips = ["right"]
closing = { right_slide = 1.0 }
[[preshape]]
name = "open"
joints = {}
[[preshape]]
name = "half"
joints = { left_slide = 0.03, right_slide = 0.03 }
"#;
    let tip: String = (0..8)
        .map(|k| {
            let side = |bit: usize| if k >> bit & 1 == 0 { -1 } else { 1 };
            format!("v {} {} {}\n", side(0), side(1), side(2))
        })
        .collect();
    std::fs::create_dir_all(folder.join("gripper/urdf")).unwrap();
    std::fs::create_dir_all(folder.join("gripper/meshes")).unwrap();
    std::fs::write(folder.join("gripper/urdf/gripper.urdf"), urdf).unwrap();
    std::fs::write(folder.join("gripper/urdf/gripper.toml"), spec).unwrap();
    std::fs::write(folder.join("gripper/meshes/tip.obj"), tip).unwrap();
}

pub(crate) const URDF: &str = "gripper/urdf/gripper.urdf";

pub(crate) fn read(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join(name)).unwrap()).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap().iter();
    list.map(|v| v.as_f64().unwrap()).collect()
}

#[test]
fn synthesis_writes_json_yaml_and_a_page() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let arguments = [
        "synthesize",
        "egg.shape",
        "--poses",
        "60",
        "--keep",
        "5",
        "--preshape",
        "spread",
        "--json",
        "-o",
        "one",
    ];
    let said: Value = serde_json::from_str(&stdout(&moduli(here, &arguments))).unwrap();
    let count = |v: &Value| v.as_u64().unwrap();
    let rejected: u64 = said["rejected"]
        .as_object()
        .unwrap()
        .values()
        .map(count)
        .sum();
    assert_eq!(
        count(&said["stable"]) + rejected,
        60,
        "every pose is counted"
    );
    assert_eq!((count(&said["poses"]), count(&said["kept"])), (60, 5));
    assert_eq!(said["preshapes"], serde_json::json!(["spread"]));

    let file = read(here, "one/grasps.json");
    assert_eq!(file["convention"]["tangent"], "least_aligned");
    let best = &file["grasps"][0];
    assert_eq!(best["quality"], said["best"]);
    assert_eq!(best["hand"]["palm_link"], "sdh_palm_link");
    let before = &best["hand"]["pregrasp_joints_rad"];
    assert!(
        (before["sdh_knuckle_joint"].as_f64().unwrap() - std::f64::consts::FRAC_PI_3).abs()
            <= 1e-12
    );
    for grasp in file["grasps"].as_array().unwrap() {
        for contact in grasp["contacts_m"].as_array().unwrap() {
            let x = numbers(contact);
            let level = ((x[0] - 1.0) / 0.035).powi(2)
                + (x[1] / 0.030).powi(2)
                + ((x[2] - 0.2) / 0.045).powi(2);
            assert!((level - 1.0).abs() <= 0.05, "{x:?}");
        }
    }

    let yaml = std::fs::read_to_string(here.join("one/grasps.yaml")).unwrap();
    assert!(yaml.starts_with("format: isaac_grasp\nformat_version: 1.0\n"));
    assert_eq!(yaml.matches("    confidence: ").count(), 5);
    let pose = &best["hand"]["object_from_palm"];
    let position: Vec<String> = numbers(&pose["translation_m"])
        .iter()
        .map(f64::to_string)
        .collect();
    assert!(yaml.contains(&format!("position: [{}]", position.join(", "))));
    assert!(yaml.contains("gripper_frame_link: \"sdh_palm_link\""));
    let page = std::fs::read_to_string(here.join("one/index.html")).unwrap();
    assert!(page.contains("Plotly") && page.contains("hand poses give a stable grasp"));
    // What comes out goes into the other commands.
    stdout(&moduli(here, &["quality", "one/grasps.json"]));
    stdout(&moduli(here, &["ascend", "egg.shape", "one/grasps.json"]));
}

#[test]
fn the_seed_decides_and_not_the_threads() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let run = |output: &str, more: &[&str]| {
        let arguments = ["synthesize", "egg.shape", "--poses", "60", "-o", output];
        stdout(&moduli(here, &[&arguments[..], more].concat()));
    };
    run("one", &[]);
    run("two", &["--threads", "1"]);
    for name in ["grasps.json", "grasps.yaml", "index.html"] {
        let bytes = |run: &str| std::fs::read(here.join(run).join(name)).unwrap();
        assert!(bytes("one") == bytes("two"), "{name}");
    }
    run("three", &["--seed", "1"]);
    assert_ne!(
        read(here, "three/grasps.json"),
        read(here, "one/grasps.json")
    );
}

#[test]
fn power_grasps_have_contacts_of_more_than_tips() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "can", [0.033, 0.033, 0.050], CENTRE);
    let contacts = |more: &[&str]| -> Vec<usize> {
        let mut arguments = vec!["synthesize", "can.shape", "--poses", "80", "-o", "out"];
        arguments.extend(more);
        stdout(&moduli(here, &arguments));
        let file = read(here, "out/grasps.json");
        let grasps = file["grasps"].as_array().unwrap().iter();
        let count = |g: &Value| {
            let count = g["contacts_m"].as_array().unwrap().len();
            assert_eq!(g["inward_normals"].as_array().unwrap().len(), count);
            count
        };
        grasps.map(count).collect()
    };
    assert!(contacts(&[]).iter().all(|n| *n == 3));
    // Held from the side, which the plane on which the can stands forbids.
    let held = contacts(&["--power", "--support", "none"]);
    assert!(held.iter().any(|n| *n > 3), "{held:?}");
}

#[test]
fn a_stand_off_below_the_surface_ends_in_words() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let sdh = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/sdh");
    let toml = std::fs::read_to_string(sdh.join("sdh.toml")).unwrap();
    let below = toml.replace("standoff_m = [0.15, 0.19]", "standoff_m = [-0.05, -0.05]");
    assert_ne!(below, toml);
    std::fs::write(here.join("below.toml"), below).unwrap();
    let urdf = sdh.join("sdh.urdf");
    let hand = ["--hand", urdf.to_str().unwrap(), "--spec", "below.toml"];
    let power = ["synthesize", "egg.shape", "--power", "--poses", "5"];
    refused(
        &moduli(here, &[&power[..], &hand].concat()),
        4,
        &["0 grasps"],
    );
    let whole = "grasp egg.xyz --degree 8 --poses 2 --neighbours 1 --transfers 1";
    let whole: Vec<&str> = whole.split(' ').collect();
    stdout(&moduli(here, &[&whole[..], &hand].concat()));
}

#[test]
fn no_grasps_say_why() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "crumb", [0.006, 0.006, 0.006], CENTRE);
    let arguments = ["synthesize", "crumb.shape", "--poses", "20", "-o", "none"];
    let output = moduli(here, &arguments);
    refused(&output, 4, &["0 grasps of the hand sdh", "of 20 poses"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("0 of 20 hand poses"), "{said}");
    let file = read(here, "none/grasps.json");
    assert_eq!(file["grasps"], serde_json::json!([]));
    let yaml = std::fs::read_to_string(here.join("none/grasps.yaml")).unwrap();
    assert!(yaml.ends_with("grasps: {}\n"));
}

#[test]
fn a_hand_of_ones_own_is_checked_and_used() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    gripper(here);
    let root = ["--package-root", "."];
    let check = ["hand", "check", URDF, "--json", "-o", "page.html"];
    let line = stdout(&moduli(here, &[&check[..], &root].concat()));
    let said: Value = serde_json::from_str(&line).unwrap();
    assert_eq!(said["errors"], 0, "{line}");
    assert_eq!(said["hand"]["name"], "gripper");
    assert_eq!(
        said["hand"]["fingers"],
        serde_json::json!(["left", "right"])
    );
    let page = std::fs::read_to_string(here.join("page.html")).unwrap();
    assert!(page.contains("figure-0-data") && page.contains("left_slide"));

    // Two hard points never hold, and the program says so; soft fingers do.
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let with = [
        "synthesize",
        "egg.shape",
        "--hand",
        URDF,
        "--package-root",
        ".",
        "--poses",
        "30",
        "-o",
        "two",
    ];
    let points = [&with[..], &["--contact", "point"]].concat();
    let words = [
        "gripper",
        "unstable",
        "never resist a torque",
        "soft:RADIUS",
    ];
    refused(&moduli(here, &points), 4, &words);
    stdout(&moduli(here, &with));
    let contact = &read(here, "two/grasps.json")["convention"]["contact"];
    assert_eq!(
        contact,
        &serde_json::json!({"model": "soft", "radius_m": 0.005})
    );
    assert!(line.contains("pad_radius_m"), "{line}");
    let whole = [
        "grasp",
        "egg.xyz",
        "--degree",
        "8",
        "--hand",
        URDF,
        "--package-root",
        ".",
        "--poses",
        "10",
        "--neighbours",
        "1",
        "--transfers",
        "2",
        "-o",
        "whole",
    ];
    let said = stdout(&moduli(here, &whole));
    assert!(
        said.contains("2 grasps of the library are left out"),
        "{said}"
    );
    let file = read(here, "whole/grasps.json");
    let grasps = file["grasps"].as_array().unwrap();
    assert!(!grasps.is_empty());
    for grasp in grasps {
        assert_eq!(grasp["hand"]["name"], "gripper");
        assert_eq!(grasp["contacts_m"].as_array().unwrap().len(), 2);
    }
}

#[test]
fn everything_wrong_with_a_hand_is_told_at_once() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    gripper(here);
    let toml = here.join("gripper/urdf/gripper.toml");
    let good = std::fs::read_to_string(&toml).unwrap();
    let bad = good
        .replace("tips = [\"right\"]", "tips = [\"claw\", \"hook\"]")
        .replace("palm = \"base\"", "palm = \"hand\"")
        .replace("left_slide = 0.03", "left_slide = 3.0")
        .replace("right_slide = 0.03", "knuckle = 0.0");
    std::fs::write(&toml, bad).unwrap();
    std::fs::remove_file(here.join("gripper/meshes/tip.obj")).unwrap();
    let output = moduli(here, &["hand", "check", URDF, "--package-root", "."]);
    refused(&output, 3, &["gripper.urdf", "6 errors"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    for word in [
        "'claw'",
        "'hook'",
        "'hand'",
        "'base'",
        "'knuckle'",
        "left_slide",
        "0.09",
        "tip.obj",
    ] {
        assert!(said.contains(word), "{word} is not in: {said}");
    }
    assert!(
        !here.join("out").exists(),
        "no page of a hand that cannot be used"
    );
    let line = moduli(here, &["hand", "check", URDF, "--json"]);
    let said: Value = serde_json::from_slice(&line.stdout).unwrap();
    assert!(said["hand"].is_null());
    assert!(said["findings"][0]["place"].is_string());
}

#[test]
fn hostile_hands_are_refused_by_name() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    gripper(here);
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let hand = |urdf: &str, spec: &str| {
        let arguments = [
            "synthesize",
            "egg.shape",
            "--hand",
            urdf,
            "--spec",
            spec,
            "--poses",
            "5",
            "-o",
            "x",
        ];
        moduli(here, &arguments)
    };
    let toml = "gripper/urdf/gripper.toml";
    refused(&hand("missing.urdf", toml), 3, &["missing.urdf"]);
    refused(&hand("gripper", toml), 3, &["gripper", "directory"]);
    refused(&hand("egg.shape", toml), 3, &["egg.shape", "not XML"]);
    refused(&hand(toml, toml), 3, &["gripper.toml"]);
    // Outside the folders of packages nothing is read.
    std::fs::create_dir_all(here.join("apart/urdf")).unwrap();
    std::fs::copy(here.join(URDF), here.join("apart/urdf/g.urdf")).unwrap();
    let apart = hand("apart/urdf/g.urdf", toml);
    refused(&apart, 3, &["tip.obj", "no such file", "--package-root"]);
    let with_root = |spec: &str| {
        let arguments = [
            "synthesize",
            "egg.shape",
            "--hand",
            URDF,
            "--package-root",
            ".",
            "--spec",
            spec,
            "--poses",
            "5",
            "-o",
            "x",
        ];
        moduli(here, &arguments)
    };
    std::fs::write(here.join("empty.toml"), "").unwrap();
    refused(&with_root("empty.toml"), 3, &["empty.toml", "name"]);
    let bare = ["synthesize", "egg.shape", "--hand", "bare.urdf"];
    std::fs::write(
        here.join("bare.urdf"),
        "<robot name=\"r\"><link name=\"a\"/></robot>",
    )
    .unwrap();
    refused(&moduli(here, &bare), 3, &["bare.toml", "--spec"]);
    refused(&with_root("gripper"), 3, &["gripper", "directory"]);
    let spec = std::fs::read_to_string(here.join(toml)).unwrap();
    let unknown = spec.replace("tips = [\"left\"]", "tips = [\"thumb\"]");
    std::fs::write(here.join("unknown.toml"), unknown).unwrap();
    refused(
        &with_root("unknown.toml"),
        3,
        &["unknown.toml", "'thumb'", "does not exist", "hand check"],
    );
    assert!(!here.join("x").exists(), "no result of a failure");
}

#[test]
fn options_of_hands_are_checked() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    std::fs::write(here.join("empty.toml"), "").unwrap();
    fitted(here, "egg", [0.035, 0.030, 0.045], CENTRE);
    let wrong_shape = ["synthesize", "egg.xyz", "-o", "x"];
    refused(&moduli(here, &wrong_shape), 3, &["egg.xyz", "moduli fit"]);
    for (flag, value, word) in [
        ("--preshape", "fist", "parallel, spread"),
        ("--least-quality", "NaN", "least-quality"),
        ("--poses", "0", "poses"),
        ("--spec", "empty.toml", "own TOML"),
    ] {
        let arguments = ["synthesize", "egg.shape", flag, value, "-o", "x"];
        refused(&moduli(here, &arguments), 2, &[word]);
    }
    assert!(!here.join("x").exists(), "no result of a failure");
    refused(
        &moduli(
            here,
            &["hand", "check", "sdh", "--ball", "-3", "-o", "p.html"],
        ),
        2,
        &["--ball -3"],
    );
    refused(
        &moduli(here, &["hand", "check", "none.urdf"]),
        3,
        &["none.urdf", "2 errors"],
    );
}
