//! Grasps as an `isaac_grasp` YAML file of version 1.0, which Isaac Sim's Grasp Editor writes and
//! its `import_grasps_from_file` reads.
//!
//! The format describes one object and one gripper, so grasps without a hand are left out. It holds
//! poses and joint values and no contacts: these follow from the surface and the hand.

mod error;
mod read;
mod yaml;

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::grasps::{GraspsFile, HandRecord, JointRecord};

pub use error::IsaacError;
pub use read::{IsaacFile, IsaacGrasp};

/// The YAML text: every grasp that has a hand, by rank, as `grasp_0`, `grasp_1`, …
///
/// `position` (metres) and `orientation` (quaternion) are the pose of the palm in the frame of the
/// cloud. `cspace_position` holds the driven joints in the grasp (radians, or metres for prismatic
/// joints), and `pregrasp_cspace_position` the same before the fingers close. The format requires a
/// `confidence` in [0, 1]; it is the quality, clamped to 1.
pub fn isaac_grasps(file: &GraspsFile) -> String {
    let hands = || {
        file.grasps
            .iter()
            .filter_map(|g| Some((g, g.hand.as_ref()?)))
    };
    let palm = hands().next().map_or("", |(_, hand)| &hand.palm_link);
    let mut text = String::from("format: isaac_grasp\nformat_version: 1.0\n\n");
    line(
        &mut text,
        0,
        "object_frame_link",
        &quoted(&file.object.name),
    );
    line(&mut text, 0, "gripper_frame_link", &quoted(palm));
    if hands().next().is_none() {
        return text + "\ngrasps: {}\n";
    }
    text.push_str("\ngrasps:\n");
    for (index, (grasp, hand)) in hands().enumerate() {
        let _ = writeln!(text, "  grasp_{index}:");
        let confidence = number(grasp.quality.clamp(0.0, 1.0));
        line(&mut text, 4, "confidence", &confidence);
        pose(&mut text, hand);
        joints(&mut text, "cspace_position", &hand.joints);
        if !hand.pregrasp_joints.is_empty() {
            let before = &hand.pregrasp_joints;
            joints(&mut text, "pregrasp_cspace_position", before);
        }
    }
    text
}

fn line(text: &mut String, indent: usize, key: &str, value: &str) {
    let _ = writeln!(text, "{:indent$}{key}: {value}", "");
}

fn pose(text: &mut String, hand: &HandRecord) {
    let list = |numbers: &[f64]| {
        let numbers: Vec<String> = numbers.iter().map(|v| number(*v)).collect();
        format!("[{}]", numbers.join(", "))
    };
    let [x, y, z, w] = hand.cloud_from_palm.quaternion_xyzw;
    let position = list(&hand.cloud_from_palm.translation_m);
    line(text, 4, "position", &position);
    let orientation = format!("{{w: {}, xyz: {}}}", number(w), list(&[x, y, z]));
    line(text, 4, "orientation", &orientation);
}

fn joints(text: &mut String, key: &str, values: &BTreeMap<String, JointRecord>) {
    let _ = writeln!(text, "    {key}:");
    let driven = values.iter().filter(|(_, joint)| joint.follows.is_none());
    for (name, joint) in driven {
        line(text, 6, &quoted(name), &number(joint.value));
    }
}

/// The shortest decimal number that reads back as the same value, with a decimal point and without
/// an exponent, because readers of YAML 1.1 read `1e-7` as a string.
pub(crate) fn number(value: f64) -> String {
    // Adding 0 turns −0 into 0.
    let digits = (value + 0.0).to_string();
    if digits.contains('.') {
        digits
    } else {
        digits + ".0"
    }
}

/// A double-quoted scalar; a JSON string is also a YAML one.
pub(crate) fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
