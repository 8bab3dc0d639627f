//! What a URDF says of links and joints: exactly what a hand needs, nothing else is looked at.

use super::UrdfError;
use super::xml::{self, Element};

/// A robot in the order of its file.
pub(super) struct Robot {
    pub(super) name: String,
    pub(super) links: Vec<LinkText>,
    pub(super) joints: Vec<JointText>,
}

/// A link with its collision geometry.
pub(super) struct LinkText {
    pub(super) name: String,
    pub(super) collision: Vec<Piece>,
}

/// One piece of collision geometry.
pub(super) struct Piece {
    pub(super) origin: Origin,
    pub(super) shape: Shape,
}

/// The forms of collision geometry, sizes as the URDF gives them.
pub(super) enum Shape {
    Box { size: [f64; 3] },
    Cylinder { radius: f64, length: f64 },
    Capsule { radius: f64, length: f64 },
    Sphere { radius: f64 },
    Mesh { file: String, scale: [f64; 3] },
}

/// A pose by `xyz` and `rpy`.
#[derive(Default)]
pub(super) struct Origin {
    pub(super) xyz: [f64; 3],
    pub(super) rpy: [f64; 3],
}

/// A joint.
pub(super) struct JointText {
    pub(super) name: String,
    pub(super) kind: String,
    pub(super) parent: String,
    pub(super) child: String,
    pub(super) origin: Origin,
    pub(super) axis: [f64; 3],
    /// Lower and upper, where one of them is given.
    pub(super) limit: Option<(f64, f64)>,
    pub(super) mimic: Option<MimicText>,
}

/// The joint that a joint follows.
pub(super) struct MimicText {
    pub(super) joint: String,
    pub(super) multiplier: f64,
    pub(super) offset: f64,
}

/// Reads the elements of a URDF; text that is something else is named as what it is.
pub(super) fn read(text: &str) -> Result<Robot, UrdfError> {
    if text.starts_with("version https://git-lfs") {
        return Err(UrdfError::Foreign {
            found: "a pointer of Git LFS and not the file itself",
            advice: "fetch the file with `git lfs pull`",
        });
    }
    let root = xml::root(text)?;
    check_root(&root)?;
    check_expanded(&root)?;
    let links = root.children_named("link").map(link);
    let joints = root.children_named("joint").map(joint);
    Ok(Robot {
        name: root.attribute("name").unwrap_or_default().to_owned(),
        links: links.collect::<Result<_, _>>()?,
        joints: joints.collect::<Result<_, _>>()?,
    })
}

/// The root element tells what a file is.
fn check_root(root: &Element<'_>) -> Result<(), UrdfError> {
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

/// Expanded files may still declare the xacro namespace; they hold no element or expression of it.
fn check_expanded(root: &Element<'_>) -> Result<(), UrdfError> {
    let expression = |e: &Element<'_>| {
        let values = e.attributes.iter().map(|(_, value)| value);
        values
            .into_iter()
            .any(|v| v.contains("${") || v.contains("$("))
    };
    fn any(e: &Element<'_>, test: &dyn Fn(&Element<'_>) -> bool) -> bool {
        test(e) || e.children.iter().any(|c| any(c, test))
    }
    let macros = |e: &Element<'_>| e.name.starts_with("xacro:");
    // Elements of simulators may hold such expressions of their own.
    let ours = |e: &&Element<'_>| ["link", "joint"].contains(&e.name);
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

fn link(element: &Element<'_>) -> Result<LinkText, UrdfError> {
    let name = named(element)?;
    let pieces = element.children_named("collision");
    Ok(LinkText {
        collision: pieces
            .map(|collision| {
                Ok(Piece {
                    origin: origin(collision)?,
                    shape: shape(&name, collision)?,
                })
            })
            .collect::<Result<_, _>>()?,
        name,
    })
}

fn shape(link: &str, collision: &Element<'_>) -> Result<Shape, UrdfError> {
    let geometry = collision
        .child("geometry")
        .and_then(|g| g.children.first())
        .ok_or_else(|| UrdfError::EmptyGeometry { link: link.into() })?;
    let item = || format!("a {} of link '{link}'", geometry.name);
    let length = |what: &'static str| {
        let found = number(geometry, what)?;
        found.ok_or_else(|| missing(item(), what))
    };
    let plain = geometry.name.rsplit(':').next().unwrap_or_default();
    Ok(match plain {
        "box" => Shape::Box {
            size: vector(geometry, "size")?.ok_or_else(|| missing(item(), "size"))?,
        },
        "cylinder" => Shape::Cylinder {
            radius: length("radius")?,
            length: length("length")?,
        },
        "capsule" => Shape::Capsule {
            radius: length("radius")?,
            length: length("length")?,
        },
        "sphere" => Shape::Sphere {
            radius: length("radius")?,
        },
        "mesh" => Shape::Mesh {
            file: geometry
                .value("filename")
                .ok_or_else(|| missing(item(), "filename"))?
                .to_owned(),
            scale: vector(geometry, "scale")?.unwrap_or([1.0; 3]),
        },
        _ => {
            return Err(UrdfError::GeometryKind {
                link: link.to_owned(),
                kind: geometry.name.chars().take(40).collect(),
            });
        }
    })
}

fn joint(element: &Element<'_>) -> Result<JointText, UrdfError> {
    let name = named(element)?;
    let of_joint = |what| missing(format!("joint '{name}'"), what);
    let linked = |what: &'static str| {
        let link = element.child(what).and_then(|e| e.attribute("link"));
        link.map(str::to_owned).ok_or_else(|| of_joint(what))
    };
    let axis = element
        .child("axis")
        .map(|a| vector(a, "xyz"))
        .transpose()?;
    let limit = element.child("limit").map(limit).transpose()?;
    let mimic = element.child("mimic").map(|m| {
        let followed = m.attribute("joint");
        Ok(MimicText {
            joint: followed
                .ok_or_else(|| of_joint("joint to mimic"))?
                .to_owned(),
            multiplier: number(m, "multiplier")?.unwrap_or(1.0),
            offset: number(m, "offset")?.unwrap_or(0.0),
        })
    });
    Ok(JointText {
        kind: element
            .attribute("type")
            .ok_or_else(|| of_joint("type"))?
            .to_owned(),
        parent: linked("parent")?,
        child: linked("child")?,
        origin: origin(element)?,
        axis: axis.flatten().unwrap_or([1.0, 0.0, 0.0]),
        limit: limit.flatten(),
        mimic: mimic.transpose()?,
        name,
    })
}

/// Effort and velocity play no part; a bound that is left out is 0, as the format says.
fn limit(element: &Element<'_>) -> Result<Option<(f64, f64)>, UrdfError> {
    let (lower, upper) = (number(element, "lower")?, number(element, "upper")?);
    if lower.is_none() && upper.is_none() {
        return Ok(None);
    }
    Ok(Some((lower.unwrap_or(0.0), upper.unwrap_or(0.0))))
}

fn origin(element: &Element<'_>) -> Result<Origin, UrdfError> {
    let Some(origin) = element.child("origin") else {
        return Ok(Origin::default());
    };
    Ok(Origin {
        xyz: vector(origin, "xyz")?.unwrap_or_default(),
        rpy: vector(origin, "rpy")?.unwrap_or_default(),
    })
}

fn named(element: &Element<'_>) -> Result<String, UrdfError> {
    let name = element.attribute("name").map(str::to_owned);
    name.ok_or_else(|| {
        missing(
            format!("a {} at byte {}", element.name, element.byte),
            "name",
        )
    })
}

fn missing(item: String, what: &'static str) -> UrdfError {
    UrdfError::Missing { item, what }
}

fn number(element: &Element<'_>, what: &'static str) -> Result<Option<f64>, UrdfError> {
    let value = element.value(what).map(str::trim);
    value.map(|word| parsed(element, what, word)).transpose()
}

fn vector(element: &Element<'_>, what: &'static str) -> Result<Option<[f64; 3]>, UrdfError> {
    let Some(text) = element.value(what) else {
        return Ok(None);
    };
    let mut values = Vec::with_capacity(3);
    for word in text.split_whitespace() {
        values.push(parsed(element, what, word)?);
    }
    let count = values.len();
    let three = <[f64; 3]>::try_from(values).map_err(|_| UrdfError::NotThree {
        byte: element.byte,
        what,
        count,
    })?;
    Ok(Some(three))
}

fn parsed(element: &Element<'_>, what: &'static str, word: &str) -> Result<f64, UrdfError> {
    word.parse().map_err(|_| UrdfError::NotANumber {
        byte: element.byte,
        what,
        word: word.chars().take(40).collect(),
    })
}
