//! URDFs and specs that are broken on purpose are refused by name, quickly and without a panic.

use hand::{
    Hand, HandSpec, SDH_SPEC, SDH_URDF, UrdfError, XmlError, load_urdf, load_urdf_with_meshes,
};

fn joint(name: &str, kind: &str, parent: &str, child: &str, more: &str) -> String {
    format!(
        r#"<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{more}</joint>"#
    )
}

fn robot(body: &str) -> String {
    format!(r#"<robot name="r">{body}</robot>"#)
}

fn links(names: &[&str]) -> String {
    names
        .iter()
        .map(|n| format!(r#"<link name="{n}"/>"#))
        .collect()
}

const LIMIT: &str = r#"<limit lower="0" upper="1" effort="1" velocity="1"/>"#;

#[test]
fn broken_trees_are_refused_by_name() {
    let two = links(&["a", "b"]);
    let ab = joint("j", "fixed", "a", "b", "");
    let cases = [
        (String::new(), "no links"),
        (links(&["a", "a"]), "two links are named 'a'"),
        (format!("{two}{ab}{ab}"), "child of both"),
        (
            format!(
                "{}{ab}{}",
                links(&["a", "b", "c"]),
                joint("j", "fixed", "a", "c", "")
            ),
            "two joints are named 'j'",
        ),
        (
            format!("{two}{}", joint("j", "fixed", "a", "ghost", "")),
            "'ghost', which does not exist",
        ),
        (two.clone(), "not one tree"),
        (
            format!(
                "{two}{}{}",
                joint("j", "fixed", "a", "b", ""),
                joint("k", "fixed", "b", "a", "")
            ),
            "not one tree",
        ),
        (
            format!("{two}{}", joint("j", "fixed", "a", "a", "")),
            "not one tree",
        ),
        (
            format!("{two}{}", joint("j", "floating", "a", "b", "")),
            "'j' is floating",
        ),
    ];
    for (body, expected) in cases {
        let said = load_urdf(&robot(&body)).unwrap_err().to_string();
        assert!(said.contains(expected), "{said} lacks {expected}");
    }
}

#[test]
fn broken_numbers_are_refused_by_name() {
    let moving = |more: &str| {
        robot(&format!(
            "{}{}",
            links(&["a", "b"]),
            joint("j", "revolute", "a", "b", more)
        ))
    };
    let piece = |geometry: &str| {
        robot(&format!(
            r#"<link name="a"><collision><geometry>{geometry}</geometry></collision></link>"#
        ))
    };
    let cases = [
        (
            moving(r#"<axis xyz="0 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/>"#),
            "zero axis",
        ),
        (
            moving(r#"<axis xyz="0 0 nan"/><limit lower="0" upper="1" effort="1" velocity="1"/>"#),
            "axis of 'j' is NaN",
        ),
        (
            moving(r#"<limit lower="2" upper="1" effort="1" velocity="1"/>"#),
            "limits 2 .. 1",
        ),
        (
            moving(r#"<limit lower="nan" upper="1" effort="1" velocity="1"/>"#),
            "lower limit of 'j' is NaN",
        ),
        (
            moving(&format!(r#"{LIMIT}<origin xyz="inf 0 0"/>"#)),
            "origin xyz of 'j' is inf",
        ),
        (
            moving(&format!(r#"{LIMIT}<origin xyz="1e9 0 0"/>"#)),
            "origin xyz of 'j' is 1000000000",
        ),
        (
            moving(&format!(r#"{LIMIT}<mimic joint="ghost"/>"#)),
            "'ghost', which does not exist",
        ),
        (
            moving(&format!(r#"{LIMIT}<mimic joint="j"/>"#)),
            "leads back to itself",
        ),
        (
            moving(&format!(r#"{LIMIT}<mimic joint="j" multiplier="nan"/>"#)),
            "mimic multiplier of 'j' is NaN",
        ),
        (
            piece(r#"<cylinder radius="0.1" length="nan"/>"#),
            "cylinder length of 'a' is NaN",
        ),
        (piece(r#"<box size="1 -1 1"/>"#), "box size of 'a' is -1"),
        (
            piece(r#"<sphere radius="0"/>"#),
            "sphere radius of 'a' is 0",
        ),
        (
            piece(r#"<mesh filename="x.stl"/>"#),
            "collision mesh 'x.stl' of link 'a'",
        ),
    ];
    for (text, expected) in cases {
        let said = load_urdf(&text).unwrap_err().to_string();
        assert!(said.contains(expected), "{said} lacks {expected}");
    }
}

#[test]
fn vectors_with_words_among_the_numbers_are_refused() {
    let piece = |origin: &str, geometry: &str| {
        robot(&format!(
            r#"<link name="a"><collision>{origin}<geometry>{geometry}</geometry></collision></link>"#
        ))
    };
    let ball = r#"<sphere radius="0.1"/>"#;
    let cases = [
        (piece(r#"<origin xyz="1 x 2 3"/>"#, ball), "'x' in the xyz"),
        (piece("<origin rpy='0 0 0 ,'/>", ball), "',' in the rpy"),
        (
            piece("<origin xyz = '1 1,5 2 3'/>", ball),
            "'1,5' in the xyz",
        ),
        (
            piece("<origin><xyz>1 2 y 3</xyz></origin>", ball),
            "'y' in the xyz",
        ),
        (piece("", "<box size='1 1 m 1'/>"), "'m' in the size"),
        (
            piece("", "<mesh filename='a=\"b' scale='1 1 1 mm'/>"),
            "'mm' in the scale",
        ),
    ];
    for (text, expected) in cases {
        let said = load_urdf(&text).unwrap_err().to_string();
        assert!(said.contains(expected), "{said} lacks {expected}");
    }
    let good = piece("<origin rpy='0 0 0' xyz=\"1e-3\n 2 -.5\"/>", ball);
    assert!(load_urdf(&good).is_ok());
}

#[test]
fn huge_meshes_are_refused_by_name_before_they_are_worked_on() {
    let text = robot(
        r#"<link name="a"><collision><geometry><mesh filename="m.stl"/></geometry></collision></link>"#,
    );
    let refused = |bytes: Vec<u8>| {
        let result = load_urdf_with_meshes(&text, |_| Ok::<_, String>(bytes.clone()));
        result.unwrap_err().to_string()
    };
    let mut claimed = vec![0u8; 84];
    claimed[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let said = refused(claimed);
    assert!(said.contains("'m.stl' of link 'a'") && said.contains("4294967295 facets"));
    let said = refused(vec![0u8; (64 << 20) + 1]);
    assert!(said.contains("'m.stl' of link 'a'") && said.contains("67108865 bytes"));
    // Within the limit of bytes, but with more vertices than a hull is made of.
    let mut many = vec![0u8; 84 + 50 * 700_000];
    many[80..84].copy_from_slice(&700_000u32.to_le_bytes());
    // Distinct corners: equal ones count once.
    for (k, corner) in many[84..]
        .chunks_exact_mut(50)
        .flat_map(|facet| facet[12..48].chunks_exact_mut(12))
        .enumerate()
    {
        corner[..4].copy_from_slice(&(k as f32).to_le_bytes());
    }
    let said = refused(many);
    assert!(said.contains("2100000 vertices"), "{said}");
}

#[test]
fn bombs_are_refused_before_they_are_parsed() {
    let nested = format!("{}{}", "<a>".repeat(200_000), "</a>".repeat(200_000));
    assert!(matches!(
        load_urdf(&nested),
        Err(UrdfError::Xml(XmlError::TooDeep { .. }))
    ));
    let bomb =
        r#"<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><robot name="&b;"/>"#;
    assert!(matches!(
        load_urdf(bomb),
        Err(UrdfError::Xml(XmlError::Doctype { .. }))
    ));
    let long = " ".repeat(5 << 20);
    assert!(matches!(
        load_urdf(&long),
        Err(UrdfError::Xml(XmlError::TooLarge { .. }))
    ));
    let many = robot(&"<link name='a'/>".repeat(60_000));
    assert!(matches!(
        load_urdf(&many),
        Err(UrdfError::Xml(XmlError::TooMany { .. }))
    ));
    let many = robot(&"<link name='a'/>".repeat(600));
    assert!(matches!(load_urdf(&many), Err(UrdfError::TooMany { .. })));
    for text in [
        "",
        "<",
        "<robot",
        "robot",
        "<robot name='x'>",
        "<x/>",
        "\u{0}",
        "<robot></robots>",
    ] {
        assert!(load_urdf(text).is_err(), "{text:?}");
    }
}

#[test]
fn meshes_come_only_from_the_caller_and_must_be_meshes() {
    let text = robot(
        r#"<link name="a"><collision><geometry><mesh filename="package://p/../../secret.stl"/></geometry></collision></link>"#,
    );
    let refused = load_urdf_with_meshes(&text, |file| {
        assert_eq!(file, "package://p/../../secret.stl");
        Err::<Vec<u8>, _>("outside the folder")
    });
    assert!(
        refused
            .unwrap_err()
            .to_string()
            .contains("outside the folder")
    );
    let flat = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n".to_vec();
    for bytes in [
        flat,
        b"nonsense".to_vec(),
        b"v 0 0 nan\n".to_vec(),
        Vec::new(),
    ] {
        let result = load_urdf_with_meshes(&text, |_| Ok::<_, String>(bytes.clone()));
        assert!(matches!(result, Err(UrdfError::Mesh { .. })));
    }
}

#[test]
fn specs_that_do_not_fit_are_refused_by_name() {
    let model = load_urdf(SDH_URDF).unwrap();
    let cases = [
        (
            "palm = \"sdh_palm_link\"",
            "palm = \"sdh_tip_link\"",
            "root link of the URDF is 'sdh_palm_link'",
        ),
        (
            "tips = [\"sdh_thumb_3_link\"]",
            "tips = [\"thumb\"]",
            "the link 'thumb', which does not exist",
        ),
        (
            "tips = [\"sdh_thumb_3_link\"]",
            "tips = []",
            "at least 1 tips",
        ),
        (
            "tips = [\"sdh_thumb_3_link\"]",
            "tips = [\"sdh_finger_13_link\"]",
            "no closing joint moves the tip link",
        ),
        (
            "tips = [\"sdh_thumb_3_link\"]",
            "tips = [\"sdh_tip_link\"]",
            "has no collision geometry",
        ),
        (
            "sdh_thumb_2_joint = 1.0",
            "sdh_finger_21_joint = 1.0",
            "no driven joint",
        ),
        (
            "sdh_thumb_2_joint = 1.0",
            "sdh_thumb_2_joint = nan",
            "closing ratio",
        ),
        (
            "sdh_thumb_2_joint = 1.0",
            "sdh_knuckle_joint = 1.0",
            "both move the link",
        ),
        (
            "sdh_knuckle_joint = 1.0471975511965976",
            "sdh_knuckle_joint = -0.1",
            "outside 0 ..",
        ),
        (
            "name = \"spread\"",
            "name = \"parallel\"",
            "two pre-shapes are named 'parallel'",
        ),
        (
            "approach_axis = [0.0, 0.0, 1.0]",
            "approach_axis = [0.0, 0.0, 0.0]",
            "approach_axis: 0 is not a direction",
        ),
        (
            "name = \"finger_2\"",
            "name = \"finger_1\"",
            "two fingers are named 'finger_1'",
        ),
    ];
    for (from, to, expected) in cases {
        assert!(SDH_SPEC.contains(from), "{from}");
        let spec = HandSpec::from_toml(&SDH_SPEC.replacen(from, to, 1)).unwrap();
        let said = Hand::new(model.clone(), &spec).unwrap_err().to_string();
        assert!(said.contains(expected), "{said} lacks {expected}");
    }
    let misspelt = SDH_SPEC.replace("standoff_m", "standof_m");
    assert!(HandSpec::from_toml(&misspelt).is_err());
}
