//! Hands stay away from other pieces of the scene and out of the scan.

use std::sync::Arc;

use crate::common::{object_from_links, paper_params, seeded};
use hand::{
    CollisionObject, Hand, HandGrasp, PointTree, Surroundings, Synthesis, hand_meshes, schunk_sdh,
    synthesize_on,
};
use nalgebra::{Point3, Vector3};
use shape::RadialShape;

fn run(hand: &Hand, surroundings: Surroundings) -> Synthesis {
    let ball = RadialShape::sphere(3, 0.035).unwrap();
    let object = CollisionObject::new(&ball)
        .unwrap()
        .with_surroundings(Arc::new(surroundings));
    let params = paper_params(hand, 150);
    synthesize_on(&object, hand, &params, &mut seeded(3), &|| {}).unwrap()
}

fn counted(run: &Synthesis, reason: &str) -> usize {
    let counts = run.outcomes.by_reason();
    counts.iter().find(|(name, _)| *name == reason).unwrap().1
}

/// Least distance of points from the vertices of a placed hand, metres.
fn nearest(hand: &Hand, grasp: &HandGrasp, points: &[Point3<f64>]) -> f64 {
    let meshes = hand_meshes(hand, &grasp.joints).unwrap();
    let vertices: Vec<Point3<f64>> = meshes
        .iter()
        .flat_map(|(_, mesh)| &mesh.vertices)
        .map(|v| grasp.object_from_palm * v)
        .collect();
    let of_point = |p: &Point3<f64>| {
        let distances = vertices.iter().map(|v| (v - p).norm());
        distances.fold(f64::INFINITY, f64::min)
    };
    points.iter().map(of_point).fold(f64::INFINITY, f64::min)
}

#[test]
fn hands_stay_away_from_other_pieces() {
    let hand = schunk_sdh().unwrap();
    // A ball of 4 cm beside the object.
    let obstacle: Vec<Point3<f64>> = sph::direction::even_directions(800)
        .iter()
        .map(|d| Point3::new(0.08, 0.0, 0.0) + d.into_inner() * 0.02)
        .collect();
    let free = run(&hand, Surroundings::default());
    let beside = run(
        &hand,
        Surroundings {
            obstacles: PointTree::new(obstacle.clone()),
            ..Surroundings::default()
        },
    );
    assert_eq!(counted(&free, "obstacle"), 0);
    let refused = counted(&beside, "obstacle");
    assert!(refused >= 10, "{refused}");
    assert!(beside.grasps.len() >= 10, "{}", beside.grasps.len());
    assert_eq!(beside.outcomes.total(), 150);
    for grasp in &beside.grasps {
        // What is kept was a grasp before, and no vertex of the hand is near.
        assert!(free.grasps.iter().any(|g| g.joints == grasp.joints));
        let gap = nearest(&hand, grasp, &obstacle);
        assert!(gap >= Surroundings::CLEARANCE - 1e-9, "{gap}");
    }
    let met = |g: &&HandGrasp| nearest(&hand, g, &obstacle) < Surroundings::CLEARANCE;
    assert!(free.grasps.iter().filter(met).count() >= 5);
}

#[test]
fn hands_inside_the_scan_are_counted() {
    let hand = schunk_sdh().unwrap();
    // The scan has a fin that the ball does not describe.
    let fin: Vec<Point3<f64>> = (0..30)
        .flat_map(|i| (0..20).map(move |k| (f64::from(i), f64::from(k))))
        .map(|(i, k)| {
            let angle = 0.1 * i - 1.5;
            let radius = 0.036 + 0.0015 * k;
            Point3::new(angle.cos() * radius, 0.0, angle.sin() * radius)
        })
        .collect();
    let scan = |noise: f64| {
        let surroundings = Surroundings {
            cloud: PointTree::new(fin.clone()),
            noise,
            ..Surroundings::default()
        };
        run(&hand, surroundings)
    };
    let exact = scan(0.0);
    let refused = counted(&exact, "in_scan");
    assert!(refused >= 5, "{refused}");
    for grasp in &exact.grasps {
        // No point is in the middle of a tip.
        let poses = object_from_links(&hand, &grasp.object_from_palm, &grasp.joints);
        for finger in hand.fingers() {
            let middle = poses[finger.tip_links[0]] * Point3::from(Vector3::new(0.0, 0.0, 0.05));
            let apart = fin.iter().map(|p| (p - middle).norm());
            assert!(apart.fold(f64::INFINITY, f64::min) > 5e-3);
        }
    }
    // Points within the noise are no reason.
    assert!(counted(&scan(0.02), "in_scan") < refused);
}
