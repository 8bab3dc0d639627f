//! A measure has the threshold, the centre and the torque length of its own object.

use moduli::{Convention, Hand, Library, Poses};

use crate::common::ellipsoid;

const AXES: [f64; 3] = [0.035, 0.030, 0.045];

#[test]
fn every_convention_finds_stable_grasps_of_its_own_scale() {
    let object = ellipsoid(AXES, [0.2, 0.0, 0.1]);
    let hand = Hand::schunk_sdh().unwrap();
    let poses = Poses {
        count: 40,
        ..Poses::default()
    };
    for name in Convention::NAMES {
        let measure = object.measure(&Convention::named(name).unwrap()).unwrap();
        let expected = if name == "paper" { 0.01 } else { 0.0 };
        assert_eq!(measure.stable_above(), expected, "{name}");
        let grasps = measure.synthesize(&hand, &poses).unwrap();
        assert!(!grasps.is_empty(), "no stable grasp under {name}");
        for grasp in grasps.iter() {
            assert!(measure.is_stable(grasp.quality()) && grasp.epsilon().lower > 0.0);
        }
    }
    let paper = object.measure(&Convention::paper()).unwrap();
    assert!(!paper.is_stable(0.009) && paper.is_stable(0.011));
    let openrave = object.measure(&Convention::openrave()).unwrap();
    assert!(!openrave.is_stable(0.0) && openrave.is_stable(1e-9));
}

#[test]
fn the_named_conventions_are_those_of_their_constructors() {
    let made = [
        Convention::paper(),
        Convention::graspit(),
        Convention::dexnet(),
        Convention::frogger(),
        Convention::openrave(),
        Convention::unit(),
    ];
    assert_eq!(made.len(), Convention::NAMES.len());
    for convention in made {
        let named = Convention::named(&convention.name).unwrap();
        assert_eq!(convention, named);
    }
}

#[test]
fn carried_grasps_are_measured_as_any_other_grasp_of_the_object() {
    let object = ellipsoid(AXES, [0.5, 0.1, 0.0]);
    let hand = Hand::schunk_sdh().unwrap();
    for name in ["paper", "graspit", "frogger"] {
        let measure = object.measure(&Convention::named(name).unwrap()).unwrap();
        let carried = Library::builtin().transfer_to(&measure, &hand).unwrap();
        assert!(!carried.is_empty());
        for grasp in carried.iter() {
            let again = measure.epsilon(grasp.contacts()).unwrap();
            let (said, found) = (grasp.quality(), again.quality);
            assert!((said - found).abs() <= 1e-6, "{name}: {said} or {found}");
        }
    }
}

#[test]
fn an_object_that_is_moved_has_the_same_grasps_in_another_place() {
    let here = ellipsoid(AXES, [0.0; 3]);
    let there = ellipsoid(AXES, [0.4, -0.3, 0.2]);
    let points = [[0.035, 0.0, 0.0], [-0.02, 0.025, 0.0], [-0.02, -0.025, 0.0]];
    let moved = points.map(|[x, y, z]| [x + 0.4, y - 0.3, z + 0.2]);
    // The paper measures about the mean of the cloud, which moves with the object.
    let (a, b) = (
        here.measure(&Convention::paper()).unwrap(),
        there.measure(&Convention::paper()).unwrap(),
    );
    let (a, b) = (a.grasp_at(&points).unwrap(), b.grasp_at(&moved).unwrap());
    assert!((a.quality() - b.quality()).abs() <= 1e-6);
    for (p, q) in a.contacts_in_cloud().iter().zip(b.contacts_in_cloud()) {
        let shift = q - p;
        assert!((shift.x - 0.4).abs() <= 1e-6 && (shift.y + 0.3).abs() <= 1e-6);
    }
    // FRoGGeR measures about the origin of the cloud, which does not.
    let far = there.measure(&Convention::frogger()).unwrap();
    let near = here.measure(&Convention::frogger()).unwrap();
    assert!((near.centre().coords.norm()) <= 1e-6 && far.centre().coords.norm() > 0.5);
}
