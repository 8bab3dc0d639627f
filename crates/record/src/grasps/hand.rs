//! A hand at a grasp.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// A hand at a grasp.
///
/// In JSON the joints are stored twice. `joints` {name: {value, unit}} states the unit of each
/// value. `joints_rad` {name: value} is the older key; it holds metres for prismatic joints, and
/// the driven joints alone. The same holds for `pregrasp_joints` and `pregrasp_joints_rad`. A file
/// with only the older keys can be read; its joints then have no unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Keys", into = "Keys")]
pub struct HandRecord {
    /// Name of the hand.
    pub name: String,
    /// The root link of the URDF, whose frame is the palm frame; empty in older files.
    pub palm_link: String,
    /// Pose of the palm in the frame of the cloud; the key is `object_from_palm`.
    pub cloud_from_palm: PoseRecord,
    /// The joints in the grasp, by name: the driven ones and those that follow them (mimic joints).
    pub joints: BTreeMap<String, JointRecord>,
    /// The same joints before the fingers closed; empty in older files.
    pub pregrasp_joints: BTreeMap<String, JointRecord>,
    /// Largest distance from a contact of this hand to the grasp's own contact, metres; 0 if the
    /// grasp's contacts are those of the hand.
    pub contact_error_m: f64,
    /// The keys of version 2.
    pub execution: ExecutionRecord,
}

/// What a robot needs besides the pose and the joints (version 2).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ExecutionRecord {
    /// Joint values at which the tips touch the surface.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub grasp_joints: BTreeMap<String, JointRecord>,
    /// Commanded joint values beyond contact, so that the fingers press.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub squeeze_joints: BTreeMap<String, JointRecord>,
    /// Efforts of the driven joints while pressing: N m, or N for prismatic joints.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub squeeze_effort: BTreeMap<String, f64>,
    /// Unit vector along which the palm approaches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approach_direction: Option<[f64; 3]>,
    /// Smallest distance of a link from the support plane, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clearance_to_support_m: Option<f64>,
}

/// The value of a joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointRecord {
    /// The value in its unit.
    pub value: f64,
    /// The unit; `null` for a joint of an older file, which does not state whether it is prismatic.
    pub unit: Option<JointUnit>,
    /// The driven joint that this one follows (a mimic joint of the URDF); absent for a driven
    /// joint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub follows: Option<String>,
}

/// Unit of a joint's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum JointUnit {
    /// Radians, for a revolute joint.
    #[serde(rename = "rad")]
    Radians,
    /// Metres, for a prismatic joint.
    #[serde(rename = "m")]
    Metres,
}

/// A rigid transform.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseRecord {
    /// Translation, metres.
    pub translation_m: [f64; 3],
    /// Rotation as a unit quaternion, x y z w.
    pub quaternion_xyzw: [f64; 4],
}

impl From<&Isometry3<f64>> for PoseRecord {
    fn from(pose: &Isometry3<f64>) -> Self {
        Self {
            translation_m: pose.translation.vector.into(),
            quaternion_xyzw: pose.rotation.coords.into(),
        }
    }
}

impl PoseRecord {
    /// The transform; `None` if the quaternion has length zero.
    pub fn isometry(&self) -> Option<Isometry3<f64>> {
        let [x, y, z, w] = self.quaternion_xyzw;
        let turn = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9)?;
        let shift = Translation3::from(Vector3::from(self.translation_m));
        Some(Isometry3::from_parts(shift, turn))
    }
}

/// The keys of the file.
#[derive(Clone, Serialize, Deserialize)]
struct Keys {
    name: String,
    #[serde(default)]
    palm_link: String,
    object_from_palm: PoseRecord,
    #[serde(default)]
    joints_rad: BTreeMap<String, f64>,
    #[serde(default)]
    pregrasp_joints_rad: BTreeMap<String, f64>,
    #[serde(default)]
    joints: BTreeMap<String, JointRecord>,
    #[serde(default)]
    pregrasp_joints: BTreeMap<String, JointRecord>,
    #[serde(default)]
    contact_error_m: f64,
    #[serde(flatten)]
    execution: ExecutionRecord,
}

/// Joints with their units if the file has them, else those of the older key.
fn with_units(
    joints: BTreeMap<String, JointRecord>,
    older: BTreeMap<String, f64>,
) -> BTreeMap<String, JointRecord> {
    if !joints.is_empty() {
        return joints;
    }
    let bare = |(name, value)| {
        let joint = JointRecord {
            value,
            unit: None,
            follows: None,
        };
        (name, joint)
    };
    older.into_iter().map(bare).collect()
}

fn values(joints: &BTreeMap<String, JointRecord>) -> BTreeMap<String, f64> {
    let value = |(name, joint): (&String, &JointRecord)| (name.clone(), joint.value);
    let driven = joints.iter().filter(|(_, joint)| joint.follows.is_none());
    driven.map(value).collect()
}

impl From<Keys> for HandRecord {
    fn from(keys: Keys) -> Self {
        Self {
            name: keys.name,
            palm_link: keys.palm_link,
            cloud_from_palm: keys.object_from_palm,
            joints: with_units(keys.joints, keys.joints_rad),
            pregrasp_joints: with_units(keys.pregrasp_joints, keys.pregrasp_joints_rad),
            contact_error_m: keys.contact_error_m,
            execution: keys.execution,
        }
    }
}

impl From<HandRecord> for Keys {
    fn from(hand: HandRecord) -> Self {
        Self {
            joints_rad: values(&hand.joints),
            pregrasp_joints_rad: values(&hand.pregrasp_joints),
            name: hand.name,
            palm_link: hand.palm_link,
            object_from_palm: hand.cloud_from_palm,
            joints: hand.joints,
            pregrasp_joints: hand.pregrasp_joints,
            contact_error_m: hand.contact_error_m,
            execution: hand.execution,
        }
    }
}
