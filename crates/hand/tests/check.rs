//! Findings about hands: a good one has none to worry about, spoilt ones say what is wrong.
#![allow(clippy::print_stderr)]

mod common;

use common::{paper_params, seeded};
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
    let guide = include_str!("../../../docs/bring-your-own-hand.md");
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
fn the_hand_of_the_guide_grasps_a_ball() {
    let spec = guide_spec();
    let Some(root) = std::env::var_os("MODULI_DATA") else {
        eprintln!("MODULI_DATA is unset; the Allegro hand of the guide is not tried");
        return;
    };
    let folder = std::path::Path::new(&root).join("hands/allegro");
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
