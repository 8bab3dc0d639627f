//! A [`HandModel`] from a URDF text; the only user of urdf-rs.
//!
//! A hand needs the tree of links, collision geometry, axes, limits and mimics. Masses, efforts,
//! visuals and the elements of simulators are removed before urdf-rs reads the text. Every entry
//! that is read is checked; errors name it.

mod document;
mod encoding;
mod tree;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::mesh_file::{MeshFileError, mesh_vertices};
use crate::model::{Geometry, HandModel, LinkGeometry};
use crate::xml::XmlError;
pub use crate::xml::{MAX_URDF_BYTES, MAX_URDF_DEPTH, MAX_URDF_ELEMENTS};
pub use encoding::urdf_text;
pub(crate) use tree::UNLIMITED;

/// The largest number of links or of joints accepted.
pub const MAX_LINKS: usize = 512;
/// The largest number of collision pieces per link accepted.
pub const MAX_PIECES: usize = 64;
/// The largest length (origin, size of geometry) accepted, in metres.
pub const MAX_LENGTH_M: f64 = 10.0;

/// Why a URDF was refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum UrdfError {
    /// The text is not an acceptable XML document.
    #[error(transparent)]
    Xml(#[from] XmlError),
    /// There are too many of something.
    #[error("{count} {what}, more than {limit}")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many.
        count: usize,
        /// The limit.
        limit: usize,
    },
    /// An entry that is not a number.
    #[error("'{word}' in the {what} at byte {byte} is no number")]
    NotANumber {
        /// Position of its element.
        byte: usize,
        /// Its attribute.
        what: &'static str,
        /// The entry, its first 40 characters.
        word: String,
    },
    /// An attribute with a wrong number of entries.
    #[error("the {what} at byte {byte} has {count} numbers, expected {expected}")]
    Count {
        /// Position of its element.
        byte: usize,
        /// Its attribute.
        what: &'static str,
        /// Number of entries found.
        count: usize,
        /// Number of entries expected.
        expected: usize,
    },
    /// The file is not a URDF.
    #[error("this is {found}, not a URDF; {advice}")]
    Foreign {
        /// What it is.
        found: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// urdf-rs refuses what this crate has checked.
    #[error("not a URDF: {0}")]
    Parse(String),
    /// The root element is not that of a URDF.
    #[error("not a URDF: the root element is <{found}>, expected <robot>")]
    Root {
        /// Its name, the first 40 characters.
        found: String,
    },
    /// An element lacks what it must have.
    #[error("{item} has no {what}")]
    Missing {
        /// The element.
        item: String,
        /// What is missing.
        what: &'static str,
    },
    /// A collision element without geometry.
    #[error(
        "link '{link}': a <collision> has an empty <geometry>; give it a box, cylinder, capsule, sphere or mesh, or remove it"
    )]
    EmptyGeometry {
        /// The link.
        link: String,
    },
    /// Geometry of a form that is not known.
    #[error(
        "link '{link}': collision geometry <{kind}> is not known; box, cylinder, capsule, sphere and mesh are"
    )]
    GeometryKind {
        /// The link.
        link: String,
        /// Its element, the first 40 characters.
        kind: String,
    },
    /// A joint that moves has no limits.
    #[error(
        "joint '{joint}' is {kind} and has no <limit>; add <limit lower=\"…\" upper=\"…\"/> in {unit}{otherwise}"
    )]
    NoLimit {
        /// The joint.
        joint: String,
        /// Its kind.
        kind: String,
        /// The unit of its values.
        unit: &'static str,
        /// An alternative.
        otherwise: &'static str,
    },
    /// No link at all.
    #[error("the URDF has no links")]
    NoLinks,
    /// Two links of one name.
    #[error("two links are named '{0}'")]
    DuplicateLink(String),
    /// Two joints of one name.
    #[error("two joints are named '{0}'")]
    DuplicateJoint(String),
    /// A joint names a link that does not exist.
    #[error("joint '{joint}' names the link '{link}', which does not exist")]
    UnknownLink {
        /// The joint.
        joint: String,
        /// The missing link.
        link: String,
    },
    /// A link is the child of two joints.
    #[error("link '{link}' is the child of both '{first}' and '{second}'")]
    TwoParents {
        /// The link.
        link: String,
        /// One joint.
        first: String,
        /// The other joint.
        second: String,
    },
    /// The links form no single tree.
    #[error(
        "the links are not one tree: {roots} links have no parent, and link '{link}' hangs on no root or on a second one"
    )]
    NotATree {
        /// Number of links without a parent.
        roots: usize,
        /// A link that is not under the first root.
        link: String,
    },
    /// A number is not finite or too large.
    #[error("{what} of '{item}' is {value}")]
    Number {
        /// The link or joint.
        item: String,
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A moving joint has a zero axis.
    #[error("joint '{0}' has a zero axis")]
    ZeroAxis(String),
    /// A joint's limits are reversed.
    #[error("joint '{joint}' has limits {lower} .. {upper}")]
    Limits {
        /// The joint.
        joint: String,
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// A joint of a kind that hands do not have.
    #[error(
        "joint '{joint}' is {kind}; fixed, revolute, continuous and prismatic joints are known"
    )]
    JointKind {
        /// The joint.
        joint: String,
        /// Its kind.
        kind: String,
    },
    /// A mimic joint refers to a joint that it cannot follow.
    #[error("joint '{joint}' mimics '{of}', which {why}")]
    Mimic {
        /// The joint.
        joint: String,
        /// The followed joint.
        of: String,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A collision mesh could not be read.
    #[error("collision mesh '{file}' of link '{link}': {reason}")]
    Mesh {
        /// The link.
        link: String,
        /// The file name in the URDF.
        file: String,
        /// What went wrong.
        reason: String,
    },
}

/// Reads a hand whose collision geometry is made of primitives; meshes are refused by name.
///
///
/// Linear in the text.
///
/// # Errors
///
/// See [`UrdfError`].
pub fn load_urdf(text: &str) -> Result<HandModel, UrdfError> {
    load_urdf_with_meshes(text, |_| {
        Err::<Vec<u8>, _>("this loader was given no meshes".to_string())
    })
}

/// Reads a hand; `mesh_bytes` returns the content of a mesh file by its name in the URDF.
///
/// Each collision mesh (STL, OBJ, PLY or OFF, recognised by content) becomes the convex hull of its
/// vertices. The caller decides which names it resolves, and to which files.
pub fn load_urdf_with_meshes<E: std::fmt::Display>(
    text: &str,
    mesh_bytes: impl Fn(&str) -> Result<Vec<u8>, E>,
) -> Result<HandModel, UrdfError> {
    let robot = document::read(text)?;
    check_counts(&robot)?;
    let resolve = |link: &str, file: &str| {
        let bytes = mesh_bytes(file).map_err(|e| mesh_error(link, file, e.to_string()))?;
        mesh_vertices(&bytes, file)
            .map_err(|e: MeshFileError| mesh_error(link, file, e.to_string()))
    };
    let mut geometry = Vec::with_capacity(robot.links.len());
    for link in &robot.links {
        geometry.push(link_geometry(link, &resolve)?);
    }
    tree::build(&robot, geometry)
}

/// Vertices of a mesh by link and file name.
type MeshResolver<'a> = dyn Fn(&str, &str) -> Result<Vec<Point3<f64>>, UrdfError> + 'a;

fn mesh_error(link: &str, file: &str, reason: String) -> UrdfError {
    UrdfError::Mesh {
        link: link.to_string(),
        file: file.to_string(),
        reason,
    }
}

fn check_counts(robot: &urdf_rs::Robot) -> Result<(), UrdfError> {
    if robot.links.is_empty() {
        return Err(UrdfError::NoLinks);
    }
    for (what, count, limit) in [
        ("links", robot.links.len(), MAX_LINKS),
        ("joints", robot.joints.len(), MAX_LINKS),
    ] {
        if count > limit {
            return Err(UrdfError::TooMany { what, count, limit });
        }
    }
    Ok(())
}

fn link_geometry(
    link: &urdf_rs::Link,
    resolve: &MeshResolver<'_>,
) -> Result<Vec<LinkGeometry>, UrdfError> {
    if link.collision.len() > MAX_PIECES {
        return Err(UrdfError::TooMany {
            what: "collision pieces of one link",
            count: link.collision.len(),
            limit: MAX_PIECES,
        });
    }
    link.collision
        .iter()
        .map(|piece| {
            Ok(LinkGeometry {
                link_from_geometry: isometry(&link.name, &piece.origin)?,
                geometry: geometry(&link.name, &piece.geometry, resolve)?,
            })
        })
        .collect()
}

fn geometry(
    link: &str,
    piece: &urdf_rs::Geometry,
    resolve: &MeshResolver<'_>,
) -> Result<Geometry, UrdfError> {
    let half = |what, length: f64| positive(link, what, length).map(|l| l / 2.0);
    Ok(match piece {
        urdf_rs::Geometry::Box { size } => Geometry::Box {
            half_extents: Vector3::new(
                half("box size", size[0])?,
                half("box size", size[1])?,
                half("box size", size[2])?,
            ),
        },
        urdf_rs::Geometry::Cylinder { radius, length } => Geometry::Cylinder {
            radius: positive(link, "cylinder radius", *radius)?,
            half_length: half("cylinder length", *length)?,
        },
        urdf_rs::Geometry::Capsule { radius, length } => Geometry::Capsule {
            radius: positive(link, "capsule radius", *radius)?,
            half_length: half("capsule length", *length)?,
        },
        urdf_rs::Geometry::Sphere { radius } => Geometry::Sphere {
            radius: positive(link, "sphere radius", *radius)?,
        },
        urdf_rs::Geometry::Mesh {
            filename: file,
            scale,
        } => {
            let scale = vector(link, "mesh scale", &scale.map_or([1.0; 3], |s| s.0))?;
            let points: Vec<_> = resolve(link, file)?
                .iter()
                .map(|p| Point3::from(p.coords.component_mul(&scale)))
                .collect();
            crate::collision::check_hull(&points)
                .map_err(|e| mesh_error(link, file, e.to_string()))?;
            Geometry::Hull {
                file: file.clone(),
                points,
            }
        }
    })
}

fn number(item: &str, what: &'static str, value: f64) -> Result<f64, UrdfError> {
    checked(item, what, value, value.abs() <= MAX_LENGTH_M * 1e3)
}

fn positive(item: &str, what: &'static str, value: f64) -> Result<f64, UrdfError> {
    checked(item, what, value, value > 0.0 && value <= MAX_LENGTH_M)
}

fn checked(item: &str, what: &'static str, value: f64, good: bool) -> Result<f64, UrdfError> {
    if good {
        return Ok(value);
    }
    Err(UrdfError::Number {
        item: item.to_string(),
        what,
        value,
    })
}

fn vector(item: &str, what: &'static str, v: &[f64; 3]) -> Result<Vector3<f64>, UrdfError> {
    for &value in v {
        number(item, what, value)?;
    }
    Ok(Vector3::from(*v))
}

/// Pose from `xyz` and `rpy` (fixed axes: roll about x, then pitch about y, then yaw about z).
fn isometry(item: &str, origin: &urdf_rs::Pose) -> Result<Isometry3<f64>, UrdfError> {
    let xyz = vector(item, "origin xyz", &origin.xyz.0)?;
    for &value in xyz.iter() {
        checked(item, "origin xyz", value, value.abs() <= MAX_LENGTH_M)?;
    }
    let rpy = vector(item, "origin rpy", &origin.rpy.0)?;
    Ok(Isometry3::from_parts(
        Translation3::from(xyz),
        UnitQuaternion::from_euler_angles(rpy.x, rpy.y, rpy.z),
    ))
}
