//! Numbers of a hand that look like another unit.

use nalgebra::{Point3, Vector3};

use super::{Finding, Severity, add};
use crate::hand::{Finger, Hand};
use crate::model::{Drive, Geometry, Joint, JointKind};
use crate::urdf::UNLIMITED;

/// Usual upper bound on the range of sliding joints, metres.
const LONGEST_SLIDE: f64 = 0.3;
/// Usual upper bound on the length of parts, metres.
const LONGEST_PART: f64 = 0.8;
/// A shorter mesh was probably scaled twice, metres.
const SHORTEST_PART: f64 = 5e-4;
/// Tolerance for a rounded full turn in files, radians.
const ROUNDING: f64 = 1e-2;

/// Joint limits that look like degrees or millimetres, and closing joints without limits.
pub(super) fn limits(hand: &Hand, findings: &mut Vec<Finding>) {
    for joint in hand.model().joints() {
        let Drive::Driven(driven) = joint.drive else {
            continue;
        };
        let of_finger = |f: &Finger| f.closing.iter().any(|(d, _)| *d == driven);
        if is_unlimited(joint) {
            if hand.fingers().iter().any(of_finger) {
                add(findings, Severity::Warning, unlimited(joint));
            }
        } else if let Some(text) = other_unit(joint) {
            add(findings, Severity::Warning, text);
        }
    }
}

fn is_unlimited(joint: &Joint) -> bool {
    let (lower, upper) = joint.limits;
    UNLIMITED.contains(&(joint.kind, upper)) && lower == -upper
}

fn unlimited(joint: &Joint) -> String {
    let far = match joint.kind {
        JointKind::Prismatic => "one metre",
        _ => "one full turn",
    };
    format!(
        "joint '{}' closes a finger but has no limits (it is continuous, or its bounds are beyond 1000); it is taken to go {far} each way, so write its true <limit lower=\"…\" upper=\"…\"/>",
        joint.name
    )
}

fn other_unit(joint: &Joint) -> Option<String> {
    let (lower, upper) = joint.limits;
    let farthest = lower.abs().max(upper.abs());
    let name = &joint.name;
    match joint.kind {
        JointKind::Revolute if farthest > std::f64::consts::TAU + ROUNDING => Some(format!(
            "joint '{name}' has limits {lower} .. {upper}, more than one full turn: are they degrees? A URDF has radians, {:.3} .. {:.3}",
            lower.to_radians(),
            upper.to_radians()
        )),
        JointKind::Prismatic if farthest > LONGEST_SLIDE => Some(format!(
            "joint '{name}' slides within {lower} .. {upper} m: are these millimetres? A URDF has metres, {} .. {}",
            1e-3 * lower,
            1e-3 * upper
        )),
        _ => None,
    }
}

/// Meshes whose size is unusual for parts of hands, with the scale that corrects it.
pub(super) fn meshes(hand: &Hand, findings: &mut Vec<Finding>) {
    for link in hand.model().links() {
        for piece in &link.geometry {
            let Geometry::Hull { file, points } = &piece.geometry else {
                continue;
            };
            let length = extent(points).max();
            let named = format!("link '{}': the mesh '{file}'", link.name);
            if length > LONGEST_PART {
                let (unit, scale) = likely_scale(length);
                let text = format!(
                    "{named} is {length:.2} m long: it is probably in {unit}; write scale=\"{scale} {scale} {scale}\" in its <mesh>"
                );
                add(findings, Severity::Warning, text);
            } else if length < SHORTEST_PART {
                let text = format!(
                    "{named} is {:.4} mm long: is it in metres already? Its <mesh> may need no scale",
                    1e3 * length
                );
                add(findings, Severity::Warning, text);
            }
        }
    }
}

fn extent(points: &[Point3<f64>]) -> Vector3<f64> {
    let mut least = Vector3::repeat(f64::INFINITY);
    let mut greatest = Vector3::repeat(f64::NEG_INFINITY);
    for p in points {
        least = least.inf(&p.coords);
        greatest = greatest.sup(&p.coords);
    }
    greatest - least
}

/// Parts of hands are between one and thirty centimetres long.
fn likely_scale(length: f64) -> (&'static str, f64) {
    if length < 4.0 {
        ("centimetres or inches", 0.01)
    } else {
        ("millimetres", 0.001)
    }
}
