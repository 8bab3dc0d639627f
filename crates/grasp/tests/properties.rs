//! Properties that quality has whatever the grasp.

mod common;

use common::{anywhere, around, generator, in_ball, on_sphere, unit};
use grasp::hull::ConvexHull;
use grasp::{
    Contact, Convention, EdgeNorm, Edges, Epsilon, Finger, Grasp, Setup, TorqueLength, Workspace,
    distance, epsilon, epsilon_linf, epsilon_of, force_closed, lipschitz_constant, margin,
    wrenches,
};
use nalgebra::{Point3, Rotation3, Unit, Vector3};

fn quality(contacts: &[Contact], convention: &Convention) -> Epsilon {
    epsilon(
        contacts,
        &Point3::origin(),
        convention,
        &mut Workspace::new(),
    )
    .unwrap()
}

fn round(friction: f64, tolerance: f64) -> Convention {
    unit(friction, Edges::Round { tolerance })
}

#[test]
fn agrees_with_the_full_hull() {
    let mut rng = generator(1);
    for index in 0..300 {
        let count = 2 + index % 4;
        let contacts = if index % 2 == 0 {
            around(&mut rng, count, 1.0)
        } else {
            anywhere(&mut rng, count)
        };
        let convention = unit(0.9, Edges::Polygon(3 + index % 8));
        let list = wrenches(&contacts, &Point3::origin(), &convention).unwrap();
        let fast = quality(&contacts, &convention);
        let full = ConvexHull::new(&list).map_or(0.0, |hull| hull.ball_radius().max(0.0));
        assert!((fast.quality - full).abs() <= 1e-10, "{index}");
        let above = |w: &grasp::Wrench| w.dot(&fast.direction) <= fast.upper + 1e-12;
        assert!(list.iter().all(above));
    }
}

#[test]
fn the_order_of_contacts_changes_no_bit() {
    let mut rng = generator(2);
    for index in 0..100 {
        let mut contacts = around(&mut rng, 4, 1.0);
        let convention = if index % 2 == 0 {
            unit(0.7, Edges::Polygon(8))
        } else {
            round(0.7, 1e-3)
        };
        let first = quality(&contacts, &convention);
        contacts.rotate_left(1 + index % 3);
        contacts.swap(0, 2);
        assert_eq!(quality(&contacts, &convention), first);
    }
}

#[test]
fn translation_and_rotation_change_nothing() {
    let mut rng = generator(3);
    for _ in 0..60 {
        let contacts = around(&mut rng, 3, 1.0);
        let centre = Point3::from(in_ball(&mut rng) * 0.2);
        let convention = round(0.8, 1e-9);
        let rotation = Rotation3::from_scaled_axis(in_ball(&mut rng) * 3.0);
        let shift = in_ball(&mut rng) * 5.0;
        let moved: Vec<Contact> = contacts
            .iter()
            .map(|c| Contact {
                position: rotation * c.position + shift,
                inward_normal: rotation * c.inward_normal,
            })
            .collect();
        let mut workspace = Workspace::new();
        let a = epsilon(&contacts, &centre, &convention, &mut workspace).unwrap();
        let to = rotation * centre + shift;
        let b = epsilon(&moved, &to, &convention, &mut workspace).unwrap();
        assert!(a.lower <= b.upper + 1e-12 && b.lower <= a.upper + 1e-12);
    }
}

#[test]
fn pyramids_enclose_the_round_cone() {
    let mut rng = generator(4);
    for index in 0..120 {
        let contacts = around(&mut rng, 3 + index % 2, 1.0);
        let (friction, edges) = (0.3 + 0.01 * index as f64, 3 + index % 10);
        let inner = quality(&contacts, &unit(friction, Edges::Polygon(edges)));
        let wide = friction / (std::f64::consts::PI / edges as f64).cos();
        let outer = quality(&contacts, &unit(wide, Edges::Polygon(edges)));
        let exact = quality(&contacts, &round(friction, 1e-6));
        assert!(exact.lower <= exact.upper && exact.upper - exact.lower <= 1e-6);
        assert!(inner.lower <= exact.upper + 1e-12);
        assert!(exact.lower <= outer.upper + 1e-12);
        let more = quality(&contacts, &round(friction * 1.1, 1e-6));
        assert!(exact.lower <= more.upper + 1e-12);
    }
}

#[test]
fn closure_agrees_with_the_linear_programme() {
    let mut rng = generator(8);
    let mut both = [0, 0];
    for index in 0..600 {
        let contacts = anywhere(&mut rng, 3 + index % 3);
        let convention = unit(1.0, Edges::Polygon(4 + index % 5));
        let found = quality(&contacts, &convention);
        // Between these the two tests may differ.
        if found.quality > 0.0 && found.quality < 1e-7 {
            continue;
        }
        let closed = force_closed(&contacts, &Point3::origin(), &convention).unwrap();
        assert_eq!(closed, found.closed, "{index}");
        both[usize::from(closed)] += 1;
    }
    assert!(both[0] > 50 && both[1] > 50, "{both:?}");
}

#[test]
fn nearby_grasps_obey_the_lipschitz_bound() {
    let mut rng = generator(9);
    for index in 0..200 {
        let contacts = around(&mut rng, 3, 1.0);
        let size = 10.0_f64.powi(-(index % 4));
        let moved: Vec<Contact> = contacts
            .iter()
            .map(|c| Contact {
                position: c.position + in_ball(&mut rng) * size,
                inward_normal: Unit::new_normalize(
                    c.inward_normal.into_inner() + in_ball(&mut rng) * size,
                ),
            })
            .collect();
        let a = Grasp::new(contacts, Point3::origin()).unwrap();
        let b = Grasp::new(moved, Point3::origin()).unwrap();
        let convention = round(0.6, 1e-6);
        let setup = Setup {
            contacts: &a.contacts,
            centre: &a.centre,
            convention: &convention,
            fingers: &[],
        };
        let constant = lipschitz_constant(&setup).unwrap().unwrap();
        let bound = constant * distance(&a, &b).unwrap();
        let mut workspace = Workspace::new();
        let from = margin(&setup, &mut workspace).unwrap();
        let to = margin(
            &Setup {
                contacts: &b.contacts,
                ..setup
            },
            &mut workspace,
        )
        .unwrap();
        let change = (from.lower - to.upper).max(to.lower - from.upper);
        assert!(change <= bound + 1e-9, "{change} {bound}");
    }
}

#[test]
fn conventions_scale_as_they_say() {
    let mut rng = generator(10);
    for _ in 0..40 {
        let contacts = around(&mut rng, 3, 0.04);
        let grown: Vec<Contact> = contacts
            .iter()
            .map(|c| Contact {
                position: c.position * 7.0,
                ..*c
            })
            .collect();
        let value = |contacts: &[Contact], convention: &Convention| {
            quality(contacts, convention).value(convention)
        };
        // Torque over the size of the grasp: the size does not matter.
        let graspit = Convention::named("graspit").unwrap();
        let difference = value(&contacts, &graspit) - value(&grown, &graspit);
        assert!(difference.abs() <= 1e-12);
        // A fixed torque length grows with the object.
        let paper = Convention::named("paper").unwrap();
        let longer = Convention {
            torque_length: TorqueLength::Metres(0.07),
            ..paper.clone()
        };
        let difference = value(&contacts, &paper) - value(&grown, &longer);
        assert!(difference.abs() <= 1e-12);
        // Unit edges divide by √(1+μ²).
        let long = unit(0.9, Edges::Polygon(6));
        let short = Convention {
            edge_norm: EdgeNorm::UnitLength,
            ..long.clone()
        };
        let ratio = 0.9_f64.hypot(1.0);
        let difference = value(&contacts, &long) - ratio * value(&contacts, &short);
        assert!(difference.abs() <= 1e-12);
    }
}

#[test]
fn exactly_symmetric_grasps_continue_nearby_ones() {
    let mut rng = generator(11);
    for count in 3..7 {
        let exact: Vec<Contact> = (0..count)
            .map(|i| {
                let a = std::f64::consts::TAU * f64::from(i) / f64::from(count);
                let p = Vector3::new(a.cos(), a.sin(), 0.0);
                Contact {
                    position: p.into(),
                    inward_normal: Unit::new_normalize(-p),
                }
            })
            .collect();
        let convention = unit(0.8, Edges::Polygon(8));
        let value = quality(&exact, &convention).quality;
        assert!(value > 0.1);
        for power in 2..16 {
            let noise = 10.0_f64.powi(-power);
            let near: Vec<Contact> = exact
                .iter()
                .map(|c| Contact {
                    position: c.position + in_ball(&mut rng) * noise,
                    ..*c
                })
                .collect();
            let found = quality(&near, &convention);
            assert!(
                (found.quality - value).abs() <= 3.0 * noise + 1e-9,
                "{noise}"
            );
            assert!(found.upper - found.lower <= 1e-9);
        }
        let mut repeated = exact.clone();
        repeated.extend_from_slice(&exact);
        let found = quality(&repeated, &convention).quality;
        assert!((found - value).abs() <= 1e-11);
    }
}

#[test]
fn soft_fingers_close_with_two_contacts() {
    let contacts = [1.0, -1.0].map(|s| Contact {
        position: Point3::new(s, 0.0, 0.0),
        inward_normal: Unit::new_normalize(Vector3::new(-s, 0.0, 0.0)),
    });
    let centre = Point3::origin();
    for edges in [Edges::Polygon(8), Edges::Round { tolerance: 1e-4 }] {
        let convention = unit(0.5, edges);
        let mut workspace = Workspace::new();
        let mut closed = |fingers: &[Finger]| {
            let setup = Setup {
                contacts: &contacts,
                centre: &centre,
                convention: &convention,
                fingers,
            };
            epsilon_of(&setup, &mut workspace).unwrap().closed
        };
        let hard = Finger::Hard { friction: 0.5 };
        let soft = Finger::Soft {
            friction: 0.5,
            torsion: 0.1,
        };
        assert!(!closed(&[]));
        assert!(!closed(&[hard, hard]));
        assert!(closed(&[soft, soft]));
        assert!(closed(&[hard, soft]));
        assert!(!closed(&[Finger::Frictionless, soft]));
    }
}

#[test]
fn seven_frictionless_contacts_can_close() {
    let mut rng = generator(12);
    let convention = unit(0.5, Edges::Polygon(8));
    let fingers = [Finger::Frictionless; 12];
    let mut closed = 0;
    for _ in 0..200 {
        let contacts: Vec<Contact> = (0..12)
            .map(|_| Contact {
                position: Point3::from(in_ball(&mut rng)),
                inward_normal: on_sphere(&mut rng),
            })
            .collect();
        let setup = Setup {
            contacts: &contacts,
            centre: &Point3::origin(),
            convention: &convention,
            fingers: &fingers,
        };
        closed += u32::from(epsilon_of(&setup, &mut Workspace::new()).unwrap().closed);
    }
    assert!(closed > 20 && closed < 180, "{closed}");
}

#[test]
fn sums_of_cones_hold_the_hull_of_their_union() {
    let mut rng = generator(13);
    for index in 0..40 {
        let contacts = around(&mut rng, 3, 1.0);
        let convention = if index % 2 == 0 {
            unit(0.8, Edges::Polygon(6))
        } else {
            round(0.8, 1e-3)
        };
        let setup = Setup {
            contacts: &contacts,
            centre: &Point3::origin(),
            convention: &convention,
            fingers: &[],
        };
        let sum = epsilon_linf(&setup, &mut Workspace::new()).unwrap();
        let union = epsilon_of(&setup, &mut Workspace::new()).unwrap();
        assert!(sum.upper >= union.lower - 1e-12);
        assert!(sum.lower <= 3.0 * union.upper + 1e-12);
    }
}
