//! The YAML file for Isaac Sim.

use std::collections::BTreeMap;

use record::grasps::{
    ExecutionRecord, HandRecord, JointRecord, JointUnit, PoseRecord, SourceRecord,
};
use record::{GraspRecord, isaac_grasps};

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
