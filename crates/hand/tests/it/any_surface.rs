//! Surfaces that are maps of the sphere: the same hand grasps them as it does radial ones.

use crate::common::{egg, lump, paper_params, seeded};
use hand::{
    CollisionObject, Hand, HandPose, Outcome, Rejection, TipModel, evaluate_pose, schunk_sdh,
    synthesize,
};
use nalgebra::{Point3, Rotation3};
use shape::{ClosedPatch, RadialShape, SphericalField, SphericalShape};

/// The same surface over the sphere, its parameters turned so that the poles lie elsewhere.
fn copy(radial: &RadialShape) -> SphericalField {
    let shape = SphericalShape::from_radial(radial).unwrap();
    let turn = Rotation3::from_euler_angles(0.7, -0.4, 1.9);
    let [x, y, z] = shape
        .coordinates()
        .each_ref()
        .map(|c| sph::rotation::rotate(c, &turn));
    SphericalField::new(&SphericalShape::new(x, y, z).unwrap())
}

/// A bent tube: a closed surface that no point sees all of.
fn banana() -> SphericalShape {
    let grid = sph::grid::RingGrid::gauss_legendre(21, 41);
    let mut values = [Vec::new(), Vec::new(), Vec::new()];
    for p in grid.directions() {
        let along = 1.5 * p.z;
        let (sin, cos) = along.sin_cos();
        let (out, side) = (0.06 + 0.016 * p.x, 0.016 * p.y);
        let stretched = 0.006 * p.z;
        for (axis, value) in [
            out * cos - stretched * sin - 0.04,
            side,
            out * sin + stretched * cos,
        ]
        .into_iter()
        .enumerate()
        {
            values[axis].push(value);
        }
    }
    let [x, y, z] = values.map(|values| {
        let longitudes = grid.longitudes();
        grid.analysis(&sph::grid::GridValues { longitudes, values }, 20)
    });
    SphericalShape::new(x, y, z).unwrap()
}

fn outcomes(object: &CollisionObject<'_>, hand: &Hand, poses: &[HandPose]) -> Vec<Outcome> {
    let params = paper_params(hand, poses.len());
    let one = |pose| evaluate_pose(object, hand, pose, &params).unwrap();
    poses.iter().map(one).collect()
}

#[test]
fn a_copy_over_the_sphere_is_grasped_as_the_radial_surface() {
    let hand = schunk_sdh().unwrap();
    for radial in [egg(0.035, 0.3), lump(0.04, &[0.02, -0.1, 0.08, 0.1, -0.05])] {
        let field = copy(&radial);
        let (one, other) = (
            CollisionObject::new(&radial).unwrap(),
            CollisionObject::new(&field).unwrap(),
        );
        let poses = paper_params(&hand, 150)
            .sampling
            .sample(&one, &hand, 150, &mut seeded(5));
        let pairs = outcomes(&one, &hand, &poses)
            .into_iter()
            .zip(outcomes(&other, &hand, &poses));
        let (mut same, mut stable) = (0, 0);
        for pair in pairs {
            match pair {
                (Outcome::Stable(a), Outcome::Stable(b)) => {
                    (same, stable) = (same + 1, stable + 1);
                    for (a, b) in a.contacts.iter().zip(&b.contacts) {
                        assert!((a.position - b.position).norm() <= 5e-4);
                        assert!(a.inward_normal.angle(&b.inward_normal) <= 2e-2);
                    }
                    assert!(
                        (a.quality - b.quality).abs() <= 2e-2,
                        "{} {}",
                        a.quality,
                        b.quality
                    );
                }
                (Outcome::Rejected(a), Outcome::Rejected(b)) => same += usize::from(a == b),
                (Outcome::Unstable(_), Outcome::Unstable(_)) => same += 1,
                _ => {}
            }
        }
        assert!(stable >= 30, "{stable} stable");
        assert!(same >= 147, "{same} of 150 poses end alike");
    }
}

#[test]
fn contacts_lie_on_the_surface_at_their_places() {
    let hand = schunk_sdh().unwrap();
    let field = SphericalField::new(&banana());
    let run = synthesize(&field, &hand, &paper_params(&hand, 300), &mut seeded(2)).unwrap();
    assert!(run.grasps.len() >= 20, "{:?}", run.outcomes.by_reason());
    let again = synthesize(&field, &hand, &paper_params(&hand, 300), &mut seeded(2)).unwrap();
    assert_eq!(run, again);
    for grasp in &run.grasps {
        for (contact, p) in grasp.contacts.iter().zip(&grasp.directions) {
            let (place, normal) = shape::Surface::contact(&field, p);
            assert!((contact.position - place).norm() <= 1e-12);
            assert!((contact.inward_normal.dot(&normal) - 1.0).abs() <= 1e-12);
        }
        assert!(grasp.gaps.iter().all(|gap| *gap > 0.0 && *gap < 1e-3));
    }
}

#[test]
fn jaws_find_opposite_sides_of_a_bent_tube() {
    let hand = Hand::built_in("panda").unwrap().unwrap();
    let field = SphericalField::new(&banana());
    let mut params = paper_params(&hand, 120);
    params.tips = TipModel::Soft { radius: 0.005 };
    let run = synthesize(&field, &hand, &params, &mut seeded(4)).unwrap();
    assert!(run.grasps.len() >= 15, "{:?}", run.outcomes.by_reason());
}

#[test]
fn nothing_is_grasped_where_a_hole_was_closed() {
    let hand = schunk_sdh().unwrap();
    let ball = RadialShape::sphere(4, 0.035).unwrap();
    let open = SphericalShape::from_radial(&ball).unwrap();
    let count = |field: &SphericalField| {
        synthesize(field, &hand, &paper_params(&hand, 150), &mut seeded(3)).unwrap()
    };
    let before = count(&SphericalField::new(&open));
    let patch = ClosedPatch {
        places: vec![Point3::new(0.035, 0.0, 0.0), Point3::new(0.03, 0.018, 0.0)],
        reach: 0.02,
        area: 1e-3,
    };
    let closed = open.with_closed_patches(vec![patch.clone()]);
    let after = count(&SphericalField::new(&closed));
    let rejected: usize = after
        .outcomes
        .rejected
        .iter()
        .filter(|(reason, _)| matches!(reason, Rejection::OnClosedHole { .. }))
        .map(|(_, count)| count)
        .sum();
    assert!(rejected > 0 && !after.grasps.is_empty());
    assert!(before.grasps.len() > after.grasps.len());
    for contact in after.grasps.iter().flat_map(|g| &g.contacts) {
        assert!(patch.distance(&contact.position) > 0.0);
    }
}

#[test]
fn the_hollow_of_a_bent_tube_is_outside() {
    let field = SphericalField::new(&banana());
    let object = CollisionObject::new(&field).unwrap();
    // The middle of the tube and the middle of the circle along which it is bent.
    assert!(object.contains(&Point3::new(0.02, 0.0, 0.0)));
    assert!(!object.contains(&Point3::new(-0.04, 0.0, 0.0)));
    assert!(!object.contains(&Point3::new(0.02, 0.02, 0.0)));
    assert!(object.mesh_error() <= CollisionObject::FACET_TOLERANCE);
}
