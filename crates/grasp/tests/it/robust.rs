//! Robust quality is a lower bound on every surface of its class, and contacts may have a size.

use grasp::{
    Contact, ContactModel, Convention, EdgeNorm, Edges, GraspModel, TorqueLength, Uncertainty,
    Workspace, epsilon, robust_quality, wrenches,
};
use nalgebra::{Point3, Rotation3, Unit, UnitVector3, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::common::{around, generator, in_ball, on_sphere, unit};

/// A normal at the angle `angle` from `normal`, in a random direction.
fn tilted(rng: &mut ChaCha8Rng, normal: &UnitVector3<f64>, angle: f64) -> UnitVector3<f64> {
    let side = normal.cross(&on_sphere(rng));
    match Unit::try_new(side, 1e-9) {
        Some(axis) => Rotation3::from_axis_angle(&axis, angle) * normal,
        None => *normal,
    }
}

/// Another surface of the class: most contacts as far off as they may be.
fn surface(rng: &mut ChaCha8Rng, contacts: &[Contact], known: &[Uncertainty]) -> Vec<Contact> {
    let share = |rng: &mut ChaCha8Rng| {
        if rng.random_bool(0.7) {
            1.0
        } else {
            rng.random_range(0.0..1.0)
        }
    };
    contacts
        .iter()
        .zip(known)
        .map(|(c, u)| {
            let (far, angle) = (u.position * share(rng), u.normal * share(rng));
            Contact {
                position: c.position + on_sphere(rng).into_inner() * far,
                inward_normal: tilted(rng, &c.inward_normal, angle),
            }
        })
        .collect()
}

#[test]
fn no_surface_of_the_class_is_worse() {
    let mut rng = generator(40);
    let mut workspace = Workspace::new();
    let mut positive = 0;
    let mut least = f64::INFINITY;
    for index in 0..60 {
        let count = 3 + index % 3;
        let contacts = around(&mut rng, count, 1.0);
        let friction = rng.random_range(0.4..1.2);
        let soft = vec![
            ContactModel::Soft {
                friction,
                torsion: 0.3
            };
            count
        ];
        let patches = vec![
            ContactModel::Patch {
                friction,
                radius: 0.2
            };
            count
        ];
        let models: &[ContactModel] = match index % 4 {
            0 | 1 => &[],
            2 => &soft,
            _ => &patches,
        };
        let convention = Convention {
            edge_norm: if index % 2 == 0 {
                EdgeNorm::UnitLength
            } else {
                EdgeNorm::UnitNormalComponent
            },
            torque_length: if index % 5 == 0 {
                TorqueLength::MaxContactDistance
            } else {
                TorqueLength::Metres(1.0)
            },
            ..unit(
                friction,
                if index % 3 == 0 {
                    Edges::Round { tolerance: 1e-5 }
                } else {
                    Edges::Polygon(8)
                },
            )
        };
        let known: Vec<Uncertainty> = contacts
            .iter()
            .map(|_| Uncertainty {
                position: rng.random_range(0.0..0.02),
                normal: rng.random_range(0.0..0.12),
            })
            .collect();
        let centre = Point3::origin();
        let model = GraspModel::new(&contacts, &centre, &convention).with_contact_models(models);
        let bound = robust_quality(&model, &known, &mut workspace).unwrap();
        positive += u32::from(bound > 0.0);
        let nominal = epsilon(&model, &mut workspace).unwrap();
        assert!(bound <= nominal.upper + 1e-12);
        for _ in 0..60 {
            let other = surface(&mut rng, &contacts, &known);
            let other = GraspModel::new(&other, &centre, &convention).with_contact_models(models);
            let found = epsilon(&other, &mut workspace).unwrap();
            assert!(bound <= found.upper + 1e-12, "{index}: {bound} {found:?}");
            if bound > 0.0 {
                least = least.min(found.upper - bound);
            }
        }
    }
    assert!(positive >= 20, "{positive}");
    // The bound is no idle one: some surface comes near it.
    assert!(least <= 0.05, "{least}");
}

#[test]
fn without_uncertainty_the_bound_is_the_round_quality() {
    let mut rng = generator(41);
    let mut workspace = Workspace::new();
    let contacts = around(&mut rng, 4, 1.0);
    let convention = unit(0.8, Edges::Round { tolerance: 1e-6 });
    let centre = Point3::origin();
    let model = GraspModel::new(&contacts, &centre, &convention);
    let exact = [Uncertainty::default(); 4];
    let bound = robust_quality(&model, &exact, &mut workspace).unwrap();
    let found = epsilon(&model, &mut workspace).unwrap();
    assert!(
        (bound - found.quality).abs() <= 1e-4,
        "{bound} {}",
        found.quality
    );
    // Normals as uncertain as the cones are wide: nothing is certain.
    let edge = [Uncertainty {
        position: 0.0,
        normal: 0.8_f64.atan(),
    }; 4];
    assert_eq!(robust_quality(&model, &edge, &mut workspace), Ok(0.0));
    let short = robust_quality(&model, &exact[..3], &mut workspace).unwrap_err();
    assert!(short.to_string().contains("4 contacts but 3 uncertainties"));
    let bad = [Uncertainty {
        position: -1.0,
        normal: 0.0,
    }; 4];
    let bad = robust_quality(&model, &bad, &mut workspace).unwrap_err();
    assert!(bad.to_string().contains("contact 0"));
}

fn opposite() -> [Contact; 2] {
    [1.0, -1.0].map(|s| Contact {
        position: Point3::new(0.03 * s, 0.0, 0.0),
        inward_normal: Unit::new_unchecked(Vector3::new(-s, 0.0, 0.0)),
    })
}

#[test]
fn two_contacts_with_a_size_close_a_grasp() {
    let contacts = opposite();
    let centre = Point3::origin();
    let mut workspace = Workspace::new();
    for edges in [Edges::Polygon(8), Edges::Round { tolerance: 1e-4 }] {
        let convention = Convention {
            torque_length: TorqueLength::Metres(0.03),
            ..unit(0.5, edges)
        };
        let mut quality = |model: ContactModel| {
            let models = [model; 2];
            let model = GraspModel::new(&contacts, &centre, &convention);
            let found = epsilon(&model.with_contact_models(&models), &mut workspace).unwrap();
            assert!(found.converged);
            (found.closed, found.quality)
        };
        assert!(!quality(ContactModel::Point { friction: 0.5 }).0);
        let soft = quality(ContactModel::soft_disc(0.5, 0.01));
        let patch = quality(ContactModel::Patch {
            friction: 0.5,
            radius: 0.01,
        });
        assert!(soft.0 && patch.0);
        // The torsion about the axis is the weakest: 2/3 μ r against μ r of the corners. The inscribed
        // polytope of a soft contact falls a little short of its ellipsoid.
        let torsion = 2.0 / 3.0 * 0.5 * 0.01 / 0.03;
        assert!(
            (0.95 * torsion..=torsion + 1e-4).contains(&soft.1),
            "{}",
            soft.1
        );
        assert!(patch.1 >= soft.1, "{} {}", patch.1, soft.1);
    }
}

#[test]
fn a_patch_is_its_corners() {
    let mut rng = generator(42);
    let mut workspace = Workspace::new();
    for edges in [Edges::Polygon(6), Edges::Round { tolerance: 1e-5 }] {
        let contacts = around(&mut rng, 3, 1.0);
        let convention = unit(0.7, edges);
        let centre = Point3::from(in_ball(&mut rng) * 0.1);
        let models = [ContactModel::Patch {
            friction: 0.7,
            radius: 0.1,
        }; 3];
        let patch = GraspModel::new(&contacts, &centre, &convention).with_contact_models(&models);
        let corners: Vec<Contact> = contacts
            .iter()
            .flat_map(|c| {
                let t = convention.tangent.tangent(&c.inward_normal).into_inner();
                let b = c.inward_normal.cross(&t);
                [t, b, -t, -b].map(|d| Contact {
                    position: c.position + d * 0.1,
                    ..*c
                })
            })
            .collect();
        let points = GraspModel::new(&corners, &centre, &convention);
        let (a, b) = (
            epsilon(&patch, &mut workspace).unwrap(),
            epsilon(&points, &mut workspace).unwrap(),
        );
        assert!((a.quality - b.quality).abs() <= 1e-5, "{a:?} {b:?}");
        if let (Ok(a), Ok(b)) = (wrenches(&patch), wrenches(&points)) {
            assert_eq!(a.len(), b.len());
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).norm() <= 1e-14));
        }
    }
}
