//! Findings about a user's hand.

mod units;

use std::collections::BTreeSet;
use std::fmt;

use nalgebra::{Isometry3, Point3, Vector3};
use shape::TriangleMesh;

use crate::collision::all_close_pairs;
use crate::hand::{Finger, Hand, Preshape, TIP_EXCESS};
use crate::hand_spec::exempt_pairs_text;
use crate::kinematics::KinematicsError;
use crate::model::Geometry;

/// A joint that closes less than this is at its limit, radians or metres.
const LEAST_MOTION: f64 = 1e-4;
/// Stations of the closing motion at which tips are checked.
const CLOSING_STATIONS: usize = 8;

/// The severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// A note.
    Note,
    /// Probably a mistake.
    Warning,
    /// No grasp will be found.
    Error,
}

/// A finding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// Its severity.
    pub severity: Severity,
    /// A sentence with names and numbers.
    pub text: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.severity {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        write!(f, "{kind}: {}", self.text)
    }
}

/// Looks for faults that keep a loaded hand from grasping, the most severe first.
///
/// `self_clearance` (metres) is the least distance between parts. Faults in the names and numbers
/// of URDF and spec are errors of [`Hand::new`].
pub fn check_hand(hand: &Hand, self_clearance: f64) -> Result<Vec<Finding>, KinematicsError> {
    let mut findings = Vec::new();
    let mut near = BTreeSet::new();
    for preshape in hand.preshapes() {
        let poses = hand.model().root_from_links(&preshape.joints)?;
        near.extend(near_parts(
            hand,
            preshape,
            &poses,
            self_clearance,
            &mut findings,
        ));
        idle_fingers(hand, preshape, &mut findings);
        for finger in hand.fingers().iter().filter(|f| closes(hand, preshape, f)) {
            closing_motion(hand, preshape, finger, &mut findings)?;
        }
        reach(hand, preshape, &poses, &mut findings);
    }
    pairs_to_exempt(hand, &near, &mut findings);
    geometry(hand, &mut findings);
    units::limits(hand, &mut findings);
    units::meshes(hand, &mut findings);
    findings.sort_by_key(|f| std::cmp::Reverse(f.severity));
    Ok(findings)
}

fn add(findings: &mut Vec<Finding>, severity: Severity, text: String) {
    findings.push(Finding { severity, text });
}

fn near_parts(
    hand: &Hand,
    preshape: &Preshape,
    poses: &[Isometry3<f64>],
    least: f64,
    findings: &mut Vec<Finding>,
) -> Vec<(usize, usize)> {
    let links = hand.model().links();
    let close = all_close_pairs(hand, poses, least);
    for &(a, b, gap) in &close {
        let text = format!(
            "pre-shape '{}': '{}' and '{}' are {:.1} mm apart, less than {:.1} mm; exempt the pair or open the pre-shape",
            preshape.name,
            links[a].name,
            links[b].name,
            gap * 1e3,
            least * 1e3
        );
        let moving = |l: usize| hand.fingers().iter().any(|f| f.moving_links.contains(&l));
        let severity = if moving(a) || moving(b) {
            Severity::Warning
        } else {
            Severity::Error
        };
        add(findings, severity, text);
    }
    close.into_iter().map(|(a, b, _)| (a, b)).collect()
}

/// The lines for the spec that exempt pairs of links.
fn pairs_to_exempt(hand: &Hand, near: &BTreeSet<(usize, usize)>, findings: &mut Vec<Finding>) {
    if near.is_empty() {
        return;
    }
    let name = |l: usize| hand.model().links()[l].name.clone();
    let pairs: Vec<[String; 2]> = near.iter().map(|&(a, b)| [name(a), name(b)]).collect();
    let text = format!(
        "if these parts lie side by side by construction, add them under [self_distance]:\n{}",
        exempt_pairs_text(&pairs).trim_end()
    );
    add(findings, Severity::Note, text);
}

/// Whether a closing joint of a finger can move from a pre-shape.
fn closes(hand: &Hand, preshape: &Preshape, finger: &Finger) -> bool {
    finger.closing.iter().any(|&(driven, ratio)| {
        let (lower, upper) = hand.model.joints[hand.model.driven[driven]].limits;
        let start = preshape.joints[driven];
        let end = (start + 0.3 * ratio).clamp(lower, upper);
        (end - start).abs() > LEAST_MOTION
    })
}

/// Fingers that cannot close touch nothing; without enough others there is no grasp.
fn idle_fingers(hand: &Hand, preshape: &Preshape, findings: &mut Vec<Finding>) {
    let able = |f: &&Finger| closes(hand, preshape, f);
    let working = hand.fingers().iter().filter(able).count();
    let (severity, rest) = if working < hand.least_fingers() {
        let needed = hand.least_fingers();
        let rest = format!("{working} of the {needed} fingers that a grasp needs are left");
        (Severity::Error, rest)
    } else {
        (Severity::Warning, "the others are enough".to_owned())
    };
    for finger in hand.fingers().iter().filter(|f| !able(f)) {
        let text = format!(
            "pre-shape '{}', finger '{}': every closing joint is at its limit, the finger cannot close; {rest}",
            preshape.name, finger.name
        );
        add(findings, severity, text);
    }
}

/// Middle of a finger's tip links in the palm frame.
fn tip_middle(hand: &Hand, finger: &Finger, poses: &[Isometry3<f64>]) -> Point3<f64> {
    let sum: Vector3<f64> = finger
        .tip_links
        .iter()
        .map(|&l| (poses[l] * hand.shapes[l].centre).coords)
        .sum();
    Point3::from(sum / finger.tip_links.len() as f64)
}

/// Distance of a point of the palm frame from the line of approach, and its height along it.
fn from_approach(hand: &Hand, p: &Point3<f64>) -> (f64, f64) {
    let offset = p - hand.approach_point();
    let height = offset.dot(&hand.approach_axis());
    (
        (offset - hand.approach_axis().into_inner() * height).norm(),
        height,
    )
}

fn closing_motion(
    hand: &Hand,
    preshape: &Preshape,
    finger: &Finger,
    findings: &mut Vec<Finding>,
) -> Result<(), KinematicsError> {
    let model = hand.model();
    let place = format!("pre-shape '{}', finger '{}'", preshape.name, finger.name);
    let before = tip_middle(hand, finger, &model.root_from_links(&preshape.joints)?);
    let far = from_approach(hand, &before).0;
    let mut near = f64::INFINITY;
    for station in 1..=CLOSING_STATIONS {
        let share = station as f64 / CLOSING_STATIONS as f64;
        let poses = model.root_from_links(&hand.closed(&preshape.joints, share))?;
        near = near.min(from_approach(hand, &tip_middle(hand, finger, &poses)).0);
    }
    if near > far + 1e-3 {
        let text = format!(
            "{place}: closing moves the tip away from the line of approach ({:.0} to {:.0} mm); the sign of a ratio may be wrong",
            far * 1e3,
            near * 1e3
        );
        add(findings, Severity::Warning, text);
    }
    Ok(())
}

fn reach(hand: &Hand, preshape: &Preshape, poses: &[Isometry3<f64>], findings: &mut Vec<Finding>) {
    let top = hand
        .fingers()
        .iter()
        .flat_map(|f| &f.tip_links)
        .map(|&l| {
            let shape = &hand.shapes[l];
            from_approach(hand, &(poses[l] * shape.centre)).1 + shape.radius
        })
        .fold(f64::NEG_INFINITY, f64::max);
    if hand.standoff().0 > top {
        let text = format!(
            "pre-shape '{}': the tips reach {:.0} mm along the approach, but the least stand-off is {:.0} mm; they end before the surface",
            preshape.name,
            top * 1e3,
            hand.standoff().0 * 1e3
        );
        add(findings, Severity::Warning, text);
    }
}

fn geometry(hand: &Hand, findings: &mut Vec<Finding>) {
    for (link, shape) in hand.model().links().iter().zip(&hand.shapes) {
        let hull = |g: &&crate::model::LinkGeometry| matches!(g.geometry, Geometry::Hull { .. });
        let hulls = link.geometry.iter().filter(hull).count();
        if hulls > 0 {
            let text = format!(
                "link '{}': {hulls} mesh(es) stand in by their convex hulls, which fill every hollow",
                link.name
            );
            add(findings, Severity::Note, text);
        }
        let index = hand.model().link_index(&link.name);
        let is_tip = |l: usize| hand.fingers().iter().any(|f| f.tip_links.contains(&l));
        let excess = shape.pieces.iter().map(|p| p.excess()).fold(0.0, f64::max);
        if index.is_some_and(is_tip) && excess > TIP_EXCESS {
            let text = format!(
                "tip '{}': the hull that stands in for its mesh may be {:.1} mm larger than the mesh, so the real tip stops that far from the object; give it a mesh of fewer vertices, or boxes and cylinders",
                link.name,
                1e3 * excess
            );
            add(findings, Severity::Warning, text);
        }
        let carries = hand
            .model()
            .joints()
            .iter()
            .any(|j| hand.model().links()[j.parent].name == link.name);
        if shape.is_empty() && carries && link.parent_joint.is_some() {
            let text = format!(
                "link '{}' carries others but has no collision geometry; nothing keeps it clear",
                link.name
            );
            add(findings, Severity::Note, text);
        }
    }
}

/// The collision geometry of the hand at given joint values, one mesh per link with geometry, in
/// the palm frame, for display.
pub fn hand_meshes(
    hand: &Hand,
    joints: &[f64],
) -> Result<Vec<(usize, TriangleMesh)>, KinematicsError> {
    let poses = hand.model().root_from_links(joints)?;
    let solid = hand.shapes.iter().zip(&poses).enumerate();
    Ok(solid
        .filter(|(_, (shape, _))| !shape.is_empty())
        .map(|(link, (shape, pose))| (link, shape.mesh(pose)))
        .collect())
}
