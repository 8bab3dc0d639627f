//! Conventions print what the systems they are named after print.

use grasp::{
    Contact, Convention, Edges, Grasp, TangentRule, TorqueLength, epsilon_quality, wrenches,
};
use nalgebra::{Point3, Unit, Vector3};

/// Three contacts on a circle around the origin.
fn ring(radius: f64) -> Grasp {
    let contacts = (0..3)
        .map(|i| {
            let a = std::f64::consts::TAU * f64::from(i) / 3.0;
            let p = Vector3::new(a.cos(), a.sin(), 0.0);
            Contact {
                position: Point3::from(p * radius),
                inward_normal: Unit::new_normalize(-p),
            }
        })
        .collect();
    Grasp::new(contacts, Point3::origin()).unwrap()
}

#[test]
fn frogger_with_its_own_tangents() {
    // Printed by its metric for the unit circle, torque in metres.
    let printed = [
        (0.5, 8, 0.238780),
        (1.0, 8, 0.385914),
        (1.0, 10, 0.392311),
        (0.7, 4, 0.254964),
    ];
    for (friction, edges, value) in printed {
        let convention = Convention {
            friction,
            edges: Edges::Polygon(edges),
            tangent: TangentRule::Projected(Vector3::new(1.2, 2.3, 3.4)),
            ..Convention::named("frogger").unwrap()
        };
        let found = epsilon_quality(&ring(1.0), &convention).unwrap();
        assert!((found - value).abs() <= 5e-7, "{found} {value}");
    }
}

#[test]
fn dexnet_on_a_ring_of_a_millimetre() {
    // In its unit of torque that is the unit circle; along z, the third axis is least aligned.
    let convention = Convention::named("dexnet").unwrap();
    let found = epsilon_quality(&ring(1e-3), &convention).unwrap();
    assert!((found - 0.275925).abs() <= 5e-7, "{found}");
}

#[test]
fn graspit_does_not_ask_for_the_size() {
    let convention = Convention {
        friction: 0.5,
        ..Convention::named("graspit").unwrap()
    };
    for radius in [1e-3, 0.04, 10.0] {
        let found = epsilon_quality(&ring(radius), &convention).unwrap();
        assert!((found - 0.275925).abs() <= 5e-7, "{found}");
    }
}

#[test]
fn openrave_has_unit_edges() {
    let convention = Convention {
        friction: 0.5,
        ..Convention::named("openrave").unwrap()
    };
    let found = epsilon_quality(&ring(1.0), &convention).unwrap();
    assert!((found - 0.246795).abs() <= 5e-7, "{found}");
}

#[test]
fn open_grasps_print_what_the_convention_says() {
    let mut grasp = ring(0.04);
    grasp.contacts.pop();
    for name in Convention::NAMES {
        let convention = Convention::named(name).unwrap();
        let found = epsilon_quality(&grasp, &convention).unwrap();
        assert_eq!(found, convention.not_closed, "{name}");
    }
}

#[test]
fn torques_are_divided_by_the_stated_length() {
    let grasp = ring(0.04);
    let lengths = [
        ("paper", 0.01),
        ("graspit", 0.04),
        ("dexnet", 1e-3),
        ("frogger", 1.0),
        ("openrave", 1.0),
        ("unit", 1.0),
    ];
    for (name, length) in lengths {
        let convention = Convention::named(name).unwrap();
        let scaled = wrenches(&grasp.contacts, &grasp.centre, &convention).unwrap();
        let plain = Convention {
            torque_length: TorqueLength::Metres(1.0),
            ..convention
        };
        let plain = wrenches(&grasp.contacts, &grasp.centre, &plain).unwrap();
        for (w, v) in scaled.iter().zip(&plain) {
            let forces = (w.fixed_rows::<3>(0) - v.fixed_rows::<3>(0)).norm();
            let torques = (w.fixed_rows::<3>(3) * length - v.fixed_rows::<3>(3)).norm();
            assert!(forces <= 1e-15 && torques <= 1e-15, "{name}");
        }
    }
}
