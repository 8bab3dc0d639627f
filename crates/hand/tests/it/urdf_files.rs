//! URDFs as people have them: attributes that nobody needs left out, other formats under the name,
//! units mistaken.

use hand::{
    Finding, Hand, HandModel, HandSpec, Severity, UrdfError, check_hand, load_urdf,
    load_urdf_with_meshes, urdf_text,
};

/// A palm and two fingers; each finger with these texts in its joint and its link.
fn urdf(kind: &str, joint: &str, link: &str, geometry: &str) -> String {
    let finger = |name: &str, y: f64| {
        format!(
            r#"<link name="{name}"><collision><origin xyz="0 0 0.04"/><geometry>{geometry}</geometry></collision>{link}</link>
<joint name="j{name}" type="{kind}"><parent link="palm"/><child link="{name}"/><origin xyz="0 {y} 0"/><axis xyz="{} 0 0"/>{joint}</joint>"#,
            y.signum()
        )
    };
    format!(
        r#"<robot name="g"><link name="palm"><collision><geometry><box size="0.04 0.2 0.02"/></geometry></collision></link>{}{}</robot>"#,
        finger("a", 0.05),
        finger("b", -0.05)
    )
}

const BOX: &str = r#"<box size="0.01 0.01 0.06"/>"#;
const GOOD: &str = r#"<limit lower="-0.6" upper="1.2" effort="5" velocity="1"/>"#;

fn limits(text: &str) -> (f64, f64) {
    load_urdf(text).unwrap().joints()[0].limits
}

fn found(model: HandModel) -> Vec<Finding> {
    let spec = r#"
name = "g"
palm = "palm"
approach_axis = [0, 0, 1]
standoff_m = [0.05, 0.06]
[[finger]]
name = "a"
tips = ["a"]
closing = { ja = 1 }
[[finger]]
name = "b"
tips = ["b"]
closing = { jb = 1 }
[[preshape]]
name = "open"
joints = {}
"#;
    let hand = Hand::new(model, &HandSpec::from_toml(spec).unwrap()).unwrap();
    check_hand(&hand, 5e-3).unwrap()
}

fn warned(findings: &[Finding], words: &[&str]) {
    let hit = |f: &&Finding| f.severity == Severity::Warning && f.text.contains(words[0]);
    let warning = findings.iter().find(hit);
    let text = &warning
        .unwrap_or_else(|| panic!("{words:?} not in {findings:?}"))
        .text;
    for word in words {
        assert!(text.contains(word), "{text} lacks {word}");
    }
}

#[test]
fn what_a_hand_does_not_need_may_be_missing() {
    let plain = load_urdf(&urdf("revolute", GOOD, "", BOX)).unwrap();
    let bare = r#"<limit lower="-0.6" upper="1.2"/>"#;
    let without_velocity = r#"<limit lower="-0.6" upper="1.2" effort="5"/>"#;
    let mass = r#"<inertial><mass value="0.1"/></inertial><visual><geometry/></visual>"#;
    let simulated = r#"<gazebo reference="palm"><p:q x="$(arg a)"/></gazebo>"#;
    for text in [
        urdf("revolute", bare, "", BOX),
        urdf("revolute", without_velocity, "", BOX),
        urdf("revolute", GOOD, mass, BOX),
        urdf(
            "revolute",
            &format!("{GOOD}<safety_controller/>"),
            mass,
            BOX,
        ),
        urdf("revolute", GOOD, "", BOX).replace("</robot>", &format!("{simulated}</robot>")),
    ] {
        assert_eq!(load_urdf(&text).unwrap(), plain);
    }
}

#[test]
fn bounds_that_mean_none_are_none() {
    let turn = std::f64::consts::TAU;
    for bound in ["1e16", "inf", "1e308", "+Infinity"] {
        let both = format!(
            r#"<limit lower="-{}" upper="{bound}"/>"#,
            bound.trim_start_matches('+')
        );
        assert_eq!(limits(&urdf("revolute", &both, "", BOX)), (-turn, turn));
        let above = format!(r#"<limit lower="0" upper="{bound}"/>"#);
        assert_eq!(limits(&urdf("prismatic", &above, "", BOX)), (0.0, 1.0));
        let model = load_urdf(&urdf("revolute", &both, "", BOX)).unwrap();
        warned(
            &found(model),
            &["joint 'ja' closes a finger but has no limits"],
        );
    }
    assert_eq!(limits(&urdf("continuous", "", "", BOX)), (-turn, turn));
}

#[test]
fn moving_joints_need_limits() {
    let empty = r#"<limit effort="5" velocity="1"/>"#;
    for (kind, joint, unit) in [
        ("revolute", "", "radians"),
        ("revolute", empty, "radians"),
        ("prismatic", "", "metres"),
    ] {
        let error = load_urdf(&urdf(kind, joint, "", BOX)).unwrap_err();
        let said = error.to_string();
        assert!(matches!(error, UrdfError::NoLimit { .. }), "{said}");
        assert!(
            said.contains(&format!("joint 'ja' is {kind} and has no <limit>"))
                && said.contains(unit)
        );
    }
    // A joint that follows another has the limits of that one.
    let text = urdf("revolute", GOOD, "", BOX);
    let (first, second) = text.split_once(r#"<joint name="jb""#).unwrap();
    let follows = second.replace(GOOD, r#"<mimic joint="ja" multiplier="-1"/>"#);
    let model = load_urdf(&format!(r#"{first}<joint name="jb"{follows}"#)).unwrap();
    assert_eq!(model.driven_names(), ["ja"]);
}

#[test]
fn other_files_are_named_as_what_they_are() {
    let property = urdf("revolute", GOOD, "", r#"<sphere radius="${r}"/>"#);
    let called = urdf("revolute", GOOD, "", BOX).replace("</robot>", "<xacro:finger/></robot>");
    for (text, words) in [
        ("<mujoco model='h'><worldbody/></mujoco>", "MJCF"),
        ("<?xml version='1.0'?><mujocoinclude/>", "MJCF"),
        ("<sdf version='1.6'><model name='h'/></sdf>", "SDF"),
        ("<html><body></body></html>", "web page"),
        ("<COLLADA><asset/></COLLADA>", "Collada"),
        (
            "version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
            "git lfs pull",
        ),
        (&property, "xacro file"),
        (&called, "xacro file"),
        ("<xacro:macro name='h'/>", "xacro file"),
        ("<urdf/>", "the root element is <urdf>, expected <robot>"),
    ] {
        let said = load_urdf(text).unwrap_err().to_string();
        assert!(said.contains(words), "{said} lacks {words}");
    }
    // An expanded file may still declare the name space.
    let expanded = urdf("revolute", GOOD, "", BOX).replace("<robot", "<robot xmlns:xacro='x'");
    assert!(load_urdf(&expanded).is_ok());
}

#[test]
fn geometry_that_is_none_is_named_with_its_link() {
    for (geometry, words) in [
        ("", "link 'a': a <collision> has an empty <geometry>"),
        (
            "<plane/>",
            "link 'a': collision geometry <plane> is not known",
        ),
        (
            "<cylinder radius='1'/>",
            "a cylinder of link 'a' has no length",
        ),
        ("<box size='1 1'/>", "has 2 numbers, expected 3"),
    ] {
        let said = load_urdf(&urdf("revolute", GOOD, "", geometry)).unwrap_err();
        assert!(said.to_string().contains(words), "{said} lacks {words}");
    }
}

#[test]
fn bytes_of_old_encodings_are_read() {
    let text = urdf("revolute", GOOD, "<!-- Größe -->", BOX);
    let model = load_urdf(&text).unwrap();
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    assert!(std::str::from_utf8(&latin).is_err());
    let wide = |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
        let units = std::iter::once(0xfeff).chain(text.encode_utf16());
        units.flat_map(bytes).collect()
    };
    for bytes in [
        latin,
        wide(u16::to_le_bytes),
        wide(u16::to_be_bytes),
        [b"\xef\xbb\xbf".as_slice(), text.as_bytes()].concat(),
    ] {
        assert_eq!(load_urdf(&urdf_text(&bytes)).unwrap(), model);
    }
}

#[test]
fn limits_in_other_units_are_findings() {
    let degrees = r#"<limit lower="-35" upper="70"/>"#;
    let model = load_urdf(&urdf("revolute", degrees, "", BOX)).unwrap();
    warned(&found(model), &["joint 'ja'", "degrees", "-0.611 .. 1.222"]);
    let millimetres = r#"<limit lower="0" upper="40"/>"#;
    let model = load_urdf(&urdf("prismatic", millimetres, "", BOX)).unwrap();
    warned(&found(model), &["joint 'ja'", "millimetres", "0 .. 0.04"]);
    let turn = r#"<limit lower="-6.2832" upper="6.2832"/>"#;
    let model = load_urdf(&urdf("revolute", turn, "", BOX)).unwrap();
    assert!(found(model).iter().all(|f| !f.text.contains("degrees")));
}

#[test]
fn meshes_in_other_units_are_findings_that_name_them() {
    let cube = |half: f64| -> Vec<u8> {
        let corner = |k: usize| {
            let side = |bit: usize| if k >> bit & 1 == 0 { -half } else { half };
            format!("v {} {} {}\n", side(0), side(1), 3.0 * side(2))
        };
        (0..8).map(corner).collect::<String>().into_bytes()
    };
    let text = urdf("revolute", GOOD, "", r#"<mesh filename="m/finger.obj"/>"#);
    let read = |half: f64| {
        let model = load_urdf_with_meshes(&text, |_| Ok::<_, String>(cube(half))).unwrap();
        found(model)
    };
    warned(
        &read(10.0),
        &[
            "link 'a': the mesh 'm/finger.obj' is 60.00 m long",
            "millimetres",
            "0.001 0.001 0.001",
        ],
    );
    warned(
        &read(0.5),
        &["is 3.00 m long", "centimetres", "0.01 0.01 0.01"],
    );
    warned(&read(1e-5), &["is 0.0600 mm long", "no scale"]);
    assert!(read(0.01).iter().all(|f| !f.text.contains("long:")));
}
