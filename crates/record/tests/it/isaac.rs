//! The YAML file for Isaac Sim.

use std::collections::BTreeMap;

use record::grasps::{
    ExecutionRecord, HandRecord, JointRecord, JointUnit, PoseRecord, SourceRecord,
};
use record::{GraspRecord, IsaacFile, isaac_grasps};

use crate::grasps::{file, grasp};

fn with_hand(quality: f64) -> GraspRecord {
    let joint = |name: &str, value, unit| {
        let joint = JointRecord {
            value,
            unit: Some(unit),
            follows: None,
        };
        BTreeMap::from([(name.to_owned(), joint)])
    };
    let hand = HandRecord {
        name: "two".to_owned(),
        palm_link: "palm".to_owned(),
        cloud_from_palm: PoseRecord {
            translation_m: [0.1, -0.0, 1e-9],
            quaternion_xyzw: [0.0, 0.6, 0.0, 0.8],
        },
        joints: joint("joint_0.0", 1.0, JointUnit::Radians),
        pregrasp_joints: joint("a \"b\": c", -0.25, JointUnit::Metres),
        contact_error_m: 0.0,
        execution: ExecutionRecord::default(),
    };
    GraspRecord {
        hand: Some(hand),
        ..grasp(quality, SourceRecord::Synthesis)
    }
}

#[test]
fn only_grasps_with_a_hand_are_written() {
    let mut file = file();
    file.grasps.clear();
    assert!(isaac_grasps(&file).ends_with("gripper_frame_link: \"\"\n\ngrasps: {}\n"));
    file.grasps = vec![grasp(0.5, SourceRecord::Synthesis), with_hand(1.5)];
    let expected = "format: isaac_grasp
format_version: 1.0

object_frame_link: \"ball\"
gripper_frame_link: \"palm\"

grasps:
  grasp_0:
    confidence: 1.0
    position: [0.1, 0.0, 0.000000001]
    orientation: {w: 0.8, xyz: [0.0, 0.6, 0.0]}
    cspace_position:
      \"joint_0.0\": 1.0
    pregrasp_cspace_position:
      \"a \\\"b\\\": c\": -0.25
";
    assert_eq!(isaac_grasps(&file), expected);
}

#[test]
fn what_is_written_is_read_again() {
    let mut file = file();
    file.grasps = vec![with_hand(0.5)];
    let read = IsaacFile::from_yaml(&isaac_grasps(&file)).unwrap();
    assert_eq!(read.object_frame_link, "ball");
    assert_eq!(read.gripper_frame_link, "palm");
    let [grasp] = &read.grasps[..] else {
        panic!("{read:?}");
    };
    let hand = file.grasps[0].hand.as_ref().unwrap();
    assert_eq!(grasp.name, "grasp_0");
    assert_eq!(grasp.confidence, Some(0.5));
    assert_eq!(grasp.pose, hand.cloud_from_palm);
    assert_eq!(grasp.joints["joint_0.0"], 1.0);
    assert_eq!(grasp.pregrasp_joints["a \"b\": c"], -0.25);
}

/// The layout that the Grasp Editor writes: lists in blocks, keys in another order, further keys.
#[test]
fn block_style_and_unknown_keys_are_read() {
    let text = "format: isaac_grasp
format_version: '1.0'
created_with: x

object_frame_link: /World/cube
gripper_frame_link: /World/hand/palm

grasps:
  flat:
    confidence: 1
    position:
    - -0.5
    - 1e-3
    - 2
    orientation:
      w: -1.0
      xyz: [0, 0, 0]
    cspace_position: {finger_joint: 0.17} # closed
    note: {a: [1]}
";
    let read = IsaacFile::from_yaml(text).unwrap();
    assert_eq!(read.grasps[0].pose.translation_m, [-0.5, 1e-3, 2.0]);
    assert_eq!(read.grasps[0].joints["finger_joint"], 0.17);
    assert!(read.grasps[0].pregrasp_joints.is_empty());
}

#[test]
fn other_texts_are_refused_by_line_and_key() {
    let whole = "format: isaac_grasp\nformat_version: 1.0\ngrasps:\n  g:\n    position: [0, 0, 1]\n    orientation: {w: 1, xyz: [0, 0, 0]}\n";
    assert!(IsaacFile::from_yaml(whole).is_ok());
    let said = |from: &str, to: &str| {
        assert!(whole.contains(from));
        let text = whole.replace(from, to);
        IsaacFile::from_yaml(&text).unwrap_err().to_string()
    };
    let cases = [
        (
            "isaac_grasp",
            "moveit",
            "line 1: `format` is `moveit`; expected `isaac_grasp`",
        ),
        (
            "1.0",
            "2.0",
            "line 2: `format_version` is `2.0`; expected 1.0",
        ),
        (
            "[0, 0, 1]",
            "[0, 0]",
            "line 5: `g.position` has 2 entries; expected three numbers",
        ),
        (
            "[0, 0, 1]",
            "[0, .nan, 1]",
            "line 5: `g.position` is `.nan`; expected a finite number",
        ),
        (
            "w: 1",
            "w: 0.5",
            "line 6: `g.orientation` has the length 0.500; expected a unit quaternion",
        ),
        (
            "position",
            "place",
            "`g.position` is missing; expected a value",
        ),
        (
            "[0, 0, 1]",
            "&a [0, 0, 1]\n    b: *a",
            "line 6: aliases (`*name`) are not read",
        ),
        ("[0, 0, 1]", "[0, 0, 1", "line 6"),
        (
            "orientation",
            "position",
            "line 6: the key `position` is given twice",
        ),
    ];
    for (from, to, expected) in cases {
        let text = said(from, to);
        assert!(text.contains(expected), "{from} -> {to}: {text}");
    }
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    let deep = IsaacFile::from_yaml(&deep).unwrap_err().to_string();
    assert!(deep.starts_with("line 1: "), "{deep}");
    let nested = format!("{}a{}", "[".repeat(17), "]".repeat(17));
    let nested = IsaacFile::from_yaml(&nested).unwrap_err().to_string();
    assert!(nested.contains("nested deeper"), "{nested}");
    assert!(
        IsaacFile::from_yaml("")
            .unwrap_err()
            .to_string()
            .contains("empty")
    );
}
