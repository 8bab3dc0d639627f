//! Closing stops where it should, only ever closes, and never enters the object.

use crate::common::{
    link_distance, link_meets, links_distance, lump, object_from_links, parry_mesh, seeded,
};
use hand::{
    ClosedHand, ClosingRules, CollisionObject, Hand, HandPose, PoseSampling, Rejection, close_hand,
    schunk_sdh,
};
use nalgebra::UnitVector3;
use parry3d_f64::shape::TriMesh;
use proptest::prelude::*;
use shape::RadialShape;

/// Follows the fingers, one after the other as they closed: does any link meet the object?
fn meets_on_the_way(hand: &Hand, pose: &HandPose, end: &[f64], mesh: &TriMesh) -> bool {
    let mut joints = hand.preshapes()[pose.preshape].joints.clone();
    let mut meets = false;
    for finger in hand.fingers() {
        let start = joints.clone();
        // Joints of a finger move together until they stop, one after the other.
        let way = |&(driven, ratio): &(usize, f64)| (end[driven] - start[driven]) / ratio;
        let longest = finger.closing.iter().map(way).fold(0.0, f64::max);
        for step in 0..=20 {
            let gone = longest * f64::from(step) / 20.0;
            for joint in &finger.closing {
                joints[joint.0] = start[joint.0] + joint.1 * gone.min(way(joint));
            }
            let poses = object_from_links(hand, &pose.object_from_palm, &joints);
            let links = finger.moving_links.iter();
            meets |= links
                .copied()
                .any(|link| link_meets(hand.model(), link, &poses[link], mesh));
        }
    }
    meets
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn closing_is_monotone_and_never_penetrates(
        radius in 0.02f64..0.05,
        waves in proptest::collection::vec(-0.15f64..0.15, 24),
        seed in 0u64..1000,
    ) {
        let hand = schunk_sdh().unwrap();
        let surface = lump(radius, &waves);
        let object = CollisionObject::new(&surface).unwrap();
        let mesh = parry_mesh(&surface, 121, 240);
        let poses = PoseSampling::of_hand(&hand).sample(&CollisionObject::new(&surface).unwrap(), &hand, 4, &mut seeded(seed));
        for pose in poses {
            let start = &hand.preshapes()[pose.preshape].joints;
            let rules = ClosingRules::default();
            let Ok(closed) = close_hand(&object, &hand, &pose.object_from_palm, start, &rules) else {
                continue;
            };
            for finger in hand.fingers() {
                for &(driven, ratio) in &finger.closing {
                    prop_assert!((closed.joints[driven] - start[driven]) * ratio >= 0.0);
                }
            }
            prop_assert!(!meets_on_the_way(&hand, &pose, &closed.joints, &mesh));
        }
    }
}

/// Closes from some poses near the object; those that are not rejected.
fn wrapped(
    object: &CollisionObject<'_>,
    hand: &Hand,
    past_tips: bool,
    count: usize,
    seed: u64,
) -> Vec<(HandPose, ClosedHand)> {
    let mut sampling = PoseSampling::of_hand(hand);
    // Near enough for the palm side of the fingers to meet the object before the tips do.
    sampling.standoff = (0.1, 0.14);
    let rules = ClosingRules {
        past_tips,
        ..ClosingRules::default()
    };
    let poses = sampling.sample(object, hand, count, &mut seeded(seed));
    let close = |pose: HandPose| {
        let start = &hand.preshapes()[pose.preshape].joints;
        let closed = close_hand(object, hand, &pose.object_from_palm, start, &rules).ok()?;
        Some((pose, closed))
    };
    poses.into_iter().filter_map(close).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5))]
    #[test]
    fn power_grasps_are_monotone_never_penetrate_and_touch_where_they_say(
        radius in 0.03f64..0.045,
        waves in proptest::collection::vec(-0.1f64..0.1, 24),
        seed in 0u64..1000,
    ) {
        let hand = schunk_sdh().unwrap();
        let surface = lump(radius, &waves);
        let object = CollisionObject::new(&surface).unwrap();
        let mesh = parry_mesh(&surface, 121, 240);
        for (pose, closed) in wrapped(&object, &hand, true, 5, seed) {
            let start = &hand.preshapes()[pose.preshape].joints;
            for (driven, joint) in hand.model().driven_joints().enumerate() {
                prop_assert!(closed.joints[driven] >= start[driven]);
                prop_assert!(closed.joints[driven] <= joint.limits.1);
            }
            prop_assert!(!meets_on_the_way(&hand, &pose, &closed.joints, &mesh));
            for &link in &closed.touching {
                let at = &closed.object_from_links[link];
                let gap = link_distance(hand.model(), link, at, &mesh, 0.01);
                prop_assert!(gap > 0.0 && gap < 1e-3, "{}", gap);
            }
            for &(a, b) in hand.tested_pairs() {
                prop_assert!(links_distance(hand.model(), &closed.object_from_links, a, b) >= 5e-3 - 1e-9);
            }
        }
    }
}

#[test]
fn power_grasps_hold_with_more_than_the_tips() {
    let hand = schunk_sdh().unwrap();
    let surface = RadialShape::sphere(3, 0.04).unwrap();
    let object = CollisionObject::new(&surface).unwrap();
    let power = wrapped(&object, &hand, true, 24, 4);
    let most = power.iter().map(|(_, closed)| closed.touching.len()).max();
    assert!(most >= Some(5), "{most:?}");
    // Poses that the rule for tips alone rejects, because another link comes first.
    assert!(power.len() > wrapped(&object, &hand, false, 24, 4).len());
}

fn aimed_at(hand: &Hand, surface: &RadialShape, standoff: f64, preshape: usize) -> HandPose {
    let from = UnitVector3::new_normalize(nalgebra::Vector3::new(0.1, 0.2, 1.0));
    HandPose {
        object_from_palm: hand::aimed(hand, &from, surface.radius(&from) + standoff, 0.3),
        preshape,
    }
}

fn close(
    surface: &RadialShape,
    hand: &Hand,
    pose: &HandPose,
) -> Result<hand::ClosedHand, Rejection> {
    let object = CollisionObject::new(surface).unwrap();
    let start = &hand.preshapes()[pose.preshape].joints;
    let rules = ClosingRules::default();
    close_hand(&object, hand, &pose.object_from_palm, start, &rules)
}

#[test]
fn rules_hold_after_closing_on_a_ball() {
    let hand = schunk_sdh().unwrap();
    let surface = RadialShape::sphere(3, 0.035).unwrap();
    let mesh = parry_mesh(&surface, 241, 480);
    for preshape in 0..2 {
        let pose = aimed_at(&hand, &surface, 0.15, preshape);
        let closed = close(&surface, &hand, &pose).unwrap();
        let poses = object_from_links(&hand, &pose.object_from_palm, &closed.joints);
        let tips: Vec<usize> = hand
            .fingers()
            .iter()
            .flat_map(|f| f.tip_links.clone())
            .collect();
        for (link, pose) in poses.iter().enumerate() {
            let free = link_distance(hand.model(), link, pose, &mesh, 0.02);
            if tips.contains(&link) {
                assert!(free > 0.0 && free < 1e-3, "{free}");
            } else {
                assert!(free >= 5e-3, "{free}");
            }
        }
        for &(a, b) in hand.tested_pairs() {
            assert!(links_distance(hand.model(), &poses, a, b) >= 5e-3);
        }
        assert_eq!(closed.object_from_links.len(), poses.len());
        assert!(closed.steps > 0 && closed.steps < 100, "{}", closed.steps);
    }
}

#[test]
fn every_reason_for_rejection_is_met() {
    let hand = schunk_sdh().unwrap();
    let ball = |radius| RadialShape::sphere(3, radius).unwrap();
    let outcome = |radius: f64, standoff: f64, preshape: usize| {
        let surface = ball(radius);
        let pose = aimed_at(&hand, &surface, standoff, preshape);
        close(&surface, &hand, &pose).map(|_| ())
    };
    assert!(matches!(
        outcome(0.035, 0.0, 0),
        Err(Rejection::BaseNearObject { .. })
    ));
    assert!(matches!(
        outcome(0.2, 0.12, 0),
        Err(Rejection::StartsInObject { .. })
    ));
    assert!(matches!(
        outcome(0.035, 0.5, 0),
        Err(Rejection::TipDidNotArrive { .. })
    ));
    assert!(matches!(
        outcome(0.06, 0.11, 0),
        Err(Rejection::PartNearObject { .. })
    ));
    let crossed = (10..20).any(|k| {
        let found = outcome(0.01, 0.01 * f64::from(k), 1);
        matches!(found, Err(Rejection::PartsNear { .. }))
    });
    assert!(crossed, "fingers meet around something tiny");
}

#[test]
fn an_object_too_large_for_the_mesh_is_refused_and_never_closed_on_for_ever() {
    // A scan in millimetres read as metres: facets are centimetres off.
    let huge = shape::RadialShape::sphere(6, 40.0).unwrap();
    assert!(matches!(
        hand::CollisionObject::new(&huge),
        Err(hand::ObjectError::Coarse { .. })
    ));
    // A grid that the caller chose, coarser than the gap that tips should close.
    let ball = shape::RadialShape::sphere(6, 0.045).unwrap();
    let coarse = hand::CollisionObject::with_grid(&ball, 8, 8).unwrap();
    assert!(coarse.mesh_error() > 1e-3);
    let hand = hand::schunk_sdh().unwrap();
    let from = nalgebra::Vector3::z_axis();
    for distance in [0.15, 0.17, 0.19] {
        let pose = hand::aimed(&hand, &from, distance + 0.045, 0.3);
        let start = &hand.preshapes()[0].joints;
        let closed = hand::close_hand(&coarse, &hand, &pose, start, &hand::ClosingRules::default());
        assert!(closed.is_err());
    }
}
