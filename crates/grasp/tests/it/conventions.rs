//! Conventions print what the systems they are named after print.

use grasp::{
    Contact, Convention, Edges, Grasp, TangentRule, TorqueLength, Workspace, epsilon, wrenches,
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

/// The number that the convention prints for a grasp.
fn printed(grasp: &Grasp, convention: &Convention) -> f64 {
    let found = epsilon(&grasp.under(convention), &mut Workspace::new()).unwrap();
    found.value(convention)
}

#[test]
fn frogger_with_its_own_tangents() {
    // Printed by its metric for the unit circle, torque in metres.
    let values = [
        (0.5, 8, 0.238780),
        (1.0, 8, 0.385914),
        (1.0, 10, 0.392311),
        (0.7, 4, 0.254964),
    ];
    for (friction, edges, value) in values {
        let convention = Convention {
            friction,
            edges: Edges::Polygon(edges),
            tangent: TangentRule::Projected(Vector3::new(1.2, 2.3, 3.4)),
            ..Convention::frogger()
        };
        let found = printed(&ring(1.0), &convention);
        assert!((found - value).abs() <= 5e-7, "{found} {value}");
    }
}

#[test]
fn dexnet_on_a_ring_of_a_millimetre() {
    // In its unit of torque that is the unit circle; along z, the third axis is least aligned.
    let convention = Convention::dexnet();
    let found = printed(&ring(1e-3), &convention);
    assert!((found - 0.275925).abs() <= 5e-7, "{found}");
}

#[test]
fn graspit_does_not_ask_for_the_size() {
    let convention = Convention {
        friction: 0.5,
        ..Convention::graspit()
    };
    for radius in [1e-3, 0.04, 10.0] {
        let found = printed(&ring(radius), &convention);
        assert!((found - 0.275925).abs() <= 5e-7, "{found}");
    }
}

#[test]
fn openrave_has_unit_edges() {
    let convention = Convention {
        friction: 0.5,
        ..Convention::openrave()
    };
    let found = printed(&ring(1.0), &convention);
    assert!((found - 0.246795).abs() <= 5e-7, "{found}");
}

#[test]
fn open_grasps_print_what_the_convention_says() {
    let mut grasp = ring(0.04);
    grasp.contacts.pop();
    for name in Convention::NAMES {
        let convention = Convention::named(name).unwrap();
        let found = printed(&grasp, &convention);
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
        let scaled = wrenches(&grasp.under(&convention)).unwrap();
        let plain = Convention {
            torque_length: TorqueLength::Metres(1.0),
            ..convention
        };
        let plain = wrenches(&grasp.under(&plain)).unwrap();
        for (w, v) in scaled.iter().zip(&plain) {
            let forces = (w.fixed_rows::<3>(0) - v.fixed_rows::<3>(0)).norm();
            let torques = (w.fixed_rows::<3>(3) * length - v.fixed_rows::<3>(3)).norm();
            assert!(forces <= 1e-15 && torques <= 1e-15, "{name}");
        }
    }
}
