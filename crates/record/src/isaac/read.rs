//! Reading `isaac_grasp` files: those of [`super::isaac_grasps`], of Isaac Sim's Grasp Editor and of
//! other programs that write the format.

use std::collections::BTreeMap;

use super::error::IsaacError;
use super::yaml::{Node, Value, parse};
use crate::grasps::PoseRecord;

/// How far the length of a quaternion may be from 1.
const UNIT: f64 = 1e-2;

/// The grasps of an `isaac_grasp` file, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct IsaacFile {
    /// The frame of the object in the stage, in which the poses are given; empty if the file names none.
    pub object_frame_link: String,
    /// The link of the gripper whose poses are given; empty if the file names none.
    pub gripper_frame_link: String,
    /// The grasps.
    pub grasps: Vec<IsaacGrasp>,
}

/// One grasp of an `isaac_grasp` file.
#[derive(Clone, Debug, PartialEq)]
pub struct IsaacGrasp {
    /// Its key in the file.
    pub name: String,
    /// Between 0 and 1; `None` if the file gives none.
    pub confidence: Option<f64>,
    /// Pose of the gripper's frame in that of the object, metres.
    pub pose: PoseRecord,
    /// Joint values in the grasp, radians or metres, by name.
    pub joints: BTreeMap<String, f64>,
    /// Joint values before the fingers close; empty if the file gives none.
    pub pregrasp_joints: BTreeMap<String, f64>,
}

impl IsaacFile {
    /// Whether a text claims to be an `isaac_grasp` file.
    pub fn is_meant(text: &str) -> bool {
        let format = |line: &str| line.trim_start().strip_prefix("format:").map(str::to_owned);
        let found = text.lines().find_map(format);
        found.is_some_and(|value| value.contains("isaac_grasp"))
    }

    /// Reads the YAML text of a file. Keys that the format does not define are ignored.
    ///
    /// ```
    /// let text = "format: isaac_grasp
    /// format_version: 1.0
    /// grasps:
    ///   grasp_0:
    ///     position: [0.0, 0.0, 0.1]
    ///     orientation: {w: 1.0, xyz: [0.0, 0.0, 0.0]}
    ///     cspace_position: {finger_joint: 0.2}
    /// ";
    /// let file = record::IsaacFile::from_yaml(text)?;
    /// assert_eq!(file.grasps[0].joints["finger_joint"], 0.2);
    /// # Ok::<(), record::IsaacError>(())
    /// ```
    ///
    /// # Errors
    /// The text is not YAML, it has another format or version, or a grasp has no pose or a value that
    /// is not a finite number.
    pub fn from_yaml(text: &str) -> Result<Self, IsaacError> {
        let root = parse(text)?;
        let top = Place {
            node: &root,
            path: String::new(),
        };
        let word = |key: &str| top.find(key).map(|p| p.word()).transpose();
        match word("format")? {
            Some("isaac_grasp") => {}
            found => return Err(top.wrong("format", found, "`isaac_grasp`")),
        }
        match word("format_version")? {
            Some("1.0" | "1") | None => {}
            found => return Err(top.wrong("format_version", found, "1.0")),
        }
        let list = top.get("grasps")?;
        let grasps = list.pairs()?.iter().map(|(name, node)| {
            let place = list.at(name, node);
            grasp(name, &place)
        });
        Ok(Self {
            object_frame_link: word("object_frame_link")?.unwrap_or_default().to_owned(),
            gripper_frame_link: word("gripper_frame_link")?.unwrap_or_default().to_owned(),
            grasps: grasps.collect::<Result<_, _>>()?,
        })
    }
}

fn grasp(name: &str, place: &Place<'_>) -> Result<IsaacGrasp, IsaacError> {
    let orientation = place.get("orientation")?;
    let [x, y, z] = orientation.get("xyz")?.triple()?;
    let quaternion = [x, y, z, orientation.get("w")?.number()?];
    let length = quaternion.iter().map(|q| q * q).sum::<f64>().sqrt();
    if (length - 1.0).abs() > UNIT {
        let found = Some(format!("has the length {length:.3}"));
        return Err(orientation.error(found, "a unit quaternion"));
    }
    let joints = |key: &str| match place.find(key) {
        Some(list) => list
            .pairs()?
            .iter()
            .map(|(joint, node)| Ok((joint.clone(), list.at(joint, node).number()?)))
            .collect(),
        None => Ok(BTreeMap::new()),
    };
    Ok(IsaacGrasp {
        name: name.to_owned(),
        confidence: place.find("confidence").map(|p| p.number()).transpose()?,
        pose: PoseRecord {
            translation_m: place.get("position")?.triple()?,
            quaternion_xyzw: quaternion.map(|q| q / length),
        },
        joints: joints("cspace_position")?,
        pregrasp_joints: joints("pregrasp_cspace_position")?,
    })
}

/// A node with its place in the file.
struct Place<'a> {
    node: &'a Node,
    path: String,
}

impl<'a> Place<'a> {
    fn at(&self, key: &str, node: &'a Node) -> Place<'a> {
        let path = match self.path.as_str() {
            "" | "grasps" => key.to_owned(),
            parent => format!("{parent}.{key}"),
        };
        Place { node, path }
    }

    fn find(&self, key: &str) -> Option<Place<'a>> {
        let Value::Map(pairs) = &self.node.value else {
            return None;
        };
        let (_, node) = pairs.iter().find(|(name, _)| name == key)?;
        Some(self.at(key, node))
    }

    fn get(&self, key: &str) -> Result<Place<'a>, IsaacError> {
        self.find(key)
            .ok_or_else(|| self.at(key, self.node).error(None, "a value"))
    }

    fn error(&self, found: Option<String>, expected: &'static str) -> IsaacError {
        IsaacError::Key {
            line: self.node.line,
            key: self.path.clone(),
            found: found.unwrap_or_else(|| "is missing".to_owned()),
            expected,
        }
    }

    fn wrong(&self, key: &str, found: Option<&str>, expected: &'static str) -> IsaacError {
        let place = self.find(key).unwrap_or_else(|| self.at(key, self.node));
        place.error(found.map(|word| format!("is `{}`", short(word))), expected)
    }

    fn pairs(&self) -> Result<&'a [(String, Node)], IsaacError> {
        match &self.node.value {
            Value::Map(pairs) => Ok(pairs),
            other => Err(self.error(Some(kind(other)), "keys with values")),
        }
    }

    fn word(&self) -> Result<&'a str, IsaacError> {
        match &self.node.value {
            Value::Scalar(word) => Ok(word),
            other => Err(self.error(Some(kind(other)), "a word")),
        }
    }

    fn number(&self) -> Result<f64, IsaacError> {
        let number = match &self.node.value {
            Value::Scalar(word) => word.parse().ok().filter(|v: &f64| v.is_finite()),
            _ => None,
        };
        number.ok_or_else(|| self.error(Some(kind(&self.node.value)), "a finite number"))
    }

    fn triple(&self) -> Result<[f64; 3], IsaacError> {
        let wrong = |found: String| self.error(Some(found), "three numbers");
        let Value::List(items) = &self.node.value else {
            return Err(wrong(kind(&self.node.value)));
        };
        let numbers = items.iter().map(|node| {
            let path = self.path.clone();
            Place { node, path }.number()
        });
        let numbers = numbers.collect::<Result<Vec<f64>, _>>()?;
        let count = numbers.len();
        <[f64; 3]>::try_from(numbers).map_err(|_| wrong(format!("has {count} entries")))
    }
}

fn kind(value: &Value) -> String {
    match value {
        Value::Scalar(word) => format!("is `{}`", short(word)),
        Value::List(items) => format!("is a list of {}", items.len()),
        Value::Map(pairs) => format!("has {} keys", pairs.len()),
    }
}

/// The first forty characters of a word, without control characters.
fn short(word: &str) -> String {
    word.chars().filter(|c| !c.is_control()).take(40).collect()
}
