//! Forward kinematics against poses computed by another program and against known points.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use hand::{HandModel, load_urdf, load_urdf_with_meshes, schunk_sdh};
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};

fn data(part: &str) -> PathBuf {
    testkit::scans().join("hands").join(part)
}

struct Configuration {
    joints: BTreeMap<String, f64>,
    links: Vec<(String, Isometry3<f64>)>,
}

fn read_reference(path: &Path) -> BTreeMap<String, Configuration> {
    let mut all = BTreeMap::new();
    let text = std::fs::read_to_string(path).unwrap();
    for line in text.lines().filter(|l| !l.starts_with('#')).skip(1) {
        let fields: Vec<&str> = line.split('\t').collect();
        let values: Vec<f64> = fields[3].split(' ').map(|v| v.parse().unwrap()).collect();
        let entry = all.entry(fields[0].to_string());
        let configuration = entry.or_insert_with(|| Configuration {
            joints: BTreeMap::new(),
            links: Vec::new(),
        });
        if fields[1] == "joint" {
            configuration
                .joints
                .insert(fields[2].to_string(), values[0]);
        } else {
            let q = Quaternion::new(values[6], values[3], values[4], values[5]);
            let pose = Isometry3::from_parts(
                Translation3::new(values[0], values[1], values[2]),
                UnitQuaternion::from_quaternion(q),
            );
            configuration.links.push((fields[2].to_string(), pose));
        }
    }
    all
}

fn compare(model: &HandModel, reference: &Path) {
    let configurations = read_reference(reference);
    assert_eq!(configurations.len(), 4);
    for (name, configuration) in configurations {
        let joints: Vec<f64> = model
            .driven_names()
            .iter()
            .map(|j| configuration.joints[*j])
            .collect();
        let poses = model.root_from_links(&joints).unwrap();
        assert!(configuration.links.len() >= 12);
        for (link, expected) in configuration.links {
            let pose = poses[model.link_index(&link).unwrap()];
            let moved = (pose.translation.vector - expected.translation.vector).norm();
            let turned = pose.rotation.angle_to(&expected.rotation);
            assert!(moved <= 1e-6, "{name} {link}: {moved} m");
            assert!(turned <= 1e-6, "{name} {link}: {turned} rad");
        }
    }
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn built_in_hand_agrees_with_the_reference() {
    compare(schunk_sdh().unwrap().model(), &data("sdh/fk_reference.tsv"));
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn original_urdfs_with_meshes_agree_with_their_references() {
    for (urdf, reference) in [
        ("sdh/sdh.urdf", "sdh/fk_reference.tsv"),
        (
            "allegro/allegro_hand_right.urdf",
            "allegro/fk_reference.tsv",
        ),
    ] {
        let (urdf, reference) = (data(urdf), data(reference));
        let folder = urdf.parent().unwrap();
        let text = std::fs::read_to_string(&urdf).unwrap();
        let model = load_urdf_with_meshes(&text, |f| std::fs::read(folder.join(f))).unwrap();
        compare(&model, &reference);
        let refused = load_urdf(&text).unwrap_err().to_string();
        assert!(refused.contains("collision mesh"), "{refused}");
    }
}

#[test]
fn finger_apexes_are_where_the_joint_angles_say() {
    let hand = schunk_sdh().unwrap();
    let model = hand.model();
    // Knuckle, proximal, distal in degrees; apexes of finger 1, finger 2 and thumb.
    let table = [
        (
            [0.0, 0.0, 0.0],
            [
                [0.0191, 0.0330, 0.2460],
                [0.0191, -0.0330, 0.2460],
                [-0.0381, 0.0, 0.2460],
            ],
        ),
        (
            [0.0, -40.0, 0.0],
            [
                [0.1187, 0.0330, 0.2097],
                [0.1187, -0.0330, 0.2097],
                [-0.1377, 0.0, 0.2097],
            ],
        ),
        (
            [0.0, -30.0, 30.0],
            [
                [0.0623, 0.0330, 0.2344],
                [0.0623, -0.0330, 0.2344],
                [-0.0814, 0.0, 0.2344],
            ],
        ),
        (
            [60.0, -30.0, 30.0],
            [
                [0.0407, 0.0705, 0.2344],
                [0.0407, -0.0705, 0.2344],
                [-0.0814, 0.0, 0.2344],
            ],
        ),
        (
            [60.0, 15.0, 15.0],
            [
                [-0.0093, -0.0160, 0.2339],
                [-0.0093, 0.0160, 0.2339],
                [0.0185, 0.0, 0.2339],
            ],
        ),
    ];
    for ([knuckle, proximal, distal], apexes) in table {
        let joints: Vec<f64> = model
            .driven_names()
            .iter()
            .map(|name| match *name {
                "sdh_knuckle_joint" => f64::to_radians(knuckle),
                n if n.contains("2_joint") => f64::to_radians(proximal),
                _ => f64::to_radians(distal),
            })
            .collect();
        let poses = model.root_from_links(&joints).unwrap();
        let links = [
            "sdh_finger_13_link",
            "sdh_finger_23_link",
            "sdh_thumb_3_link",
        ];
        for (link, expected) in links.iter().zip(apexes) {
            let pose = poses[model.link_index(link).unwrap()];
            let apex = pose * Point3::new(0.0, 0.0, 0.0685);
            let error = (apex - Point3::from(expected)).amax();
            assert!(
                error <= 6e-5,
                "{link}: {apex} for {knuckle} {proximal} {distal}"
            );
        }
    }
}

#[test]
fn mimic_chains_and_sliding_joints_move_as_written() {
    let text = r#"<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
      <joint name="j1" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 0 2"/>
        <limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
      <joint name="j2" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="j1" multiplier="-2" offset="0.01"/></joint>
      <joint name="j3" type="revolute"><parent link="c"/><child link="d"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="j2" multiplier="3" offset="0.5"/></joint></robot>"#;
    let model = load_urdf(text).unwrap();
    assert_eq!(model.driven_names(), ["j1"]);
    let poses = model.root_from_links(&[0.04]).unwrap();
    let d = poses[model.link_index("d").unwrap()];
    // j2 = -2·0.04 + 0.01 = -0.07, j3 = 3·(-0.07) + 0.5 = 0.29.
    assert!((d.translation.vector - nalgebra::Vector3::new(-0.07, 0.0, 0.04)).norm() <= 1e-15);
    let expected = UnitQuaternion::from_euler_angles(0.0, 0.0, 0.29);
    assert!(d.rotation.angle_to(&expected) <= 1e-12);
    assert!(model.root_from_links(&[]).is_err());
    assert!(model.root_from_links(&[f64::NAN]).is_err());
}
