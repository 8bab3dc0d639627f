//! Grasps on maps of the sphere, and between them and radial surfaces.

use crate::common::{between, closed_start, field, lumpy, paper};
use nalgebra::{Point3, Rotation3};
use shape::{AnyField, ClosedPatch, RadialShape, SphericalField, SphericalShape, Surface};
use space::{Constraints, Continuation, MonotoneAscent, Objective, distance_of};

/// A radial surface as a map whose parameters are turned.
fn turned(shape: &RadialShape) -> AnyField {
    let map = SphericalField::from_radial(shape);
    map.turned(&Rotation3::from_euler_angles(1.1, 0.4, -2.0))
        .into()
}

#[test]
fn a_transfer_to_a_map_ends_on_its_own_places() {
    let (from, to) = (lumpy(3), lumpy(53));
    let convention = paper();
    let start = closed_start(&from, 3);
    let (plain, plain_to) = (field(from), field(to.clone()));
    let radial = between(&plain, &plain_to, &convention);
    let expected = Continuation::default().carry(&radial, &start).unwrap();
    // The target alone is a map, with its parameters turned.
    let map = turned(&to);
    let mixed = between(&plain, &map, &convention);
    let found = mixed.correspondence().unwrap();
    assert!(found.misfit < found.misfit_unturned);
    let arrived = Continuation::default().carry(&mixed, &start).unwrap();
    assert!((arrived.start_quality - expected.start_quality).abs() <= 1e-9);
    // The parameters are turned otherwise on the way, so the end may be another one.
    assert!(arrived.quality >= arrived.start_quality);
    let naive = mixed.naive(&start).unwrap();
    assert!(arrived.quality >= naive.quality);
    // The directions are those of the target itself.
    let mut objective = Objective::new(&convention, &map, &Point3::origin());
    for end in [&arrived, &naive] {
        let again = objective.quality_at(&map, &end.directions).unwrap();
        assert!((again - end.quality).abs() <= 1e-9);
    }
    assert_eq!(mixed.crossing_stations(4).unwrap(), []);
}

#[test]
fn a_surface_is_at_no_distance_from_itself_turned() {
    let (one, other) = (lumpy(7), lumpy(8));
    let radial = distance_of(&field(one.clone()), &field(other.clone()));
    assert!(distance_of(&field(one.clone()), &turned(&one)) <= 1e-6);
    let found = distance_of(&field(one), &turned(&other));
    // A rotation may be better than none.
    assert!(
        found > 0.1 * radial && found <= radial + 1e-9,
        "{found} {radial}"
    );
}

#[test]
fn ascents_and_transfers_keep_off_closed_holes() {
    let shape = SphericalShape::from_radial(&lumpy(11)).unwrap();
    let free = SphericalField::new(&shape);
    let convention = paper();
    let start = closed_start(&free, 11);
    let mut objective = Objective::new(&convention, &free, &Point3::origin());
    let climber = MonotoneAscent::default();
    let best = climber
        .climb(&free, &start, &mut objective, |_| {})
        .unwrap();
    // The hole is where the best grasp has a contact.
    let hole = ClosedPatch {
        places: vec![free.point(&best.directions[0])],
        reach: 0.008,
        area: 2e-4,
    };
    let closed = SphericalField::new(&shape.with_closed_patches(vec![hole.clone()]));
    let limits = Constraints {
        closed_holes: closed.closed_patches().to_vec(),
        ..Constraints::default()
    };
    let kept = climber
        .climb_within(&closed, &best.directions, &mut objective, &limits, |_| {})
        .unwrap();
    assert!(kept.quality > 0.0 && kept.quality <= best.quality + 1e-12);
    let off = |directions: &[sph::Direction]| {
        directions
            .iter()
            .all(|p| hole.distance(&closed.point(p)) >= 0.0)
    };
    assert!(!off(&best.directions) && off(&kept.directions));
    let (from, to) = (field(lumpy(12)), AnyField::from(closed.clone()));
    let transfer = between(&from, &to, &convention);
    let arrived = Continuation::default()
        .carry(&transfer, &closed_start(&from, 2))
        .unwrap();
    assert!(arrived.quality > 0.0 && off(&arrived.directions));
}
