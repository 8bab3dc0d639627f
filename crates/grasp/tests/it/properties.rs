//! Properties that quality has whatever the grasp.

use crate::common::{generator, in_ball, on_sphere, unit};
use grasp::hull::ConvexHull;
use grasp::{
    ActiveFacet, Contact, ContactModel, Convention, EdgeNorm, Edges, Epsilon, Grasp, GraspModel,
    TorqueLength, Workspace, distance, epsilon, epsilon_linf, force_closed, lipschitz_constant,
    margin, near_active_facets, wrenches,
};
use nalgebra::{Point3, Rotation3, Unit, Vector3};
use proptest::prelude::*;

fn quality(contacts: &[Contact], convention: &Convention) -> Epsilon {
    let centre = Point3::origin();
    epsilon(&model(contacts, &centre, convention), &mut Workspace::new()).unwrap()
}

fn round(friction: f64, tolerance: f64) -> Convention {
    unit(friction, Edges::Round { tolerance })
}

/// A vector of the unit ball, clear of its centre.
fn ball() -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-1.0..1.0)
        .prop_map(Vector3::from)
        .prop_filter("in the ball", |v| (1e-2..=1.0).contains(&v.norm()))
}

/// Contacts around an equator of radius `size` that press roughly inwards: mostly closed.
fn ring(count: std::ops::Range<usize>, size: f64) -> impl Strategy<Value = Vec<Contact>> {
    prop::collection::vec((ball(), ball()), count).prop_map(move |noise| {
        let count = noise.len() as f64;
        let contact = |(i, (place, tilt)): (usize, &(Vector3<f64>, Vector3<f64>))| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / count).sin_cos();
            let p = Vector3::new(cos, sin, 0.0) + place * 0.2;
            Contact {
                position: Point3::from(p * size),
                inward_normal: Unit::new_normalize(-p + tilt * 0.3),
            }
        };
        noise.iter().enumerate().map(contact).collect()
    })
}

/// Contacts in the ball of radius 2 with normals anywhere: mostly open.
fn strewn(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Contact>> {
    let contact = (ball(), ball()).prop_map(|(place, normal)| Contact {
        position: Point3::from(place * 2.0),
        inward_normal: Unit::new_normalize(normal),
    });
    prop::collection::vec(contact, count)
}

fn model<'a>(
    contacts: &'a [Contact],
    centre: &'a Point3<f64>,
    convention: &'a Convention,
) -> GraspModel<'a> {
    GraspModel::new(contacts, centre, convention)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn agrees_with_the_full_hull(
        contacts in prop_oneof![ring(2..6, 1.0), strewn(2..6)],
        edges in 3_usize..11,
    ) {
        let convention = unit(0.9, Edges::Polygon(edges));
        let list = wrenches(&model(&contacts, &Point3::origin(), &convention)).unwrap();
        let fast = quality(&contacts, &convention);
        let full = ConvexHull::new(&list).map_or(0.0, |hull| hull.ball_radius().max(0.0));
        prop_assert!((fast.quality - full).abs() <= 1e-10);
        let above = |w: &grasp::Wrench| w.dot(&fast.direction) <= fast.upper + 1e-12;
        prop_assert!(list.iter().all(above));
    }

    #[test]
    fn the_order_of_contacts_changes_no_bit(
        contacts in ring(4..5, 1.0),
        turn in 1_usize..4,
        polygon in any::<bool>(),
    ) {
        let convention = if polygon {
            unit(0.7, Edges::Polygon(8))
        } else {
            round(0.7, 1e-3)
        };
        let first = quality(&contacts, &convention);
        let mut contacts = contacts;
        contacts.rotate_left(turn);
        contacts.swap(0, 2);
        prop_assert_eq!(quality(&contacts, &convention), first);
    }

    #[test]
    fn translation_and_rotation_change_nothing(
        contacts in ring(3..4, 1.0),
        centre in ball(),
        axis in ball(),
        shift in ball(),
    ) {
        let centre = Point3::from(centre * 0.2);
        let convention = round(0.8, 1e-9);
        let rotation = Rotation3::from_scaled_axis(axis * 3.0);
        let shift = shift * 5.0;
        let moved: Vec<Contact> = contacts
            .iter()
            .map(|c| Contact {
                position: rotation * c.position + shift,
                inward_normal: rotation * c.inward_normal,
            })
            .collect();
        let mut workspace = Workspace::new();
        let a = epsilon(&model(&contacts, &centre, &convention), &mut workspace).unwrap();
        let to = rotation * centre + shift;
        let b = epsilon(&model(&moved, &to, &convention), &mut workspace).unwrap();
        prop_assert!(a.lower <= b.upper + 1e-12 && b.lower <= a.upper + 1e-12);
    }

    #[test]
    fn pyramids_enclose_the_round_cone(
        contacts in ring(3..5, 1.0),
        friction in 0.3..1.5_f64,
        edges in 3_usize..13,
    ) {
        let inner = quality(&contacts, &unit(friction, Edges::Polygon(edges)));
        let wide = friction / (std::f64::consts::PI / edges as f64).cos();
        let outer = quality(&contacts, &unit(wide, Edges::Polygon(edges)));
        let exact = quality(&contacts, &round(friction, 1e-6));
        // Nearly symmetric rings may end at the limits; they say so, and the interval holds.
        prop_assert!(exact.lower <= exact.upper);
        prop_assert!(!exact.converged || exact.upper - exact.lower <= 1e-6);
        prop_assert!(inner.lower <= exact.upper + 1e-12);
        prop_assert!(exact.lower <= outer.upper + 1e-12);
        let more = quality(&contacts, &round(friction * 1.1, 1e-6));
        prop_assert!(exact.lower <= more.upper + 1e-12);
    }

    #[test]
    fn closure_agrees_with_the_linear_programme(
        contacts in prop_oneof![ring(3..6, 1.0), strewn(3..6)],
        edges in 4_usize..9,
    ) {
        let convention = unit(1.0, Edges::Polygon(edges));
        let found = quality(&contacts, &convention);
        // Between these the two tests may differ.
        prop_assume!(!(found.quality > 0.0 && found.quality < 1e-7));
        let closed = force_closed(&model(&contacts, &Point3::origin(), &convention)).unwrap();
        prop_assert_eq!(closed, found.closed);
    }

    #[test]
    fn nearby_grasps_obey_the_lipschitz_bound(
        contacts in ring(3..4, 1.0),
        moves in prop::collection::vec((ball(), ball()), 3),
        power in 0_i32..4,
    ) {
        let size = 10.0_f64.powi(-power);
        let moved: Vec<Contact> = contacts
            .iter()
            .zip(&moves)
            .map(|(c, (place, tilt))| Contact {
                position: c.position + place * size,
                inward_normal: Unit::new_normalize(c.inward_normal.into_inner() + tilt * size),
            })
            .collect();
        let a = Grasp::new(contacts, Point3::origin()).unwrap();
        let b = Grasp::new(moved, Point3::origin()).unwrap();
        let convention = round(0.6, 1e-6);
        let from = model(&a.contacts, &a.centre, &convention);
        let to = model(&b.contacts, &b.centre, &convention);
        let constant = lipschitz_constant(&from).unwrap().unwrap();
        let bound = constant * distance(&a, &b).unwrap();
        let mut workspace = Workspace::new();
        let from = margin(&from, &mut workspace).unwrap();
        let to = margin(&to, &mut workspace).unwrap();
        let change = (from.lower - to.upper).max(to.lower - from.upper);
        prop_assert!(change <= bound + 1e-9, "{change} {bound}");
    }

    #[test]
    fn conventions_scale_as_they_say(contacts in ring(3..4, 0.04)) {
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
        let graspit = Convention::graspit();
        let difference = value(&contacts, &graspit) - value(&grown, &graspit);
        prop_assert!(difference.abs() <= 1e-12);
        // A fixed torque length grows with the object.
        let paper = Convention::paper();
        let longer = Convention {
            torque_length: TorqueLength::Metres(0.07),
            ..paper.clone()
        };
        let difference = value(&contacts, &paper) - value(&grown, &longer);
        prop_assert!(difference.abs() <= 1e-12);
        // Unit edges divide by √(1+μ²).
        let long = unit(0.9, Edges::Polygon(6));
        let short = Convention {
            edge_norm: EdgeNorm::UnitLength,
            ..long.clone()
        };
        let ratio = 0.9_f64.hypot(1.0);
        let difference = value(&contacts, &long) - ratio * value(&contacts, &short);
        prop_assert!(difference.abs() <= 1e-12);
    }

    #[test]
    fn near_facets_of_round_cones_support_them(contacts in ring(3..4, 1.0)) {
        let convention = round(0.9, 1e-2);
        let centre = Point3::origin();
        let grasp = model(&contacts, &centre, &convention);
        let mut facets: Vec<ActiveFacet> = Vec::new();
        let mut workspace = Workspace::new();
        near_active_facets(&grasp, 0.02, &mut workspace, &mut facets).unwrap();
        let found = quality(&contacts, &convention);
        prop_assert_eq!(facets.is_empty(), !found.closed);
        for (index, facet) in facets.iter().enumerate() {
            // The first touches the ball of the polytope, the others are within the band. The polytope is
            // within the convention's tolerance of the cones; the proved lower end may be nearer.
            prop_assert!(facet.offset >= found.lower - 1e-2 - 1e-9);
            prop_assert!(facet.offset <= found.upper + 0.02 + 1e-9);
            prop_assert!(index > 0 || facet.offset <= found.upper + 1e-9);
            let foot: grasp::Wrench = facet.carriers().iter().map(|c| c.wrench * c.weight).sum();
            prop_assert!((foot - facet.normal * facet.offset).norm() <= 1e-6);
            // Every carrier lies on the plane, and of the others no point of a cone rises above it by
            // more than the convention's tolerance.
            for carrier in facet.carriers() {
                prop_assert!((carrier.wrench.dot(&facet.normal) - facet.offset).abs() <= 1e-6);
            }
            let highest = contacts
                .iter()
                .map(|c| support(c, &facet.normal, 0.9))
                .fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(highest >= facet.offset - 1e-9);
            // The first one's plane bounds the interval from below; the others are finished.
            prop_assert!(index == 0 || highest <= facet.offset + 1e-2 + 1e-9, "{highest} {}", facet.offset);
        }
    }

    #[test]
    fn sums_of_cones_hold_the_hull_of_their_union(
        contacts in ring(3..4, 1.0),
        polygon in any::<bool>(),
    ) {
        let convention = if polygon {
            unit(0.8, Edges::Polygon(6))
        } else {
            round(0.8, 1e-3)
        };
        let centre = Point3::origin();
        let model = model(&contacts, &centre, &convention);
        let sum = epsilon_linf(&model, &mut Workspace::new()).unwrap();
        let union = epsilon(&model, &mut Workspace::new()).unwrap();
        prop_assert!(sum.upper >= union.lower - 1e-12);
        prop_assert!(sum.lower <= 3.0 * union.upper + 1e-12);
    }
}

/// The height of a round cone along a wrench direction (a, b): g·n + μ |g − n (g·n)| with
/// g = a + b × c.
fn support(contact: &Contact, direction: &grasp::Wrench, friction: f64) -> f64 {
    let part = |at: usize| Vector3::new(direction[at], direction[at + 1], direction[at + 2]);
    let g = part(0) + part(3).cross(&contact.position.coords);
    let n = contact.inward_normal.into_inner();
    g.dot(&n) + friction * (g - n * g.dot(&n)).norm()
}

fn ring_of_three() -> Vec<Contact> {
    (0..3)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 3.0).sin_cos();
            let p = Vector3::new(cos, sin, 0.0);
            Contact {
                position: p.into(),
                inward_normal: Unit::new_normalize(-p),
            }
        })
        .collect()
}

#[test]
fn the_symmetric_grasp_has_its_known_quality() {
    // Three contacts on the unit circle, pyramids that begin along the axis of the circle.
    let convention = Convention {
        tangent: grasp::TangentRule::Projected(Vector3::z()),
        ..unit(1.0, Edges::Polygon(10))
    };
    let found = quality(&ring_of_three(), &convention);
    assert!((found.quality - 0.558403).abs() <= 1e-6);
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
        let mut closed = |contact_models: &[ContactModel]| {
            let model = GraspModel {
                contacts: &contacts,
                centre: &centre,
                convention: &convention,
                contact_models,
            };
            epsilon(&model, &mut workspace).unwrap().closed
        };
        let hard = ContactModel::Point { friction: 0.5 };
        let soft = ContactModel::Soft {
            friction: 0.5,
            torsion: 0.1,
        };
        assert!(!closed(&[]));
        assert!(!closed(&[hard, hard]));
        assert!(closed(&[soft, soft]));
        assert!(closed(&[hard, soft]));
        assert!(!closed(&[ContactModel::Frictionless, soft]));
    }
}

#[test]
fn seven_frictionless_contacts_can_close() {
    let mut rng = generator(12);
    let convention = unit(0.5, Edges::Polygon(8));
    let contact_models = [ContactModel::Frictionless; 12];
    let mut closed = 0;
    for _ in 0..200 {
        let contacts: Vec<Contact> = (0..12)
            .map(|_| Contact {
                position: Point3::from(in_ball(&mut rng)),
                inward_normal: on_sphere(&mut rng),
            })
            .collect();
        let model = GraspModel {
            contacts: &contacts,
            centre: &Point3::origin(),
            convention: &convention,
            contact_models: &contact_models,
        };
        closed += u32::from(epsilon(&model, &mut Workspace::new()).unwrap().closed);
    }
    assert!(closed > 20 && closed < 180, "{closed}");
}
