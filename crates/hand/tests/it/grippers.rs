//! Two fingers: one motor, joints that follow, a palm that gives way, soft contacts, antipodal poses.

use crate::common::{
    egg, link_distance, lump, object_from_links, paper_params, parry_mesh, seeded,
};
use grasp::{Convention, GraspModel, Workspace, epsilon};
use hand::{
    ClosingRules, CollisionObject, Drive, Hand, HandSpec, JointKind, Rejection, TipModel,
    close_hand, load_urdf, synthesize,
};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use shape::{RadialShape, Surface};

fn panda() -> Hand {
    Hand::built_in("panda").unwrap().unwrap()
}

/// The panda's files with this changed in its spec.
fn changed(from: &str, to: &str) -> Result<Hand, hand::HandError> {
    assert!(fixtures::PANDA_SPEC.contains(from), "{from}");
    let spec = HandSpec::from_toml(&fixtures::PANDA_SPEC.replacen(from, to, 1)).unwrap();
    Hand::new(load_urdf(fixtures::PANDA_URDF).unwrap(), &spec)
}

/// Above the object, pointing down, the middle of the jaws aside of the object's centre.
fn above(hand: &Hand, aside: f64) -> Isometry3<f64> {
    let jaws = &hand.jaws(0).unwrap()[0];
    let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    let place = Vector3::new(0.0, aside, 0.0) - down * jaws.middle.coords;
    Isometry3::from_parts(Translation3::from(place), down)
}

#[test]
fn the_grippers_are_what_their_data_sheets_say() {
    for (name, opening, driven, moving) in [("panda", 0.08, 1, 2), ("robotiq_2f85", 0.085, 1, 6)] {
        let hand = Hand::built_in(name).unwrap().unwrap();
        let model = hand.model();
        assert_eq!((hand.name(), model.driven_count()), (name, driven));
        let moves = |j: &&hand::Joint| j.kind != JointKind::Fixed;
        assert_eq!(model.joints().iter().filter(moves).count(), moving);
        let [group] = hand.groups() else {
            panic!("{:?}", hand.groups())
        };
        assert!(group.compliant && group.fingers == [0, 1]);
        let jaws = hand.jaws(0).unwrap();
        assert!(
            (jaws[0].opening - opening).abs() < 2e-3,
            "{}",
            jaws[0].opening
        );
        assert!(jaws.last().unwrap().opening < 0.12 * opening);
        assert!(jaws[0].axis.dot(&hand.approach_axis()).abs() < 1e-12);
        // Each link that moves belongs to one of the fingers.
        let (a, b) = (&hand.fingers()[0], &hand.fingers()[1]);
        assert!(a.moving_links.iter().all(|l| !b.moving_links.contains(l)));
        assert!(matches!(hand.tip_model(), TipModel::Soft { radius } if radius > 5e-3));
        assert_eq!(hand::check_hand(&hand, 5e-3).unwrap(), []);
    }
    assert_eq!(hand::schunk_sdh().unwrap().jaws(0).unwrap(), []);
}

#[test]
fn pads_of_a_linkage_stay_parallel_and_advance() {
    let hand = Hand::built_in("robotiq_2f85").unwrap().unwrap();
    let model = hand.model();
    let pad = model.link_index("left_inner_finger_pad").unwrap();
    let start = model.root_from_links(&[0.0]).unwrap()[pad].rotation;
    for value in [0.1, 0.4, 0.8] {
        let turned = model.root_from_links(&[value]).unwrap()[pad].rotation;
        assert!(turned.angle_to(&start) < 1e-9);
    }
    let jaws = hand.jaws(0).unwrap();
    let advance = jaws[jaws.len() / 2].middle.z - jaws[0].middle.z;
    assert!((0.005..0.02).contains(&advance), "{advance}");
}

#[test]
fn a_palm_that_gives_way_touches_with_both_tips() {
    let hand = panda();
    let surface = egg(0.028, 0.1);
    let object = CollisionObject::new(&surface).unwrap();
    let rules = ClosingRules::default();
    let mesh = parry_mesh(&surface, 241, 480);
    for aside in [-0.009, -0.004, 0.0, 0.007] {
        let pose = above(&hand, aside);
        let start = &hand.preshapes()[0].joints;
        let closed = close_hand(&object, &hand, &pose, start, &rules).unwrap();
        assert_eq!(closed.touching.len(), 2);
        let moved = closed.object_from_links[0].translation.vector - pose.translation.vector;
        // Along the line between the pads, to where the object is.
        assert!(moved.x.abs() < 1e-9 && moved.z.abs() < 1e-9);
        assert!((moved.y + aside).abs() < 2e-4, "{aside}: {}", moved.y);
        let poses = &closed.object_from_links;
        for &tip in &closed.touching {
            let gap = link_distance(hand.model(), tip, &poses[tip], &mesh, 0.01);
            assert!(0.0 < gap && gap < rules.tip_gap, "{gap}");
        }
        // The palm and the links are where the joints say.
        let said = object_from_links(&hand, &poses[0], &closed.joints);
        for (a, b) in said.iter().zip(poses) {
            assert!((a.to_homogeneous() - b.to_homogeneous()).norm() < 1e-12);
        }
    }
}

#[test]
fn without_giving_way_the_first_tip_holds_the_motor() {
    let hand = changed("compliant = true", "compliant = false").unwrap();
    assert!(!hand.groups()[0].compliant);
    let surface = RadialShape::sphere(3, 0.03).unwrap();
    let object = CollisionObject::new(&surface).unwrap();
    let close = |aside: f64| {
        let start = &hand.preshapes()[0].joints;
        close_hand(
            &object,
            &hand,
            &above(&hand, aside),
            start,
            &ClosingRules::default(),
        )
    };
    assert_eq!(close(0.0).unwrap().touching.len(), 2);
    for aside in [-0.005, 0.005] {
        let refused = close(aside).unwrap_err();
        assert!(
            matches!(refused, Rejection::TipDidNotArrive { .. }),
            "{refused:?}"
        );
    }
}

#[test]
fn soft_contacts_close_what_points_cannot() {
    for name in ["panda", "robotiq_2f85"] {
        let hand = Hand::built_in(name).unwrap().unwrap();
        for surface in [
            RadialShape::sphere(4, 0.03).unwrap(),
            lump(0.03, &[0.1, -0.05, 0.1, 0.12, -0.1, 0.05, 0.08, -0.06]),
        ] {
            let mut params = paper_params(&hand, 60);
            let run = synthesize(&surface, &hand, &params, &mut seeded(3)).unwrap();
            assert!(run.grasps.len() >= 25, "{:?}", run.outcomes.by_reason());
            let mesh = parry_mesh(&surface, 241, 480);
            for grasp in run.grasps.iter().step_by(9) {
                check_rules(&hand, &surface, grasp, &mesh);
            }
            params.tips = TipModel::Point;
            let points = synthesize(&surface, &hand, &params, &mut seeded(3)).unwrap();
            assert_eq!(points.grasps, []);
        }
    }
}

/// Tips within the gap, other links clear of the mesh, normals in opposite friction cones, and the
/// quality that of soft discs.
fn check_rules(
    hand: &Hand,
    surface: &RadialShape,
    grasp: &hand::HandGrasp,
    mesh: &parry3d_f64::shape::TriMesh,
) {
    let rules = ClosingRules::default();
    let poses = object_from_links(hand, &grasp.object_from_palm, &grasp.joints);
    let is_tip = |l: &usize| hand.fingers().iter().any(|f| f.tip_links.contains(l));
    for (link, pose) in poses.iter().enumerate() {
        if hand.model().links()[link].geometry.is_empty() {
            continue;
        }
        let gap = link_distance(hand.model(), link, pose, mesh, 0.02);
        if is_tip(&link) {
            assert!(0.0 < gap && gap < rules.tip_gap, "{gap}");
        } else {
            assert!(gap > rules.object_clearance - 1e-4, "{gap}");
        }
    }
    let [a, b] = &grasp.contacts[..] else {
        panic!("{} contacts", grasp.contacts.len())
    };
    assert!((a.position - surface.point(&grasp.directions[0])).norm() < 1e-12);
    let across = (b.position - a.position).normalize();
    assert!(across.dot(&a.inward_normal) > 0.5 && across.dot(&b.inward_normal) < -0.5);
    let convention = Convention::paper();
    let models = hand.tip_model().of_contacts(convention.friction, 2);
    let centre = Point3::origin();
    let model = GraspModel::new(&grasp.contacts, &centre, &convention).with_contact_models(&models);
    let found = epsilon(&model, &mut Workspace::new()).unwrap();
    assert!((found.quality - grasp.quality).abs() < 1e-12 && found.lower > 0.0);
}

#[test]
fn antipodal_poses_are_about_opposite_points_and_from_above() {
    let hand = panda();
    let surface = egg(0.03, 0.3);
    let params = paper_params(&hand, 80);
    let cone = params.sampling.antipodal.unwrap();
    let jaws = &hand.jaws(0).unwrap()[0];
    for pose in params.sampling.sample(
        &CollisionObject::new(&surface).unwrap(),
        &hand,
        80,
        &mut seeded(5),
    ) {
        let approach = pose.object_from_palm * hand.approach_axis();
        assert!(approach.z <= 1e-6);
        let middle = pose.object_from_palm * jaws.middle;
        let axis = pose.object_from_palm * jaws.axis;
        // The line between the jaws leaves the surface on both sides within the opening.
        for way in [axis.into_inner(), -axis.into_inner()] {
            let at = |t: f64| middle + way * t;
            let inside = |t: f64| {
                let p = at(t).coords;
                p.norm()
                    < surface
                        .point(&sph::Direction::new_normalize(p))
                        .coords
                        .norm()
            };
            let far = (0..400).map(|k| 1e-4 * f64::from(k)).find(|t| !inside(*t));
            let far = far.expect("the surface within the opening");
            let (_, inward) = surface.contact(&sph::Direction::new_normalize(at(far).coords));
            // Moved along the approach the line may meet another normal.
            assert!(
                inward.dot(&way) < -(cone + 0.3).cos(),
                "{}",
                inward.dot(&way)
            );
        }
    }
}

#[test]
fn a_finger_may_miss_where_the_spec_allows_it() {
    let sdh = |least: &str| {
        let spec =
            hand::SDH_SPEC.replacen("name = \"sdh\"", &format!("name = \"sdh\"\n{least}"), 1);
        Hand::from_texts(hand::SDH_URDF, &spec).unwrap()
    };
    // Aside of the middle between the two parallel fingers: one of them passes by it.
    let surface = RadialShape::sphere(3, 0.025).unwrap();
    let object = CollisionObject::new(&surface).unwrap();
    let close = |least: &str, aside: f64| {
        let hand = sdh(least);
        let from = nalgebra::Vector3::z_axis();
        let pose = hand::aimed(&hand, &from, 0.2, 0.0) * Translation3::new(0.0, aside, 0.0);
        let start = &hand.preshapes()[0].joints;
        close_hand(&object, &hand, &pose, start, &ClosingRules::default())
            .map(|closed| closed.touching.len())
    };
    for aside in [-0.024, 0.024] {
        let missed = close("", aside).unwrap_err();
        assert!(
            matches!(missed, Rejection::TipDidNotArrive { .. }),
            "{missed:?}"
        );
        assert_eq!(close("least_fingers = 2", aside), Ok(2));
        assert_eq!(close("least_fingers = 3", aside), Err(missed));
    }
    assert!(
        close("least_fingers = 2", 0.08).is_err(),
        "one finger at most"
    );
}

#[test]
fn specs_of_groups_that_do_not_fit_are_refused_by_name() {
    let two = "closing = { panda_finger_joint1 = -1.0 }\n\n[[preshape]]";
    for (from, to, words) in [
        (
            two,
            "closing = { panda_finger_joint1 = -0.5 }\n\n[[preshape]]",
            "fingers 'left' and 'right' share a closing joint",
        ),
        (
            "pad_radius_m = 0.009",
            "pad_radius_m = 9.0",
            "pad_radius_m: 9 is not a radius in metres",
        ),
        (
            "pad_radius_m = 0.009",
            "least_fingers = 3",
            "least_fingers: 3 is not between 2",
        ),
    ] {
        let said = changed(from, to).unwrap_err().to_string();
        assert!(said.contains(words), "{said} lacks {words}");
        let spec = HandSpec::from_toml(&fixtures::PANDA_SPEC.replacen(from, to, 1)).unwrap();
        let model = load_urdf(fixtures::PANDA_URDF).unwrap();
        assert_eq!(Hand::problems(&model, &spec).len(), 1, "{words}");
    }
    let spec = hand::SDH_SPEC.replacen("[self_distance]", "compliant = true\n[self_distance]", 1);
    let said = Hand::from_texts(hand::SDH_URDF, &spec)
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("no two fingers are closed by the same joints"),
        "{said}"
    );
}

#[test]
fn joints_that_follow_have_their_own_values() {
    let hand = panda();
    let joints = hand.model().joints();
    let follower = joints
        .iter()
        .find(|j| j.name == "panda_finger_joint2")
        .unwrap();
    assert!(matches!(follower.drive, Drive::Mimic { .. }));
    assert_eq!(follower.value(&[0.0123]), 0.0123);
    let opened = hand.opened(&[0.01], 0.25);
    assert_eq!(opened, [0.04], "one motor opens once, within its limits");
}
