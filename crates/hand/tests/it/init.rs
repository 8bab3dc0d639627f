//! A spec that is proposed from a URDF alone is one that grasps.

use crate::common::{paper_params, seeded};
use crate::generated::{arm, five_fingers, linkage, parallel_jaws, spread_hand};
use hand::{
    Hand, HandModel, HandSpec, InitError, Proposal, SDH_URDF, Severity, check_hand, load_urdf,
    load_urdf_with_meshes, propose, synthesize,
};
use shape::{FitSettings, PointCloud, RadialShape};

fn proposed(model: &HandModel, palm: Option<&str>) -> Proposal {
    propose(model, palm, &seeded(0)).unwrap()
}

/// The hand of a proposal, and how many of 200 poses on a ball are stable.
fn on_ball(model: &HandModel, spec: &HandSpec, radius: f64) -> (Hand, usize) {
    let hand = Hand::new(model.clone(), spec).unwrap();
    for finding in check_hand(&hand, 5e-3).unwrap() {
        assert!(finding.severity == Severity::Note, "{finding}");
    }
    let ball = RadialShape::sphere(3, radius).unwrap();
    let found = synthesize(&ball, &hand, &paper_params(&hand, 200), &mut seeded(5)).unwrap();
    (hand, found.grasps.len())
}

fn closing(spec: &HandSpec, finger: usize) -> Vec<(&str, f64)> {
    let joints = spec.finger[finger].closing.iter();
    joints
        .map(|(name, share)| (name.as_str(), *share))
        .collect()
}

#[test]
fn sliding_jaws_close_towards_each_other_whatever_their_zero() {
    // The same jaws with 0 where they are closed, and where they are open.
    for (zero_is_open, mimic) in [(false, true), (true, true), (false, false), (true, false)] {
        let model = load_urdf(&parallel_jaws(zero_is_open, mimic)).unwrap();
        let Proposal { spec, .. } = proposed(&model, None);
        let sign = if zero_is_open { 1.0 } else { -1.0 };
        assert_eq!(closing(&spec, 0), [("slide_left", sign)]);
        let second = if mimic { "slide_left" } else { "slide_right" };
        assert_eq!(closing(&spec, 1), [(second, sign)]);
        let open = if zero_is_open { 0.0 } else { 0.04 };
        assert_eq!(spec.preshape[0].joints["slide_left"], open);
        assert_eq!(spec.approach_axis, [1.0, 0.0, 0.0]);
        assert!((spec.approach_point[0] - 0.1).abs() < 0.005);
        assert!(spec.approach_point[1].abs() < 1e-3);
        assert_eq!(spec.pad_radius_m, Some(0.01));
        assert_eq!(spec.least_fingers, None);
        let (_, stable) = on_ball(&model, &spec, 0.025);
        assert!(stable >= 100, "{zero_is_open} {mimic}: {stable}");
    }
}

#[test]
fn bars_of_a_linkage_are_no_fingers() {
    let model = load_urdf(&linkage()).unwrap();
    let Proposal { spec, .. } = proposed(&model, None);
    let tips: Vec<_> = spec.finger.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(tips, ["left_pad", "right_pad"]);
    assert_eq!(closing(&spec, 0), [("motor", 1.0)]);
    assert_eq!(closing(&spec, 1), [("motor", 1.0)]);
    assert_eq!(spec.approach_axis, [0.0, 0.0, 1.0]);
    let (hand, stable) = on_ball(&model, &spec, 0.02);
    assert_eq!(hand.groups().len(), 1);
    assert!(stable >= 100, "{stable}");
}

#[test]
fn three_fingers_on_spreading_knuckles_surround_a_ball() {
    for sign in [1.0, -1.0] {
        let model = load_urdf(&spread_hand(sign)).unwrap();
        let Proposal { spec, .. } = proposed(&model, None);
        assert_eq!(spec.finger.len(), 3);
        for finger in 0..3 {
            let joints = closing(&spec, finger);
            assert_eq!(joints.len(), 2, "{joints:?}");
            assert!(joints.iter().all(|(name, _)| !name.contains("knuckle")));
            assert!(joints.iter().all(|(_, share)| share * sign > 0.0));
        }
        assert_eq!(spec.approach_axis, [0.0, 0.0, 1.0]);
        let (_, stable) = on_ball(&model, &spec, 0.035);
        assert!(stable >= 100, "{stable}");
    }
}

#[test]
fn a_thumb_opposes_four_fingers() {
    let model = load_urdf(&five_fingers()).unwrap();
    let Proposal { spec, notes } = proposed(&model, None);
    assert_eq!(spec.finger.len(), 5);
    assert_eq!(spec.least_fingers, Some(3));
    assert!(notes.iter().any(|n| n.contains("least_fingers")));
    // The palm looks along x.
    assert!(spec.approach_axis[0] > 0.7, "{:?}", spec.approach_axis);
    let (_, stable) = on_ball(&model, &spec, 0.035);
    assert!(stable >= 40, "{stable}");
}

#[test]
fn an_arm_before_the_palm_is_left_out() {
    let model = load_urdf(&arm(&parallel_jaws(true, true))).unwrap();
    let Proposal { spec, notes } = proposed(&model, None);
    assert_eq!(spec.palm, "flange");
    assert!(
        notes[0].contains("'flange'") && notes[0].contains("--palm"),
        "{}",
        notes[0]
    );
    let (hand, stable) = on_ball(&model, &spec, 0.025);
    assert_eq!(hand.model().links()[0].name, "flange");
    assert_eq!(hand.model().driven_names(), ["slide_left"]);
    assert!(stable >= 100, "{stable}");
    let asked = proposed(&model, Some("base"));
    assert_eq!(asked.spec.palm, "base");
    on_ball(&model, &asked.spec, 0.025);
}

#[test]
fn what_cannot_be_a_hand_is_refused_by_name() {
    let jaws = load_urdf(&parallel_jaws(true, true)).unwrap();
    let refused = |model: &HandModel, palm| propose(model, palm, &seeded(0)).unwrap_err();
    let unknown = refused(&jaws, Some("wrist"));
    assert!(matches!(unknown, InitError::UnknownPalm { .. }));
    assert!(unknown.to_string().contains("'wrist'") && unknown.to_string().contains("left"));
    let single = refused(&jaws, Some("left"));
    assert!(
        matches!(single, InitError::TooFewFingers { found: 0, .. }),
        "{single}"
    );
    assert!(single.to_string().contains("--palm"));
    // A robot with two arms has two hands.
    let one = arm(&parallel_jaws(true, true));
    let inside = one.split_once('>').unwrap().1.trim_end_matches("</robot>");
    let side = |mark: &str| {
        let named = ["name", "link", "joint"]
            .iter()
            .fold(inside.to_owned(), |text, key| {
                text.replace(&format!(" {key}=\""), &format!(" {key}=\"{mark}_"))
            });
        format!(
            "{named}<joint name=\"{mark}\" type=\"fixed\"><parent link=\"torso\"/><child link=\"{mark}_stand\"/></joint>"
        )
    };
    let both = format!(
        "<robot name=\"two\"><link name=\"torso\"/>{}{}</robot>",
        side("left"),
        side("right")
    );
    let both = load_urdf(&both).unwrap();
    let arms = refused(&both, None);
    assert!(matches!(arms, InitError::Arms { .. }), "{arms}");
    assert!(arms.to_string().contains("--palm"));
    assert_eq!(proposed(&both, Some("right_flange")).spec.finger.len(), 2);
    let bare = r#"<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="0" upper="1"/></joint></robot>"#;
    assert_eq!(
        refused(&load_urdf(bare).unwrap(), None),
        InitError::NoGeometry
    );
}

#[test]
fn the_file_of_a_proposal_reads_back_and_is_the_same_every_time() {
    let model = load_urdf(SDH_URDF).unwrap();
    let once = proposed(&model, None);
    assert_eq!(once, proposed(&model, None));
    assert_eq!(
        HandSpec::from_toml(&once.spec.to_toml()).unwrap(),
        once.spec
    );
    let mut strange = once.spec.clone();
    strange.name = "a \"b\"\\\n".to_owned();
    strange.compliant = Some(false);
    strange.self_distance.exempt_pairs = vec![["x".to_owned(), "y\t".to_owned()]];
    assert_eq!(HandSpec::from_toml(&strange.to_toml()).unwrap(), strange);
}

/// The published hands: no finding but notes, and grasps of real objects.
#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn published_hands_grasp_unedited() {
    let hands = [
        "sdh/sdh.urdf",
        "allegro/allegro_hand_right.urdf",
        "panda/panda_gripper.urdf",
        "robotiq_2f85/2f85.urdf",
    ];
    for name in hands {
        let model = published(name);
        let Proposal { spec, .. } = proposed(&model, None);
        let hand = Hand::new(model, &spec).unwrap();
        for finding in check_hand(&hand, 5e-3).unwrap() {
            assert!(finding.severity == Severity::Note, "{name}: {finding}");
        }
        for object in ["tomato_soup_can", "mustard_bottle"] {
            let surface = fitted(object);
            let params = paper_params(&hand, 350);
            let found = synthesize(&surface, &hand, &params, &mut seeded(2)).unwrap();
            let stable = found.grasps.len();
            assert!(stable >= 30, "{name} on {object}: {stable} of 350");
        }
    }
}

fn published(name: &str) -> HandModel {
    let path = testkit::scans().join("hands").join(name);
    let folder = path.parent().unwrap().to_owned();
    let text = std::fs::read_to_string(&path).unwrap();
    let mesh = |file: &str| std::fs::read(folder.join(file.trim_start_matches("package://")));
    load_urdf_with_meshes(&text, mesh).unwrap()
}

fn fitted(object: &str) -> RadialShape {
    let bytes = testkit::scan_bytes(&format!("objects/{object}.ply"));
    let cloud = PointCloud::new(shape::io::read_ply(&bytes).unwrap().points).unwrap();
    let settings = FitSettings {
        degree: 30,
        lambda: None,
    };
    shape::fit::fit(&cloud, &settings).unwrap().shape
}
