//! Grasps as an `isaac_grasp` YAML file, version 1.0: what Isaac Sim's Grasp Editor writes and its
//! `import_grasps_from_file` reads.
//!
//! One file is for one object and one gripper: only grasps that a hand takes are written.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::grasps::{GraspsFile, HandRecord};

/// The YAML text: by rank, every grasp that has a hand, as `grasp_0`, `grasp_1`, …
///
/// `position` (metres) and `orientation` (quaternion) are the pose of the palm in the frame of the
/// cloud, which is the frame of the object; `cspace_position` are the driven joints in the grasp,
/// `pregrasp_cspace_position` before the fingers close. `confidence` must be in [0, 1] there: it is
/// the quality, cut at 1.
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
        joints(&mut text, "cspace_position", &hand.joints_rad);
        if !hand.pregrasp_joints_rad.is_empty() {
            let before = &hand.pregrasp_joints_rad;
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
    let [x, y, z, w] = hand.object_from_palm.quaternion_xyzw;
    let position = list(&hand.object_from_palm.translation_m);
    line(text, 4, "position", &position);
    let orientation = format!("{{w: {}, xyz: {}}}", number(w), list(&[x, y, z]));
    line(text, 4, "orientation", &orientation);
}

fn joints(text: &mut String, key: &str, values: &BTreeMap<String, f64>) {
    let _ = writeln!(text, "    {key}:");
    for (name, value) in values {
        line(text, 6, &quoted(name), &number(*value));
    }
}

/// The shortest digits that come back as the same number, with a point and without an exponent:
/// readers of YAML 1.1 take `1e-7` for a word.
fn number(value: f64) -> String {
    // Adding 0 leaves no negative zero.
    let digits = (value + 0.0).to_string();
    if digits.contains('.') {
        digits
    } else {
        digits + ".0"
    }
}

/// A double-quoted scalar: JSON strings are that in YAML too.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grasps::{GraspRecord, PoseRecord, SourceRecord};

    fn grasp(quality: f64, with_hand: bool) -> GraspRecord {
        let hand = HandRecord {
            name: "two".to_owned(),
            palm_link: "palm".to_owned(),
            object_from_palm: PoseRecord {
                translation_m: [0.1, -0.0, 1e-9],
                quaternion_xyzw: [0.0, 0.6, 0.0, 0.8],
            },
            joints_rad: BTreeMap::from([("joint_0.0".to_owned(), 1.0)]),
            pregrasp_joints_rad: BTreeMap::from([("a \"b\": c".to_owned(), -0.25)]),
            contact_error_m: 0.0,
        };
        GraspRecord {
            rank: 1,
            quality,
            contacts_m: Vec::new(),
            inward_normals: Vec::new(),
            source: SourceRecord {
                kind: "synthesis".to_owned(),
                from: None,
                shape_distance_m: None,
                source_quality: None,
            },
            hand: with_hand.then_some(hand),
        }
    }

    #[test]
    fn only_grasps_with_a_hand_are_written() {
        let mut file = crate::grasps::tests::file();
        assert!(isaac_grasps(&file).ends_with("gripper_frame_link: \"\"\n\ngrasps: {}\n"));
        file.grasps = vec![grasp(0.5, false), grasp(1.5, true)];
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
}
