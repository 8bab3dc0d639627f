//! Whole runs: enough grasps, the same ones from the same seed, and none that breaks a rule.

use crate::common::{
    egg, link_distance, links_distance, lump, object_from_links, paper_params, parry_mesh, seeded,
};
use hand::{CollisionObject, HandPose, Outcome, collect, evaluate_pose, schunk_sdh, synthesize};
use nalgebra::{UnitQuaternion, UnitVector3, Vector3};
use shape::{RadialShape, Surface};
use sph::Coefficients;

#[test]
fn most_household_sizes_give_many_stable_grasps() {
    let hand = schunk_sdh().unwrap();
    for (surface, least) in [
        (RadialShape::sphere(4, 0.035).unwrap(), 60),
        (egg(0.035, 0.3), 40),
    ] {
        let params = paper_params(&hand, 200);
        let run = synthesize(&surface, &hand, &params, &mut seeded(1)).unwrap();
        assert_eq!(run.outcomes.total(), 200);
        assert_eq!(run.outcomes.stable, run.grasps.len());
        assert!(run.grasps.len() >= least, "{:?}", run.outcomes.by_reason());
        let by_reason: usize = run.outcomes.by_reason().iter().map(|(_, n)| n).sum();
        assert_eq!(by_reason + run.outcomes.stable + run.outcomes.unstable, 200);
        for pair in run.grasps.windows(2) {
            assert!(pair[0].quality >= pair[1].quality);
        }
        assert!(run.grasps.iter().all(|g| g.quality >= 0.01));
    }
}

#[test]
fn the_same_seed_gives_the_same_grasps_in_any_order_of_work() {
    let hand = schunk_sdh().unwrap();
    let surface = egg(0.03, 0.4);
    let params = paper_params(&hand, 60);
    let run = synthesize(&surface, &hand, &params, &mut seeded(7)).unwrap();
    let again = synthesize(&surface, &hand, &params, &mut seeded(7)).unwrap();
    assert_eq!(run, again);
    let object = CollisionObject::new(&surface).unwrap();
    let poses = params.sampling.sample(
        &CollisionObject::new(&surface).unwrap(),
        &hand,
        60,
        &mut seeded(7),
    );
    let mut outcomes: Vec<_> = poses
        .iter()
        .enumerate()
        .rev()
        .map(|(k, pose)| (k, evaluate_pose(&object, &hand, pose, &params).unwrap()))
        .collect();
    outcomes.sort_by_key(|(k, _)| *k);
    assert_eq!(
        run,
        collect(outcomes.into_iter().map(|(_, outcome)| outcome))
    );
    let other = synthesize(&surface, &hand, &params, &mut seeded(8)).unwrap();
    assert_ne!(run.grasps, other.grasps);
}

#[test]
fn contacts_are_the_closest_points_and_carry_the_smooth_normals() {
    let hand = schunk_sdh().unwrap();
    let surface = lump(0.035, &[0.15, -0.1, 0.12, 0.2, -0.15, 0.06, 0.1, -0.12]);
    let params = paper_params(&hand, 120);
    let run = synthesize(&surface, &hand, &params, &mut seeded(3)).unwrap();
    assert!(run.grasps.len() >= 20);
    let mesh = parry_mesh(&surface, 241, 480);
    for grasp in run.grasps.iter().step_by(run.grasps.len() / 15) {
        let poses = object_from_links(&hand, &grasp.object_from_palm, &grasp.joints);
        for (k, finger) in hand.fingers().iter().enumerate() {
            let (point, normal) = surface.contact(&grasp.directions[k]);
            let contact = &grasp.contacts[k];
            assert!((contact.position - point).norm() <= 1e-12);
            assert!((contact.inward_normal.into_inner() - normal.into_inner()).norm() <= 1e-12);
            let nearest = finger
                .tip_links
                .iter()
                .map(|&l| link_distance(hand.model(), l, &poses[l], &mesh, 0.01))
                .fold(f64::INFINITY, f64::min);
            assert!(
                (grasp.gaps[k] - nearest).abs() <= 2e-5,
                "{} {nearest}",
                grasp.gaps[k]
            );
            assert!(grasp.gaps[k] < 1e-3);
        }
    }
}

fn stored(record: &record::ShapeRecord) -> RadialShape {
    RadialShape::new(Coefficients::new(record.coefficients.clone()).unwrap()).unwrap()
}

/// The shapes of three objects of the built-in library.
fn library_surfaces() -> Vec<RadialShape> {
    let library = record::LibraryRecord::from_bytes(fixtures::LIBRARY).unwrap();
    let entries = [3, 7, 10].map(|k| stored(&library.entries[k].shape));
    entries.into()
}

/// Three real scans, fitted.
fn scanned_surfaces() -> Vec<RadialShape> {
    let settings = shape::FitSettings {
        degree: 24,
        lambda: None,
    };
    let scans = ["mustard_bottle", "pear", "tomato_soup_can"];
    let fitted = scans.map(|name| {
        let bytes = testkit::scan_bytes(&format!("objects/{name}.ply"));
        let points = shape::io::read_ply(&bytes).unwrap();
        let cloud = shape::PointCloud::new(points.points).unwrap();
        shape::fit::fit(&cloud, &settings).unwrap().shape
    });
    fitted.into()
}

#[test]
fn a_hundred_grasps_keep_every_rule_on_a_mesh_of_four_times_the_facets() {
    assert_rules_are_kept(&library_surfaces());
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn a_hundred_grasps_on_scans_keep_every_rule_on_a_mesh_of_four_times_the_facets() {
    assert_rules_are_kept(&scanned_surfaces());
}

fn assert_rules_are_kept(surfaces: &[RadialShape]) {
    let hand = schunk_sdh().unwrap();
    let mut checked = 0;
    for (seed, surface) in surfaces.iter().enumerate() {
        let params = paper_params(&hand, 150);
        let run = synthesize(surface, &hand, &params, &mut seeded(seed as u64)).unwrap();
        let (rows, columns) = CollisionObject::new(surface).unwrap().grid();
        let mesh = parry_mesh(surface, 2 * rows - 1, 2 * columns);
        for grasp in run.grasps.iter().take(40) {
            let poses = object_from_links(&hand, &grasp.object_from_palm, &grasp.joints);
            for (link, pose) in poses.iter().enumerate() {
                let free = link_distance(hand.model(), link, pose, &mesh, 6e-3);
                if grasp.links.contains(&link) {
                    assert!(free > 0.0 && free < 1e-3, "{link} {free}");
                } else {
                    assert!(free >= 5e-3, "{link} {free}");
                }
            }
            for &(a, b) in hand.tested_pairs() {
                assert!(links_distance(hand.model(), &poses, a, b) >= 5e-3 - 1e-9);
            }
            for (contact, direction) in grasp.contacts.iter().zip(&grasp.directions) {
                assert!((contact.position - surface.contact(direction).0).norm() <= 1e-12);
            }
            checked += 1;
        }
    }
    assert!(checked >= 100, "{checked}");
}

#[test]
fn power_grasps_are_measured_over_all_links_that_touch() {
    let hand = schunk_sdh().unwrap();
    let surface = egg(0.04, 0.1);
    let mut params = paper_params(&hand, 100);
    params.rules.past_tips = true;
    params.sampling.standoff = (0.09, 0.13);
    let run = synthesize(&surface, &hand, &params, &mut seeded(5)).unwrap();
    assert_eq!(run.outcomes.total(), 100);
    let many = run.grasps.iter().filter(|g| g.contacts.len() > 3).count();
    assert!(
        run.grasps.len() >= 20 && many >= 5,
        "{many} of {}",
        run.grasps.len()
    );
    let mesh = parry_mesh(&surface, 241, 480);
    for grasp in run.grasps.iter().take(30) {
        let poses = object_from_links(&hand, &grasp.object_from_palm, &grasp.joints);
        for (k, &link) in grasp.links.iter().enumerate() {
            let distance = link_distance(hand.model(), link, &poses[link], &mesh, 0.01);
            assert!((grasp.gaps[k] - distance).abs() <= 2e-5 && grasp.gaps[k] < 1e-3);
            let (point, _) = surface.contact(&grasp.directions[k]);
            assert!((grasp.contacts[k].position - point).norm() <= 1e-12);
        }
    }
}

#[test]
fn a_ball_treats_every_direction_alike() {
    let hand = schunk_sdh().unwrap();
    let surface = RadialShape::sphere(4, 0.035).unwrap();
    let object = CollisionObject::new(&surface).unwrap();
    let params = paper_params(&hand, 0);
    for (standoff, roll, preshape) in [
        (0.12, 0.3, 0),
        (0.15, 1.0, 1),
        (0.19, 2.0, 0),
        (0.08, 0.0, 1),
    ] {
        let outcomes: Vec<Outcome> = sph::direction::even_directions(30)
            .iter()
            .map(|from| {
                let object_from_palm = hand::aimed(&hand, from, 0.035 + standoff, roll);
                let pose = HandPose {
                    object_from_palm,
                    preshape,
                };
                evaluate_pose(&object, &hand, &pose, &params).unwrap()
            })
            .collect();
        for outcome in &outcomes {
            match (outcome, &outcomes[0]) {
                (Outcome::Stable(a), Outcome::Stable(b)) => {
                    assert!(
                        (a.quality - b.quality).abs() <= 2e-2,
                        "{} {}",
                        a.quality,
                        b.quality
                    );
                }
                (a, b) => assert_eq!(a, b),
            }
        }
    }
}

#[test]
fn an_object_of_revolution_gives_the_same_counts_from_every_side() {
    let hand = schunk_sdh().unwrap();
    let surface = egg(0.035, 0.4);
    let object = CollisionObject::new(&surface).unwrap();
    let params = paper_params(&hand, 0);
    let poses = params.sampling.sample(
        &CollisionObject::new(&surface).unwrap(),
        &hand,
        80,
        &mut seeded(9),
    );
    let counts = |turn: f64| {
        let about_z = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
        let turned = poses.iter().map(|pose| HandPose {
            object_from_palm: about_z * pose.object_from_palm,
            preshape: pose.preshape,
        });
        let outcomes = turned.map(|pose| evaluate_pose(&object, &hand, &pose, &params).unwrap());
        collect(outcomes).outcomes
    };
    let first = counts(0.0);
    assert!(first.stable >= 10 && first.stable < 80, "{first:?}");
    for quarter in 1..4 {
        assert_eq!(
            counts(f64::from(quarter) * std::f64::consts::FRAC_PI_2),
            first
        );
    }
}

#[test]
fn poses_aim_at_the_origin_from_the_upper_hemisphere() {
    let hand = schunk_sdh().unwrap();
    let surface = egg(0.04, 0.3);
    let sampling = hand::PoseSampling::of_hand(&hand);
    let poses = sampling.sample(
        &CollisionObject::new(&surface).unwrap(),
        &hand,
        500,
        &mut seeded(11),
    );
    let mut seen = [0, 0];
    let mut mean_height = 0.0;
    for pose in &poses {
        let palm = pose.object_from_palm.translation.vector;
        let approach = pose.object_from_palm * hand.approach_axis().into_inner();
        assert!(palm.normalize().dot(&approach) <= -1.0 + 1e-12);
        assert!(palm.z >= 0.0);
        let from = UnitVector3::new_normalize(palm);
        let standoff = palm.norm() - surface.radius(&from);
        assert!(standoff >= hand.standoff().0 - 1e-12 && standoff <= hand.standoff().1 + 1e-12);
        seen[pose.preshape] += 1;
        mean_height += from.z / 500.0;
    }
    // Uniform on the hemisphere: the mean height is 1/2, its deviation 0.013.
    assert!((mean_height - 0.5).abs() <= 0.06);
    assert!(seen[0] >= 200 && seen[1] >= 200);
    let straight_down = hand::aimed(&hand, &Vector3::z_axis(), 0.2, 0.0);
    assert!((straight_down * hand.approach_axis().into_inner() + Vector3::z()).norm() <= 1e-12);
}
