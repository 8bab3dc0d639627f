//! Gradients of the margin against central differences.

use crate::common::{anywhere, around, generator, in_ball, unit};
use grasp::{
    Contact, ContactModel, Convention, EdgeNorm, Edges, FrameRule, Gradient, GraspModel,
    TangentRule, TorqueLength, Workspace, facet_gradient, margin, near_active_facets,
};
use nalgebra::{Point3, Unit, Vector3};

const STEP: f64 = 1e-6;

struct Case {
    contacts: Vec<Contact>,
    centre: Point3<f64>,
    convention: Convention,
    contact_models: Vec<ContactModel>,
}

impl Case {
    fn model(&self) -> GraspModel<'_> {
        GraspModel {
            contacts: &self.contacts,
            centre: &self.centre,
            convention: &self.convention,
            contact_models: &self.contact_models,
        }
    }

    fn margin(&self) -> f64 {
        let found = margin(&self.model(), &mut Workspace::new()).unwrap();
        found.facet.offset
    }

    /// The derivative along a motion of every contact, every normal and the centre.
    fn difference(&self, motion: &Gradient) -> f64 {
        let at = |s: f64| {
            let mut contacts = self.contacts.clone();
            for (i, c) in contacts.iter_mut().enumerate() {
                c.position += motion.positions[i] * s;
                let n = c.inward_normal.into_inner() + motion.normals[i] * s;
                c.inward_normal = Unit::new_normalize(n);
            }
            Case {
                contacts,
                centre: self.centre + motion.centre * s,
                convention: self.convention.clone(),
                contact_models: self.contact_models.clone(),
            }
            .margin()
        };
        let wide = (at(2.0 * STEP) - at(-2.0 * STEP)) / (4.0 * STEP);
        let narrow = (at(STEP) - at(-STEP)) / (2.0 * STEP);
        (4.0 * narrow - wide) / 3.0
    }

    fn motion(&self, rng: &mut rand_chacha::ChaCha8Rng) -> Gradient {
        Gradient {
            positions: self.contacts.iter().map(|_| in_ball(rng)).collect(),
            normals: self
                .contacts
                .iter()
                .map(|c| {
                    let n = c.inward_normal.into_inner();
                    let v = in_ball(rng);
                    v - n * n.dot(&v)
                })
                .collect(),
            centre: in_ball(rng),
        }
    }
}

fn along(gradient: &Gradient, motion: &Gradient) -> f64 {
    let sum = |a: &[Vector3<f64>], b: &[Vector3<f64>]| -> f64 {
        a.iter().zip(b).map(|(x, y)| x.dot(y)).sum()
    };
    sum(&gradient.positions, &motion.positions)
        + sum(&gradient.normals, &motion.normals)
        + gradient.centre.dot(&motion.centre)
}

/// The next facet must be this much farther, or the differences step over a tie.
fn away_from_ties(case: &Case) -> bool {
    let mut facets = Vec::new();
    let mut workspace = Workspace::new();
    near_active_facets(&case.model(), 1e-4, &mut workspace, &mut facets).unwrap();
    facets.len() == 1
}

fn compare(case: &Case, rng: &mut rand_chacha::ChaCha8Rng, tolerance: f64) {
    let found = margin(&case.model(), &mut Workspace::new()).unwrap();
    let mut gradient = Gradient::default();
    facet_gradient(
        &case.model(),
        &found.facet,
        FrameRule::Tangent,
        &mut gradient,
    )
    .unwrap();
    for _ in 0..3 {
        let motion = case.motion(rng);
        let (exact, difference) = (along(&gradient, &motion), case.difference(&motion));
        let error = (exact - difference).abs() / exact.abs().max(1.0);
        assert!(error <= tolerance, "{exact} {difference}");
    }
}

#[test]
fn closed_polygons_of_every_kind() {
    let mut rng = generator(5);
    let mut compared = 0;
    for index in 0..400 {
        let count = 3 + index % 3;
        let mut convention = unit(0.8, Edges::Polygon(4 + index % 9));
        if index % 2 == 1 {
            convention.edge_norm = EdgeNorm::UnitLength;
        }
        if index % 7 == 3 {
            convention.tangent = TangentRule::Projected(Vector3::new(1.2, 2.3, 3.4));
        }
        if index % 5 == 1 {
            convention.torque_length = TorqueLength::MaxContactDistance;
        }
        let contact_models = if index % 3 == 2 {
            let mut all = vec![ContactModel::Point { friction: 0.6 }; count];
            all[0] = ContactModel::Soft {
                friction: 0.9,
                torsion: 0.2,
            };
            all[1] = ContactModel::Patch {
                friction: 0.7,
                radius: 0.15,
            };
            all
        } else {
            Vec::new()
        };
        let case = Case {
            contacts: around(&mut rng, count, 1.0),
            centre: Point3::from(in_ball(&mut rng) * 0.1),
            convention,
            contact_models,
        };
        let closed = margin(&case.model(), &mut Workspace::new()).unwrap().closed;
        if closed && away_from_ties(&case) {
            compare(&case, &mut rng, 1e-6);
            compared += 1;
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn round_cones_touch_at_one_exact_face() {
    let mut rng = generator(15);
    let mut compared = 0;
    for _ in 0..60 {
        let case = Case {
            contacts: around(&mut rng, 3, 1.0),
            centre: Point3::from(in_ball(&mut rng) * 0.1),
            convention: unit(0.8, Edges::Round { tolerance: 1e-4 }),
            contact_models: Vec::new(),
        };
        let found = margin(&case.model(), &mut Workspace::new()).unwrap();
        // One carrier a contact: the touching face, not a facet of the inner polytope.
        if !found.closed || found.facet.carriers().len() > 3 {
            continue;
        }
        let exact = Case {
            convention: unit(0.8, Edges::Round { tolerance: 1e-9 }),
            contacts: case.contacts.clone(),
            centre: case.centre,
            contact_models: Vec::new(),
        };
        let narrow = margin(&exact.model(), &mut Workspace::new()).unwrap();
        assert!(found.facet.offset <= narrow.upper + 1e-5);
        if (found.facet.offset - narrow.facet.offset).abs() <= 1e-10 {
            compare(&case, &mut rng, 1e-6);
            compared += 1;
        }
    }
    assert!(compared > 25, "{compared}");
}

#[test]
fn open_grasps_have_a_gradient_too() {
    let mut rng = generator(6);
    let mut compared = 0;
    while compared < 60 {
        let case = Case {
            contacts: anywhere(&mut rng, 3),
            centre: Point3::origin(),
            convention: unit(0.5, Edges::Polygon(8)),
            contact_models: Vec::new(),
        };
        let found = margin(&case.model(), &mut Workspace::new()).unwrap();
        // A carrier of hardly any weight means another face is about to take over.
        let firm = found.facet.carriers().iter().all(|c| c.weight > 1e-3);
        if !found.closed && found.value < -1e-2 && firm {
            compare(&case, &mut rng, 1e-5);
            compared += 1;
        }
    }
}

#[test]
fn carriers_add_up_to_the_foot_of_the_facet() {
    let mut rng = generator(7);
    let mut facets = Vec::new();
    for _ in 0..50 {
        let contacts = around(&mut rng, 3, 1.0);
        let convention = unit(1.0, Edges::Polygon(8));
        let model = GraspModel {
            contacts: &contacts,
            centre: &Point3::origin(),
            convention: &convention,
            contact_models: &[],
        };
        near_active_facets(&model, 0.05, &mut Workspace::new(), &mut facets).unwrap();
        for facet in &facets {
            let sum: f64 = facet.carriers().iter().map(|c| c.weight).sum();
            assert!((sum - 1.0).abs() <= 1e-9);
            let foot = facet
                .carriers()
                .iter()
                .fold(grasp::Wrench::zeros(), |s, c| s + c.wrench * c.weight);
            assert!((foot - facet.normal * facet.offset).norm() <= 1e-9);
            assert!(facet.offset >= facets[0].offset - 1e-12);
        }
    }
}
