//! Grasps as YAML in the fields of the message `moveit_msgs/Grasp`.
//!
//! Readers fill a message from it, for instance `genpy.message.fill_message_args` of ROS 1 or
//! `rosidl_runtime_py.set_message_fields` of ROS 2; fields that are left out keep their defaults.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::grasps::{GraspRecord, GraspsFile, HandRecord, JointRecord};
use crate::isaac::{number, quoted};

/// How far the hand comes along the approach and goes back, metres: wanted and least.
const DISTANCE: [f64; 2] = [0.1, 0.05];

/// The YAML text: a list `grasps` with an entry for every grasp that has a hand, by rank.
///
/// `grasp_pose` is the pose of the palm in the frame of the cloud, whose name is that of the object.
/// The postures hold the driven joints before and after closing (radians, or metres for prismatic
/// joints). The hand retreats along the normal of the support, or against its approach without one.
///
/// ```
/// let text = br#"{"version": 2, "object": {"name": "cup", "centre_m": [0, 0, 0],
///     "r_min_certified_m": 0.01, "r_max_certified_m": 0.02, "centre_of_mass_m": [0, 0, 0],
///     "volume_m3": 1e-6}, "convention": {"name": "paper", "edge_norm": "unit_normal_component",
///     "torque_length_m": 0.01, "centre": "cloud_mean", "friction": 1.0, "edges": 10,
///     "not_closed": 0.0}, "grasps": []}"#;
/// let file = record::GraspsFile::from_json(text).unwrap();
/// assert!(record::moveit_grasps(&file).ends_with("grasps: []\n"));
/// ```
pub fn moveit_grasps(file: &GraspsFile) -> String {
    let mut text = String::from("# moveit_msgs/Grasp; poses in the frame of the object's cloud\n");
    let hands = || {
        let all = file.grasps.iter();
        all.filter_map(|g| Some((g, g.hand.as_ref()?)))
    };
    if hands().next().is_none() {
        text.push_str("grasps: []\n");
        return text;
    }
    text.push_str("grasps:\n");
    let up = file.object.support.map(|s| s.normal);
    for (grasp, hand) in hands() {
        entry(&mut text, &file.object.name, up, grasp, hand);
    }
    text
}

fn entry(
    text: &mut String,
    object: &str,
    up: Option<[f64; 3]>,
    grasp: &GraspRecord,
    hand: &HandRecord,
) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "  - id: {}", quoted(&format!("grasp_{}", grasp.rank)));
    let before = if hand.pregrasp_joints.is_empty() {
        &hand.joints
    } else {
        &hand.pregrasp_joints
    };
    posture(text, "pre_grasp_posture", before);
    posture(text, "grasp_posture", &hand.joints);
    let frame = quoted(object);
    let [x, y, z] = hand.cloud_from_palm.translation_m.map(number);
    let [qx, qy, qz, qw] = hand.cloud_from_palm.quaternion_xyzw.map(number);
    let _ = writeln!(
        text,
        "    grasp_pose:\n      header: {{frame_id: {frame}}}\n      pose:\n        position: {{x: {x}, y: {y}, z: {z}}}\n        orientation: {{x: {qx}, y: {qy}, z: {qz}, w: {qw}}}"
    );
    let _ = writeln!(text, "    grasp_quality: {}", number(grasp.quality));
    if let Some(approach) = hand.execution.approach_direction {
        way(text, "pre_grasp_approach", &frame, approach);
        let away = up.unwrap_or(approach.map(|c| -c));
        way(text, "post_grasp_retreat", &frame, away);
    }
}

fn posture(text: &mut String, key: &str, joints: &BTreeMap<String, JointRecord>) {
    let driven = || joints.iter().filter(|(_, joint)| joint.follows.is_none());
    let names: Vec<String> = driven().map(|(name, _)| quoted(name)).collect();
    let values: Vec<String> = driven().map(|(_, joint)| number(joint.value)).collect();
    let _ = writeln!(
        text,
        "    {key}:\n      joint_names: [{}]\n      points:\n        - positions: [{}]",
        names.join(", "),
        values.join(", ")
    );
}

fn way(text: &mut String, key: &str, frame: &str, direction: [f64; 3]) {
    let [x, y, z] = direction.map(number);
    let [wanted, least] = DISTANCE.map(number);
    let _ = writeln!(
        text,
        "    {key}:\n      direction:\n        header: {{frame_id: {frame}}}\n        vector: {{x: {x}, y: {y}, z: {z}}}\n      desired_distance: {wanted}\n      min_distance: {least}"
    );
}
