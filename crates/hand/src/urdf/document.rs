//! The links and joints of a URDF, in the form that urdf-rs reads.
//!
//! urdf-rs requires elements that a hand does not need, such as the velocity of a limit, and
//! refuses files that other readers accept. So the text is rewritten with only what a hand needs.
//! Every entry is checked, and a wrong one is named in the error. urdf-rs reads the rewritten text.

use std::fmt::Write;

use super::UrdfError;
use crate::xml::{Element, urdf_root};

/// Reads the elements of a URDF. For a text of another kind the error names the kind.
pub(super) fn read(text: &str) -> Result<urdf_rs::Robot, UrdfError> {
    if text.starts_with("version https://git-lfs") {
        return Err(UrdfError::Foreign {
            found: "a pointer of Git LFS and not the file itself",
            advice: "fetch the file with `git lfs pull`",
        });
    }
    let root = urdf_root(text)?;
    check_root(&root)?;
    check_expanded(&root)?;
    let mut clean = Clean::default();
    clean.open(
        "robot",
        &[("name", root.attribute("name").unwrap_or_default())],
    );
    for element in root.children_named("link") {
        clean.link(element)?;
    }
    for element in root.children_named("joint") {
        clean.joint(element)?;
    }
    clean.close("robot");
    urdf_rs::read_from_string(&clean.text).map_err(|e| UrdfError::Parse(e.to_string()))
}

/// Checks by the root element that the file is a URDF.
fn check_root(root: &Element) -> Result<(), UrdfError> {
    let (found, advice) = match root.name.to_lowercase().as_str() {
        "robot" => return Ok(()),
        "mujoco" | "mujocoinclude" => (
            "a MuJoCo model (MJCF)",
            "convert it, or take the URDF that most publishers of hands offer beside it",
        ),
        "sdf" | "world" | "model" | "gazebo" => (
            "a Gazebo description (SDF)",
            "convert it, or take the URDF from which most SDF files are made",
        ),
        "html" => (
            "a web page",
            "download the file itself, as the link \"raw\" of most hosts gives it",
        ),
        "collada" => (
            "a Collada mesh (DAE)",
            "give the URDF that names it as a collision mesh",
        ),
        name if name.starts_with("xacro:") => return Err(unexpanded()),
        _ => {
            return Err(UrdfError::Root {
                found: root.name.chars().take(40).collect(),
            });
        }
    };
    Err(UrdfError::Foreign { found, advice })
}

fn unexpanded() -> UrdfError {
    UrdfError::Foreign {
        found: "a xacro file that has not been expanded",
        advice: "expand it with `xacro hand.urdf.xacro > hand.urdf` and give the result",
    }
}

/// Expanded files may still declare the xacro namespace, but they contain no element or expression
/// of it.
fn check_expanded(root: &Element) -> Result<(), UrdfError> {
    let expression = |e: &Element| {
        let mut values = e.attributes.iter().map(|(_, value)| value);
        values.any(|v| v.contains("${") || v.contains("$("))
    };
    fn any(e: &Element, test: &dyn Fn(&Element) -> bool) -> bool {
        test(e) || e.children.iter().any(|c| any(c, test))
    }
    let macros = |e: &Element| e.name.starts_with("xacro:");
    // Elements of simulators may contain such expressions too.
    let ours = |e: &&Element| ["link", "joint"].contains(&e.name.as_str());
    if root.children.iter().any(macros)
        || root
            .children
            .iter()
            .filter(ours)
            .any(|e| any(e, &|e| macros(e) || expression(e)))
    {
        return Err(unexpanded());
    }
    Ok(())
}

/// Writes the text for urdf-rs.
#[derive(Default)]
struct Clean {
    text: String,
}

impl Clean {
    fn tag(&mut self, name: &str, attributes: &[(&str, &str)], end: &str) {
        self.text.push('<');
        self.text.push_str(name);
        for (key, value) in attributes {
            self.text.push(' ');
            self.text.push_str(key);
            self.text.push_str("=\"");
            for sign in value.chars() {
                match sign {
                    '&' => self.text.push_str("&amp;"),
                    '<' => self.text.push_str("&lt;"),
                    '>' => self.text.push_str("&gt;"),
                    '"' => self.text.push_str("&quot;"),
                    sign => self.text.push(sign),
                }
            }
            self.text.push('"');
        }
        self.text.push_str(end);
    }

    fn open(&mut self, name: &str, attributes: &[(&str, &str)]) {
        self.tag(name, attributes, ">");
    }

    fn empty(&mut self, name: &str, attributes: &[(&str, &str)]) {
        self.tag(name, attributes, "/>");
    }

    fn close(&mut self, name: &str) {
        self.text.push_str("</");
        self.text.push_str(name);
        self.text.push('>');
    }

    fn link(&mut self, element: &Element) -> Result<(), UrdfError> {
        let name = named(element)?;
        self.open("link", &[("name", name)]);
        for collision in element.children_named("collision") {
            self.open("collision", &[]);
            self.origin(collision)?;
            self.open("geometry", &[]);
            self.shape(name, collision)?;
            self.close("geometry");
            self.close("collision");
        }
        self.close("link");
        Ok(())
    }

    fn shape(&mut self, link: &str, collision: &Element) -> Result<(), UrdfError> {
        let geometry = collision
            .child("geometry")
            .and_then(|g| g.children.first())
            .ok_or_else(|| UrdfError::EmptyGeometry { link: link.into() })?;
        let plain = geometry.name.rsplit(':').next().unwrap_or_default();
        // The attribute that each form must have, and its number of entries.
        let needed: &[(&'static str, usize)] = match plain {
            "box" => &[("size", 3)],
            "cylinder" | "capsule" => &[("radius", 1), ("length", 1)],
            "sphere" => &[("radius", 1)],
            "mesh" => &[],
            _ => {
                return Err(UrdfError::GeometryKind {
                    link: link.to_owned(),
                    kind: geometry.name.chars().take(40).collect(),
                });
            }
        };
        let item = || format!("a {} of link '{link}'", geometry.name);
        let mut attributes = Vec::new();
        for &(what, count) in needed {
            let found = numbers(geometry, what, count)?;
            attributes.push((what, found.ok_or_else(|| missing(item(), what))?));
        }
        if plain == "mesh" {
            let file = geometry.value("filename");
            let file = file.ok_or_else(|| missing(item(), "filename"))?;
            attributes.push(("filename", file.to_owned()));
            let scale = numbers(geometry, "scale", 3)?;
            attributes.extend(scale.map(|scale| ("scale", scale)));
        }
        self.empty(plain, &borrowed(&attributes));
        Ok(())
    }

    fn joint(&mut self, element: &Element) -> Result<(), UrdfError> {
        let name = named(element)?;
        let of_joint = |what| missing(format!("joint '{name}'"), what);
        let kind = element.attribute("type").ok_or_else(|| of_joint("type"))?;
        if !["fixed", "revolute", "continuous", "prismatic"].contains(&kind) {
            return Err(UrdfError::JointKind {
                joint: name.to_owned(),
                kind: kind.chars().take(40).collect(),
            });
        }
        self.open("joint", &[("name", name), ("type", kind)]);
        self.origin(element)?;
        for what in ["parent", "child"] {
            let link = element.child(what).and_then(|e| e.attribute("link"));
            self.empty(what, &[("link", link.ok_or_else(|| of_joint(what))?)]);
        }
        if let Some(axis) = element.child("axis") {
            let axis = numbers(axis, "xyz", 3)?.map(|xyz| ("xyz", xyz));
            self.empty("axis", &borrowed(axis.as_slice()));
        }
        self.limit(name, kind, element)?;
        if let Some(mimic) = element.child("mimic") {
            let followed = mimic.attribute("joint");
            let followed = followed.ok_or_else(|| of_joint("joint to mimic"))?;
            let mut attributes = vec![("joint", followed.to_owned())];
            for what in ["multiplier", "offset"] {
                attributes.extend(numbers(mimic, what, 1)?.map(|value| (what, value)));
            }
            self.empty("mimic", &borrowed(&attributes));
        }
        self.close("joint");
        Ok(())
    }

    /// Effort and velocity are not used. A missing bound is 0, as the format defines. A mimic joint
    /// needs no limits.
    fn limit(&mut self, joint: &str, kind: &str, element: &Element) -> Result<(), UrdfError> {
        let bounds = match element.child("limit") {
            Some(limit) => [numbers(limit, "lower", 1)?, numbers(limit, "upper", 1)?],
            None => [None, None],
        };
        let [lower, upper] = match bounds {
            [None, None] if element.child("mimic").is_some() => ["-inf", "inf"].map(str::to_owned),
            [None, None] if ["revolute", "prismatic"].contains(&kind) => {
                return Err(no_limit(joint, kind));
            }
            bounds => bounds.map(|bound| bound.unwrap_or_else(|| "0".to_owned())),
        };
        let zero = "0";
        self.empty(
            "limit",
            &[
                ("lower", &lower),
                ("upper", &upper),
                ("effort", zero),
                ("velocity", zero),
            ],
        );
        Ok(())
    }

    fn origin(&mut self, element: &Element) -> Result<(), UrdfError> {
        let Some(origin) = element.child("origin") else {
            return Ok(());
        };
        let mut attributes = Vec::new();
        for what in ["xyz", "rpy"] {
            attributes.extend(numbers(origin, what, 3)?.map(|value| (what, value)));
        }
        self.empty("origin", &borrowed(&attributes));
        Ok(())
    }
}

fn borrowed<'a>(attributes: &'a [(&'a str, String)]) -> Vec<(&'a str, &'a str)> {
    let pairs = attributes.iter();
    pairs.map(|(key, value)| (*key, value.as_str())).collect()
}

fn no_limit(joint: &str, kind: &str) -> UrdfError {
    let (unit, otherwise) = match kind {
        "prismatic" => ("metres", ""),
        _ => ("radians", ", or make its type continuous"),
    };
    UrdfError::NoLimit {
        joint: joint.to_owned(),
        kind: kind.to_owned(),
        unit,
        otherwise,
    }
}

fn named(element: &Element) -> Result<&str, UrdfError> {
    element.attribute("name").ok_or_else(|| {
        missing(
            format!("a {} at byte {}", element.name, element.byte),
            "name",
        )
    })
}

fn missing(item: String, what: &'static str) -> UrdfError {
    UrdfError::Missing { item, what }
}

/// The given count of numbers in an attribute, rewritten; `None` where the attribute is absent.
fn numbers(
    element: &Element,
    what: &'static str,
    expected: usize,
) -> Result<Option<String>, UrdfError> {
    let Some(text) = element.value(what) else {
        return Ok(None);
    };
    let mut clean = String::new();
    let mut count = 0;
    for word in text.split_whitespace() {
        let value: f64 = word.parse().map_err(|_| UrdfError::NotANumber {
            byte: element.byte,
            what,
            word: word.chars().take(40).collect(),
        })?;
        let gap = if count > 0 { " " } else { "" };
        // Writing to a string cannot fail.
        let _ = write!(clean, "{gap}{value:?}");
        count += 1;
    }
    if count != expected {
        return Err(UrdfError::Count {
            byte: element.byte,
            what,
            count,
            expected,
        });
    }
    Ok(Some(clean))
}
