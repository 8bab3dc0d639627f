//! The short specs that ship grasp a ball with the joints of the published hands.

use std::fmt::Write;

use crate::common::{paper_params, seeded};
use hand::{
    Hand, HandModel, HandSpec, Severity, check_hand, load_urdf, load_urdf_with_meshes, propose,
    synthesize,
};
use shape::RadialShape;

const SKELETONS: [(&str, &str); 4] = [
    ("barrett", include_str!("../skeletons/barrett.txt")),
    ("leap", include_str!("../skeletons/leap.txt")),
    ("robotiq_3f", include_str!("../skeletons/robotiq_3f.txt")),
    ("shadow", include_str!("../skeletons/shadow.txt")),
];

/// The URDF of a table of links and joints.
fn urdf(table: &str) -> String {
    let mut text = "<robot name=\"skeleton\">".to_owned();
    for line in table.lines().filter(|l| !l.starts_with('#')) {
        let cells: Vec<&str> = line.split_whitespace().collect();
        let three = |from: usize| cells[from..from + 3].join(" ");
        match cells[..] {
            ["link", name] => write!(text, "<link name=\"{name}\"/>"),
            ["link", name, ..] => write!(
                text,
                "<link name=\"{name}\"><collision><origin xyz=\"{}\" rpy=\"{}\"/><geometry><box size=\"{}\"/></geometry></collision></link>",
                three(2),
                three(8),
                three(5)
            ),
            ["joint", name, kind, parent, child, ..] => write!(
                text,
                "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/><origin xyz=\"{}\" rpy=\"{}\"/><axis xyz=\"{}\"/><limit lower=\"{}\" upper=\"{}\"/></joint>",
                three(5),
                three(8),
                three(11),
                cells[14],
                cells[15]
            ),
            _ => panic!("{line}"),
        }
        .unwrap();
    }
    text + "</robot>"
}

fn skeleton(name: &str) -> HandModel {
    let (_, table) = SKELETONS.iter().find(|(n, _)| *n == name).unwrap();
    load_urdf(&urdf(table)).unwrap()
}

/// Stable grasps of a ball of 7 cm among 120 poses.
fn stable(hand: &Hand) -> usize {
    for finding in check_hand(hand, 5e-3).unwrap() {
        assert!(finding.severity < Severity::Error, "{finding}");
    }
    let ball = RadialShape::sphere(3, 0.035).unwrap();
    let found = synthesize(&ball, hand, &paper_params(hand, 120), &mut seeded(5)).unwrap();
    assert!(found.grasps.iter().all(|g| g.contacts.len() >= 3));
    found.grasps.len()
}

#[test]
fn shipped_specs_fit_the_published_joints() {
    let names = fixtures::HAND_SPECS.map(|(name, _)| name);
    assert_eq!(
        names,
        ["allegro", "barrett", "leap", "robotiq_3f", "shadow"]
    );
    for (name, text) in fixtures::HAND_SPECS {
        let spec = HandSpec::from_toml(text).unwrap();
        assert_eq!(spec.name, name);
        if name == "allegro" {
            continue;
        }
        let hand = Hand::new(skeleton(name), &spec).unwrap();
        let stable = stable(&hand);
        assert!(stable >= 40, "{name}: {stable}");
    }
}

/// The hands are of kinds that no rule of `propose` was written for.
#[test]
fn hands_that_were_not_seen_are_proposed() {
    for (name, fingers) in [
        ("barrett", 3),
        ("leap", 4),
        ("robotiq_3f", 3),
        ("shadow", 5),
    ] {
        let model = skeleton(name);
        let spec = propose(&model, None, &seeded(0)).unwrap().spec;
        assert_eq!(spec.finger.len(), fingers, "{name}");
        let hand = Hand::new(model, &spec).unwrap();
        let stable = stable(&hand);
        assert!(stable >= 40, "{name}: {stable}");
    }
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn the_shipped_spec_of_allegro_fits_the_published_urdf() {
    let folder = testkit::scans().join("hands/allegro");
    let text = std::fs::read_to_string(folder.join("allegro_hand_right.urdf")).unwrap();
    let model = load_urdf_with_meshes(&text, |f| std::fs::read(folder.join(f))).unwrap();
    let (_, spec) = fixtures::HAND_SPECS[0];
    let hand = Hand::new(model, &HandSpec::from_toml(spec).unwrap()).unwrap();
    let stable = stable(&hand);
    assert!(stable >= 40, "{stable}");
}
