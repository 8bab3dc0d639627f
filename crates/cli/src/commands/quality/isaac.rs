//! Grasps from `isaac_grasp` files: poses and joint values become contacts on a surface.

use std::path::Path;

use grasp::{Convention, Grasp};
use hand::Hand;
use moduli::{FoundContacts, HandContacts, NoContact, Object};
use record::{IsaacFile, IsaacGrasp};

use super::GraspSet;
use crate::args::QualityOptions;
use crate::failure::Failure;
use crate::{hands, input};

/// Grasps named in a warning.
const NAMED: usize = 3;

/// The grasps of a file on the shape of the options, with the hand of the options.
pub(super) fn read_isaac(
    path: &Path,
    text: &str,
    options: &QualityOptions,
    convention: &Convention,
) -> Result<GraspSet, Failure> {
    let file = IsaacFile::from_yaml(text).map_err(|e| Failure::input(path, e))?;
    let Some(shape) = &options.shape else {
        let why = "grasps of Isaac Sim are poses and joint values without contacts; give the object with \
                   --shape SHAPE (`moduli fit` makes it) and the hand with --hand";
        return Err(Failure::input(path, why));
    };
    let object = input::object(shape)?;
    let hand = hands::load(&options.hand)?;
    let refused = |e: moduli::Error| Failure::refused(format!("{}: {e}", object.name()));
    let measure = object.measure(convention).map_err(refused)?;
    let contacts = HandContacts::new(&object, &hand).map_err(refused)?;
    let mut set = GraspSet {
        grasps: Vec::with_capacity(file.grasps.len()),
        rule: None,
        resolved: Some(measure.convention().clone()),
        tips: hand.tip_model(),
        warnings: frame_warning(&file, &hand).into_iter().collect(),
    };
    let centre = object.frame().to_cloud(&measure.centre());
    let (mut left_out, mut partial) = (Vec::new(), Vec::new());
    for grasp in &file.grasps {
        let joints = driven(path, grasp, &hand)?;
        let pose = grasp.pose.isometry().ok_or_else(|| {
            Failure::input(path, format!("{}: the orientation is zero", grasp.name))
        })?;
        let found = contacts
            .of(&pose, &joints)
            .map_err(|e| Failure::input(path, format!("{}: {e}", grasp.name)))?;
        if found.contacts.len() < 2 {
            left_out.push(described(&grasp.name, &found));
            continue;
        }
        if !found.without.is_empty() {
            partial.push(described(&grasp.name, &found));
        }
        let made = Grasp::new(found.contacts, centre);
        let failed = |e| Failure::input(path, format!("{}: {e}", grasp.name));
        set.grasps.push(made.map_err(failed)?);
    }
    if set.grasps.is_empty() && !left_out.is_empty() {
        return Err(Failure::input(path, nowhere(&left_out, &object, &hand)));
    }
    let said = [
        (left_out, "left out, because fewer than two tips touch"),
        (partial, "without a contact of every finger"),
    ];
    for (names, what) in said.into_iter().filter(|(names, _)| !names.is_empty()) {
        let some = names[..names.len().min(NAMED)].join("; ");
        set.warnings
            .push(format!("{} grasps {what}: {some}", names.len()));
    }
    Ok(set)
}

/// A warning if the poses are those of another link than the palm.
fn frame_warning(file: &IsaacFile, hand: &Hand) -> Option<String> {
    let palm = &hand.model().links()[0].name;
    let given = &file.gripper_frame_link;
    let same = given.is_empty() || given.rsplit('/').next() == Some(palm.as_str());
    (!same).then(|| {
        format!(
            "the poses are those of `{given}`; the root link of {} is `{palm}`: are the two frames the same?",
            hand.name()
        )
    })
}

/// The values of the hand's driven joints, each of which must be in the file. Joints that follow
/// others may be there too.
fn driven(path: &Path, grasp: &IsaacGrasp, hand: &Hand) -> Result<Vec<f64>, Failure> {
    let model = hand.model();
    let known = |name: &str| model.joints().iter().any(|j| j.name == name);
    if let Some(other) = grasp.joints.keys().find(|name| !known(name)) {
        let why = format!(
            "{}: the hand {} has no joint `{other}`; its driven joints are {}; --hand gives another hand",
            grasp.name,
            hand.name(),
            model.driven_names().join(", ")
        );
        return Err(Failure::input(path, why));
    }
    let value = |name: &str| {
        grasp.joints.get(name).copied().ok_or_else(|| {
            let why = format!(
                "{}: `cspace_position` has no value for the driven joint `{name}` of {}",
                grasp.name,
                hand.name()
            );
            Failure::input(path, why)
        })
    };
    model.driven_names().into_iter().map(value).collect()
}

/// "grasp_3 (finger_1 12.0 mm from the surface)".
fn described(name: &str, found: &FoundContacts) -> String {
    let finger = |(finger, why): &(String, NoContact)| match why {
        NoContact::Away(gap) => format!("{finger} {:.1} mm from the surface", 1e3 * gap),
        NoContact::Inside => format!("{finger} deep inside the object"),
        NoContact::ClosedHole => format!("{finger} where a hole of the object was closed"),
    };
    let fingers: Vec<String> = found.without.iter().map(finger).collect();
    format!("{name} ({})", fingers.join(", "))
}

fn nowhere(left_out: &[String], object: &Object, hand: &Hand) -> String {
    format!(
        "no grasp of {} has two tips within {:.0} mm of the surface of {}: {}; \
         are these its shape, its frame, metres, and the hand?",
        hand.name(),
        1e3 * HandContacts::REACH,
        object.name(),
        left_out[..left_out.len().min(NAMED)].join("; ")
    )
}
