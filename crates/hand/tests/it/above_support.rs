//! Hands stay above the plane on which the object stands: open, on the way, closed, and when they are
//! looked for.

use crate::common::{egg, object_from_links, on_ground, paper_params, seeded};
use grasp::Contact;
use hand::{
    CollisionObject, Hand, ReachOutcome, ReachParams, Rejection, close_hand, hand_meshes,
    reach_contacts, schunk_sdh, synthesize,
};
use nalgebra::{Isometry3, UnitVector3, Vector3};
use shape::{RadialShape, Support};

fn ground(surface: &RadialShape, normal: UnitVector3<f64>) -> Support {
    let vertices = surface.mesh(181, 360).vertices;
    let heights = vertices.iter().map(|v| normal.dot(&v.coords));
    Support {
        normal,
        offset_m: heights.fold(f64::INFINITY, f64::min),
    }
}

/// Least height of the hand's meshes, placed in the object frame.
fn lowest(hand: &Hand, palm: &Isometry3<f64>, joints: &[f64], support: &Support) -> f64 {
    let meshes = hand_meshes(hand, joints).unwrap();
    let vertices = meshes.iter().flat_map(|(_, mesh)| &mesh.vertices);
    let heights = vertices.map(|v| support.height(&(palm * v)));
    heights.fold(f64::INFINITY, f64::min)
}

#[test]
fn the_lowest_link_is_that_of_the_meshes() {
    for hand in [
        schunk_sdh().unwrap(),
        Hand::built_in("robotiq_2f85").unwrap().unwrap(),
    ] {
        for (k, normal) in [Vector3::z(), Vector3::new(0.3, -0.5, 0.2), -Vector3::y()]
            .into_iter()
            .enumerate()
        {
            let support = Support {
                normal: UnitVector3::new_normalize(normal),
                offset_m: -0.1 * k as f64,
            };
            let palm = Isometry3::new(
                Vector3::new(0.1, -0.2, 0.3),
                Vector3::new(0.4, 0.1 * k as f64, -0.7),
            );
            let joints = &hand.preshapes()[0].joints;
            let poses = object_from_links(&hand, &palm, joints);
            let (link, height) = hand.lowest_link(&support, &poses).unwrap();
            assert!(!hand.model().links()[link].geometry.is_empty());
            // Meshes of round pieces lie inside them.
            let seen = lowest(&hand, &palm, joints, &support);
            assert!(
                height <= seen + 1e-12 && seen - height < 1e-3,
                "{height} {seen}"
            );
            // The same from the palm.
            let local = hand.model().root_from_links(joints).unwrap();
            let (_, again) = hand.lowest_link(&support.seen_from(&palm), &local).unwrap();
            assert!((again - height).abs() < 1e-12);
        }
    }
}

#[test]
fn every_grasp_of_a_standing_object_is_above_its_plane() {
    let tilted = UnitVector3::new_normalize(Vector3::new(0.5, 0.2, 0.9));
    for (name, least) in [("sdh", 12), ("panda", 30), ("robotiq_2f85", 30)] {
        let hand = Hand::built_in(name).unwrap().unwrap();
        let surface = egg(0.034, 0.25);
        for normal in [Vector3::z_axis(), tilted] {
            let support = ground(&surface, normal);
            let params = on_ground(&hand, 100, support);
            let run = synthesize(&surface, &hand, &params, &mut seeded(4)).unwrap();
            assert!(
                run.grasps.len() >= least,
                "{name} {:?}",
                run.outcomes.by_reason()
            );
            for grasp in &run.grasps {
                let start = &hand.preshapes()[grasp.preshape].joints;
                for share in [0.0, 0.3, 0.6, 1.0] {
                    let pairs = start.iter().zip(&grasp.joints);
                    let joints: Vec<f64> = pairs.map(|(a, b)| a + share * (b - a)).collect();
                    let height = lowest(&hand, &grasp.object_from_palm, &joints, &support);
                    assert!(height >= 3e-3 - 1e-9, "{name} {share} {height}");
                }
            }
        }
    }
}

#[test]
fn what_is_below_the_plane_is_counted_as_that() {
    let hand = schunk_sdh().unwrap();
    let surface = egg(0.034, 0.1);
    let support = ground(&surface, Vector3::z_axis());
    let mut params = on_ground(&hand, 60, support);
    // Poses drawn without the plane, many of them through it.
    params.sampling.support = None;
    let run = synthesize(&surface, &hand, &params, &mut seeded(4)).unwrap();
    let (reason, below) = run.outcomes.by_reason()[0];
    assert!(reason == "below_support" && below >= 10, "{reason} {below}");
    let free = paper_params(&hand, 60);
    let without = synthesize(&surface, &hand, &free, &mut seeded(4)).unwrap();
    assert_eq!(without.outcomes.by_reason()[0], ("below_support", 0));
    assert!(without.grasps.len() > run.grasps.len());
    // Those that stay are the ones that the plane does not touch.
    assert!(run.grasps.iter().all(|g| without.grasps.contains(g)));

    let object = CollisionObject::new(&surface).unwrap();
    let aside = hand::aimed(&hand, &Vector3::x_axis(), 0.2, 0.3);
    let start = &hand.preshapes()[0].joints;
    let refused = close_hand(&object, &hand, &aside, start, &params.rules).unwrap_err();
    assert!(
        matches!(refused, Rejection::BelowSupport { .. }),
        "{refused:?}"
    );
    let said = refused.describe(&hand);
    assert!(said.contains("support plane"), "{said}");
}

#[test]
fn hands_that_are_looked_for_stay_above_too() {
    let hand = schunk_sdh().unwrap();
    let surface = egg(0.034, 0.25);
    let support = ground(&surface, Vector3::z_axis());
    let params = on_ground(&hand, 100, support);
    let run = synthesize(&surface, &hand, &params, &mut seeded(4)).unwrap();
    let object = CollisionObject::new(&surface).unwrap();
    let reach = ReachParams {
        starts: 20,
        rules: params.rules,
        ..ReachParams::default()
    };
    let mut found = 0;
    for grasp in run.grasps.iter().take(6) {
        let wanted: &[Contact] = &grasp.contacts;
        if let ReachOutcome::Reached(hand_there) =
            reach_contacts(&object, &hand, wanted, &reach, &mut seeded(9))
        {
            let (palm, joints) = (&hand_there.object_from_palm, &hand_there.joints);
            assert!(lowest(&hand, palm, joints, &support) >= 3e-3 - 1e-9);
            found += 1;
        }
    }
    assert!(found >= 3, "{found}");
}
