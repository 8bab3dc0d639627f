//! Findings about hands: a good one has none to worry about, spoilt ones say what is wrong.

use crate::common::{paper_params, seeded};
use hand::{
    Hand, HandSpec, SDH_SPEC, SDH_URDF, Severity, check_hand, hand_meshes, load_urdf,
    load_urdf_with_meshes, schunk_sdh, synthesize,
};
use shape::RadialShape;

fn spoilt(from: &str, to: &str) -> Vec<hand::Finding> {
    assert!(SDH_SPEC.contains(from));
    let spec = HandSpec::from_toml(&SDH_SPEC.replace(from, to)).unwrap();
    let hand = Hand::new(load_urdf(SDH_URDF).unwrap(), &spec).unwrap();
    check_hand(&hand, 5e-3).unwrap()
}

#[test]
fn the_built_in_hand_has_no_findings() {
    let findings = check_hand(&schunk_sdh().unwrap(), 5e-3).unwrap();
    assert_eq!(findings, []);
}

#[test]
fn spoilt_specs_say_what_is_wrong() {
    let near = spoilt("exempt_within_joints = 2", "exempt_within_joints = 1");
    assert!(
        near[0].text.contains("'sdh_palm_link' and 'sdh_") && near[0].text.contains("mm apart")
    );
    let away = spoilt(
        "sdh_thumb_2_joint = 1.0, sdh_thumb_3_joint = 0.75",
        "sdh_thumb_2_joint = -1.0",
    );
    assert_eq!(away[0].severity, Severity::Warning);
    assert!(
        away[0].to_string().contains("moves the tip away"),
        "{}",
        away[0]
    );
    let stuck = spoilt(
        "sdh_thumb_2_joint = -1.0471975511965976",
        "sdh_thumb_2_joint = 1.570796",
    );
    assert!(stuck.iter().all(|f| f.severity <= Severity::Warning));
    let far = spoilt("standoff_m = [0.15, 0.19]", "standoff_m = [0.4, 0.5]");
    assert!(far[0].text.contains("they end before the surface"));
}

#[test]
fn all_problems_of_a_spec_are_named_at_once() {
    let model = load_urdf(SDH_URDF).unwrap();
    let good = HandSpec::from_toml(SDH_SPEC).unwrap();
    assert_eq!(Hand::problems(&model, &good), []);
    let mut bad = good.clone();
    bad.palm = "wrist".to_owned();
    bad.approach_axis = [0.0; 3];
    bad.standoff_m = [0.2, 0.1];
    bad.finger[0].tips = vec!["claw".to_owned(), "hook".to_owned()];
    bad.finger[1].closing.insert("cable".to_owned(), 0.0);
    bad.preshape[0].joints.insert("lever".to_owned(), 0.0);
    bad.preshape[1]
        .joints
        .insert("sdh_knuckle_joint".to_owned(), 9.0);
    let named: Vec<String> = Hand::problems(&model, &bad)
        .iter()
        .map(ToString::to_string)
        .collect();
    let expected = [
        "'wrist'",
        "approach_axis",
        "standoff_m",
        "'claw'",
        "'hook'",
        "'cable'",
        "closing ratio",
        "'lever'",
        "'sdh_knuckle_joint' = 9",
    ];
    assert_eq!(named.len(), expected.len(), "{named:?}");
    for (said, word) in named.iter().zip(expected) {
        assert!(said.contains(word), "{word} is not in {said}");
    }
}

/// Whatever one thing is spoilt: no problem means that there is a hand, and the other way round.
#[test]
fn problems_are_what_keeps_a_hand_from_being_made() {
    let spoilers: [fn(&mut HandSpec); 9] = [
        |_| (),
        |s| s.finger.truncate(1),
        |s| s.preshape.clear(),
        |s| s.finger[1].name = s.finger[0].name.clone(),
        |s| s.preshape[1].name = s.preshape[0].name.clone(),
        |s| s.finger[0].closing = s.finger[1].closing.clone(),
        |s| s.finger[0].tips.clear(),
        |s| s.approach_point[1] = f64::NAN,
        |s| {
            s.self_distance.exempt_pairs = vec![["sdh_palm_link".to_owned(), "moon".to_owned()]];
        },
    ];
    let model = load_urdf(SDH_URDF).unwrap();
    for (index, spoil) in spoilers.iter().enumerate() {
        let mut spec = HandSpec::from_toml(SDH_SPEC).unwrap();
        spoil(&mut spec);
        let problems = Hand::problems(&model, &spec);
        let made = Hand::new(model.clone(), &spec).is_ok();
        assert_eq!(problems.is_empty(), made, "{index}: {problems:?}");
        assert_eq!(made, index == 0);
    }
}

#[test]
fn pictures_show_every_link_where_it_is() {
    let hand = schunk_sdh().unwrap();
    let joints = &hand.preshapes()[0].joints;
    let meshes = hand_meshes(&hand, joints).unwrap();
    assert_eq!(meshes.len(), 10);
    let poses = hand.model().root_from_links(joints).unwrap();
    for (link, mesh) in meshes {
        assert!(mesh.volume() > 0.0);
        let origin = poses[link].translation.vector;
        let near = |v: &nalgebra::Point3<f64>| (v.coords - origin).norm() <= 0.13;
        assert!(mesh.vertices.iter().all(near));
    }
}

/// The TOML block of the guide, so that the guide cannot go stale.
fn guide_spec() -> HandSpec {
    let guide = include_str!("../../../../docs/bring-your-own-hand.md");
    let block = guide
        .split("```toml")
        .nth(1)
        .unwrap()
        .split("```")
        .next()
        .unwrap();
    HandSpec::from_toml(block).unwrap()
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn the_hand_of_the_guide_grasps_a_ball() {
    let spec = guide_spec();
    let folder = testkit::scans().join("hands/allegro");
    let text = std::fs::read_to_string(folder.join("allegro_hand_right.urdf")).unwrap();
    let model = load_urdf_with_meshes(&text, |f| std::fs::read(folder.join(f))).unwrap();
    let hand = Hand::new(model, &spec).unwrap();
    let findings = check_hand(&hand, 5e-3).unwrap();
    assert!(
        findings.iter().all(|f| f.severity == Severity::Note),
        "{findings:?}"
    );
    let surface = RadialShape::sphere(3, 0.035).unwrap();
    let run = synthesize(&surface, &hand, &paper_params(&hand, 200), &mut seeded(5)).unwrap();
    assert!(run.grasps.len() >= 10, "{:?}", run.outcomes.by_reason());
    assert_eq!(run.grasps[0].contacts.len(), hand.fingers().len());
}

#[test]
fn near_pairs_are_printed_as_lines_of_the_spec() {
    let near = spoilt("exempt_within_joints = 2", "exempt_within_joints = 1");
    let note = near.last().unwrap();
    assert_eq!(note.severity, Severity::Note);
    let lines = note.text.split_once("exempt_pairs = [").unwrap().1;
    let pairs: Vec<&str> = lines.lines().filter(|l| l.contains("\", \"")).collect();
    assert!(!pairs.is_empty());
    // Pasted, they leave nothing to complain of.
    let pasted = format!("exempt_within_joints = 1\nexempt_pairs = [{lines}\n#");
    let from = "exempt_within_joints = 2\nexempt_pairs = []";
    assert_eq!(spoilt(from, &pasted), []);
}

#[test]
fn idle_fingers_are_an_error_only_where_too_few_are_left() {
    let idle = |least: &str| {
        let spec = SDH_SPEC
            .replace(
                "closing = { sdh_thumb_2_joint = 1.0, sdh_thumb_3_joint = 0.75 }",
                "closing = { sdh_thumb_2_joint = 1.0 }",
            )
            .replace(
                "sdh_thumb_2_joint = -1.0471975511965976",
                "sdh_thumb_2_joint = 1.570796",
            );
        let spec = HandSpec::from_toml(&format!("{least}\n{spec}")).unwrap();
        let hand = Hand::new(load_urdf(SDH_URDF).unwrap(), &spec).unwrap();
        let found = check_hand(&hand, 5e-3).unwrap();
        let about = found.iter().find(|f| f.text.contains("cannot close"));
        about.unwrap().clone()
    };
    let all = idle("");
    assert_eq!(all.severity, Severity::Error);
    assert!(all.text.contains("2 of the 3 fingers"), "{all}");
    let two = idle("least_fingers = 2");
    assert_eq!(two.severity, Severity::Warning);
    assert!(two.text.contains("the others are enough"), "{two}");
}
