//! From contacts to a hand: contacts that a hand can make are found again.

use crate::common::{
    egg, link_distance, lump, object_from_links, paper_params, parry_mesh, seeded,
};
use hand::{
    CollisionObject, HandState, ImproveParams, ReachOutcome, ReachParams, Reacher, carried_pose,
    reach_contacts, schunk_sdh, synthesize,
};
use shape::RadialShape;

#[test]
fn contacts_that_the_hand_made_once_are_reached_again() {
    let hand = schunk_sdh().unwrap();
    let params = ReachParams::default();
    let (mut tried, mut reached) = (0, 0);
    for surface in [
        egg(0.035, 0.3),
        lump(0.035, &[0.15, -0.1, 0.12, 0.2, -0.15, 0.06]),
    ] {
        let object = CollisionObject::new(&surface).unwrap();
        let mesh = parry_mesh(&surface, 241, 480);
        let run = synthesize(&surface, &hand, &paper_params(&hand, 40), &mut seeded(2)).unwrap();
        for grasp in run.grasps.iter().take(6) {
            tried += 1;
            let outcome =
                reach_contacts(&object, &hand, &grasp.contacts, &params, &mut seeded(tried));
            let ReachOutcome::Reached(found) = outcome else {
                continue;
            };
            reached += 1;
            let poses = object_from_links(&hand, &found.object_from_palm, &found.joints);
            for (k, contact) in found.contacts.iter().enumerate() {
                let apart = (contact.position - grasp.contacts[k].position).norm();
                assert!(apart <= found.position_error && found.position_error <= 2e-3);
                let tip = hand.fingers()[found.finger_of_contact[k]].tip_links[0];
                let gap = link_distance(hand.model(), tip, &poses[tip], &mesh, 0.01);
                assert!(gap > 0.0 && gap < 1e-3);
            }
            for (link, pose) in poses.iter().enumerate() {
                if !hand.fingers().iter().any(|f| f.tip_links.contains(&link)) {
                    let free = link_distance(hand.model(), link, pose, &mesh, 6e-3);
                    assert!(free >= 5e-3, "{link} {free}");
                }
            }
        }
    }
    assert!(
        tried == 12 && 4 * reached >= 3 * tried,
        "{reached} of {tried}"
    );
}

#[test]
fn a_hand_that_is_known_is_found_at_the_first_start() {
    let hand = schunk_sdh().unwrap();
    let surface = egg(0.035, 0.3);
    let object = CollisionObject::new(&surface).unwrap();
    let reacher = Reacher::new(&object, &hand);
    let run = synthesize(&surface, &hand, &paper_params(&hand, 40), &mut seeded(2)).unwrap();
    let params = ReachParams {
        starts: 0,
        ..ReachParams::default()
    };
    assert!(run.grasps.len() >= 8);
    for grasp in run.grasps.iter().take(8) {
        let same = carried_pose(&grasp.object_from_palm, &grasp.contacts, &grasp.contacts);
        let known = HandState {
            object_from_palm: same,
            joints: grasp.joints.clone(),
        };
        let outcome = reacher.reach(&grasp.contacts, &params, &[known], &mut seeded(0));
        let ReachOutcome::Reached(found) = outcome else {
            panic!("not reached: {outcome:?}");
        };
        assert!(found.starts == 1 && found.position_error <= 1e-3);
    }
}

#[test]
fn an_improved_hand_keeps_the_rules_and_never_loses_quality() {
    let hand = schunk_sdh().unwrap();
    let surface = lump(0.035, &[0.1, -0.1, 0.1, 0.15, -0.1, 0.06]);
    let object = CollisionObject::new(&surface).unwrap();
    let reacher = Reacher::new(&object, &hand);
    let mesh = parry_mesh(&surface, 241, 480);
    let setup = paper_params(&hand, 60);
    let run = synthesize(&surface, &hand, &setup, &mut seeded(2)).unwrap();
    // Exactly is never reached, so that whatever is found is only near.
    let params = ReachParams {
        starts: 6,
        tolerance: 0.0,
        ..ReachParams::default()
    };
    let improve = ImproveParams {
        tips: hand.tip_model(),
        trials: 25,
        spread: 4e-3,
        convention: setup.convention.clone(),
        centre: setup.centre,
    };
    let mut gained = 0;
    for grasp in run.grasps.iter().rev().take(5) {
        let wanted = &grasp.contacts;
        let outcome = reacher.reach(wanted, &params, &[], &mut seeded(1));
        let ReachOutcome::Near(near) = outcome else {
            continue;
        };
        let better = |seed| {
            let near = near.clone();
            let found = reacher.improve(wanted, near, &params, &improve, &mut seeded(seed));
            found.unwrap()
        };
        let found = better(3);
        assert_eq!(found, better(3));
        assert!(found.quality >= found.start_quality);
        gained += usize::from(found.quality > found.start_quality + 0.01);
        let poses = object_from_links(
            &hand,
            &found.reached.object_from_palm,
            &found.reached.joints,
        );
        for (link, pose) in poses.iter().enumerate() {
            let is_tip = hand.fingers().iter().any(|f| f.tip_links.contains(&link));
            let free = link_distance(hand.model(), link, pose, &mesh, 6e-3);
            if is_tip {
                assert!(free > 0.0 && free < 1e-3, "{link} {free}");
            } else {
                assert!(free >= 5e-3, "{link} {free}");
            }
        }
        let pairs = found.reached.contacts.iter().zip(wanted);
        let apart = pairs.map(|(made, wanted)| (made.position - wanted.position).norm());
        let farthest = apart.fold(0.0, f64::max);
        assert!((farthest - found.reached.position_error).abs() <= 1e-12);
    }
    assert!(gained >= 3, "{gained}");
}

#[test]
fn what_cannot_be_reached_is_said_so() {
    let hand = schunk_sdh().unwrap();
    let surface = RadialShape::sphere(3, 0.4).unwrap();
    let object = CollisionObject::new(&surface).unwrap();
    let contact = |x: f64, y: f64, z: f64| {
        let direction = sph::Direction::new_normalize(nalgebra::Vector3::new(x, y, z));
        let (position, inward_normal) = shape::Surface::contact(&surface, &direction);
        grasp::Contact {
            position,
            inward_normal,
        }
    };
    let apart = [
        contact(1.0, 0.0, 0.0),
        contact(-1.0, 0.1, 0.0),
        contact(0.0, 0.0, 1.0),
    ];
    let params = ReachParams {
        starts: 3,
        ..ReachParams::default()
    };
    let outcome = reach_contacts(&object, &hand, &apart, &params, &mut seeded(1));
    assert!(matches!(outcome, ReachOutcome::Nothing { best_fit } if best_fit > 0.1));
    let outcome = reach_contacts(&object, &hand, &apart[..2], &params, &mut seeded(1));
    assert_eq!(
        outcome,
        ReachOutcome::WrongCount {
            contacts: 2,
            fingers: 3
        }
    );
}
