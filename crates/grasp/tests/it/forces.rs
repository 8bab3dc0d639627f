//! Wrench resistance, least friction and the other linear-programme metrics.

use crate::common::{around, generator, in_ball, unit};
use grasp::{
    Contact, ContactModel, Edges, GraspModel, Resistance, Workspace, Wrench, closed_radius,
    epsilon, friction_needed, min_weight, resist, smallest_singular_value, wrench, wrenches,
};
use nalgebra::{Point3, Unit, Vector3};

fn opposite() -> [Contact; 2] {
    [1.0, -1.0].map(|s| Contact {
        position: Point3::new(s, 0.0, 0.0),
        inward_normal: Unit::new_normalize(Vector3::new(-s, 0.0, 0.0)),
    })
}

#[test]
fn two_fingers_hold_a_weight_by_friction() {
    let contacts = opposite();
    let centre = Point3::origin();
    let weight = Wrench::new(0.0, 0.0, -1.0, 0.0, 0.0, 0.0);
    for (edges, tolerance) in [
        (Edges::Polygon(8), 1e-9),
        (Edges::Round { tolerance: 1e-6 }, 1e-7),
    ] {
        let convention = unit(0.5, edges);
        let model = GraspModel {
            contacts: &contacts,
            centre: &centre,
            convention: &convention,
            contact_models: &[],
        };
        let Resistance::Holds {
            forces,
            largest_normal_force,
            bound,
            ..
        } = resist(&model, &weight).unwrap()
        else {
            panic!("friction holds it");
        };
        // Each carries half the weight, at friction 0.5 with a unit normal force.
        assert!((largest_normal_force - 1.0).abs() <= tolerance);
        assert!(bound <= largest_normal_force + 1e-12 && bound >= 1.0 - tolerance);
        let sum: Vector3<f64> = forces.iter().sum();
        assert!((sum - Vector3::z()).norm() <= 1e-9);
        // A torque about the line through both has nothing against it.
        let twist = Wrench::new(0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
        let Resistance::Fails { proof } = resist(&model, &twist).unwrap() else {
            panic!("points cannot hold a twist");
        };
        assert!(proof.dot(&twist) > 0.1);
        let soft = [ContactModel::Soft {
            friction: 0.5,
            torsion: 0.25,
        }; 2];
        let model = GraspModel {
            contact_models: &soft,
            ..model
        };
        let Resistance::Holds {
            largest_normal_force,
            torsions,
            ..
        } = resist(&model, &twist).unwrap()
        else {
            panic!("soft contact_models hold a twist");
        };
        assert!((largest_normal_force - 2.0).abs() <= tolerance);
        assert!((torsions[0].abs() - 0.5).abs() <= 1e-7);
    }
}

#[test]
fn closed_grasps_resist_every_wrench_within_their_cones() {
    let mut rng = generator(20);
    let mut workspace = Workspace::new();
    for index in 0..60 {
        let contacts = around(&mut rng, 3, 1.0);
        let edges = if index % 2 == 0 {
            Edges::Polygon(6)
        } else {
            Edges::Round { tolerance: 1e-6 }
        };
        let convention = unit(0.7, edges);
        let model = GraspModel {
            contacts: &contacts,
            centre: &Point3::origin(),
            convention: &convention,
            contact_models: &[],
        };
        let (a, b) = (in_ball(&mut rng), in_ball(&mut rng));
        let external = Wrench::new(a.x, a.y, a.z, b.x, b.y, b.z);
        let found = resist(&model, &external).unwrap();
        let quality = epsilon(&model, &mut workspace).unwrap();
        match found {
            Resistance::Holds {
                forces,
                largest_normal_force,
                ..
            } => {
                let total = contacts
                    .iter()
                    .zip(&forces)
                    .map(|(c, f)| wrench(f, &c.position, model.centre, 1.0))
                    .fold(external, |s, w| s + w);
                assert!(total.norm() <= 1e-8, "{total}");
                for (c, f) in contacts.iter().zip(&forces) {
                    let normal = f.dot(&c.inward_normal);
                    let slip = (f - c.inward_normal.into_inner() * normal).norm();
                    assert!(normal <= largest_normal_force + 1e-9);
                    assert!(slip <= 0.7 * normal + 1e-9);
                }
                // The ball of the hull of the union bounds the sum of normal forces.
                if quality.closed {
                    let most = external.norm() / quality.lower;
                    assert!(largest_normal_force <= most + 1e-9);
                }
            }
            Resistance::Fails { proof } => {
                assert!(!quality.closed);
                assert!(proof.dot(&external) > 0.0);
                if let Ok(list) = wrenches(&model) {
                    assert!(list.iter().all(|w| w.dot(&proof) >= -1e-8));
                }
            }
        }
    }
}

#[test]
fn friction_needed_splits_open_from_closed() {
    let mut rng = generator(21);
    let mut workspace = Workspace::new();
    let mut found_some = 0;
    for _ in 0..40 {
        let contacts = around(&mut rng, 3, 1.0);
        let convention = unit(1.0, Edges::Polygon(8));
        let model = GraspModel {
            contacts: &contacts,
            centre: &Point3::origin(),
            convention: &convention,
            contact_models: &[],
        };
        let needed = friction_needed(&model, 3.0, &mut workspace).unwrap();
        let Some(least) = needed.closure else {
            continue;
        };
        found_some += 1;
        for (factor, closed) in [(1.001, true), (0.999, false)] {
            let convention = unit(least * factor, Edges::Polygon(8));
            let model = GraspModel {
                convention: &convention,
                ..model
            };
            let found = epsilon(&model, &mut workspace).unwrap();
            assert_eq!(found.closed, closed, "{least}");
        }
    }
    assert!(found_some > 20);
}

#[test]
fn grasps_within_the_closed_radius_stay_closed() {
    let mut rng = generator(22);
    let mut workspace = Workspace::new();
    for _ in 0..40 {
        let contacts = around(&mut rng, 4, 1.0);
        let convention = unit(0.8, Edges::Round { tolerance: 1e-4 });
        let model = GraspModel {
            contacts: &contacts,
            centre: &Point3::origin(),
            convention: &convention,
            contact_models: &[],
        };
        let radius = closed_radius(&model, &mut workspace).unwrap().unwrap();
        if radius <= 0.0 {
            continue;
        }
        let moved: Vec<Contact> = contacts
            .iter()
            .map(|c| Contact {
                position: c.position + in_ball(&mut rng).normalize() * (0.99 * radius),
                ..*c
            })
            .collect();
        let model = GraspModel {
            contacts: &moved,
            ..model
        };
        assert!(epsilon(&model, &mut workspace).unwrap().closed);
    }
}

#[test]
fn symmetric_grasps_have_known_values() {
    let contacts: Vec<Contact> = (0..3)
        .map(|i| {
            let a = std::f64::consts::TAU * f64::from(i) / 3.0;
            let p = Vector3::new(a.cos(), a.sin(), 0.0);
            Contact {
                position: p.into(),
                inward_normal: Unit::new_normalize(-p),
            }
        })
        .collect();
    let centre = Point3::origin();
    let convention = unit(0.5, Edges::Polygon(8));
    let weight = min_weight(&GraspModel::new(&contacts, &centre, &convention))
        .unwrap()
        .unwrap();
    assert!((weight - 1.0).abs() <= 1e-9);
    let model = GraspModel {
        contacts: &contacts,
        centre: &centre,
        convention: &convention,
        contact_models: &[],
    };
    // G Gᵀ = diag(3, 3, 3, 3/2, 3/2, 3) for three points of the unit circle.
    let smallest = smallest_singular_value(&model).unwrap();
    assert!((smallest - 1.5_f64.sqrt()).abs() <= 1e-12);
    let pair = opposite();
    let model = GraspModel {
        contacts: &pair,
        ..model
    };
    assert!(smallest_singular_value(&model).unwrap() <= 1e-12);
}
