//! Round cones on structured grasps: rings, boxes, cylinders, balls, repeated, antipodal, collinear and
//! coplanar contacts, and random ones, two to twelve, a third of them exact and the others disturbed by
//! 1e-16 … 1e-3.
//!
//! The grasps are those of the tests of `grasp`. Every measurement is the total time of a set of grasps:
//! read it as microseconds per 100 grasps.

#[path = "../../crates/grasp/tests/it/common/mod.rs"]
mod common;
#[path = "../../crates/grasp/tests/it/families.rs"]
#[allow(dead_code, reason = "the tests use more of it")]
mod families;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use grasp::{
    Contact, Convention, Edges, GraspModel, TorqueLength, Uncertainty, Workspace, epsilon,
    friction_needed, robust_quality,
};
use nalgebra::Point3;
use rand::RngExt;

use self::common::generator;
use self::families::{FAMILIES, disturbed};

const GRASPS: usize = 100;

/// Grasps of a family with usual friction and torque lengths.
fn grasps(name: &str) -> Vec<(Vec<Contact>, Convention)> {
    let mut rng = generator(1);
    (0..GRASPS)
        .map(|_| {
            let count = rng.random_range(2..13_usize).min(rng.random_range(2..13));
            let contacts = disturbed(&mut rng, name, count);
            let convention = Convention {
                friction: [0.3, 0.5, 1.0, 2.0][rng.random_range(0..4)],
                torque_length: TorqueLength::Metres([0.01, 0.05, 1.0][rng.random_range(0..3)]),
                ..Convention::unit()
            };
            (contacts, convention)
        })
        .collect()
}

fn measure(
    c: &mut Criterion,
    name: &str,
    grasps: &[(Vec<Contact>, Convention)],
    edges: Edges,
    mut one: impl FnMut(&GraspModel<'_>, &mut Workspace),
) {
    let centre = Point3::origin();
    let mut workspace = Workspace::new();
    let rules: Vec<Convention> = grasps
        .iter()
        .map(|(_, rule)| Convention {
            edges,
            ..rule.clone()
        })
        .collect();
    c.bench_function(name, |b| {
        b.iter(|| {
            for ((contacts, _), rule) in grasps.iter().zip(&rules) {
                one(&GraspModel::new(contacts, &centre, rule), &mut workspace);
            }
        });
    });
}

fn families(c: &mut Criterion) {
    let round = |tolerance| Edges::Round { tolerance };
    let quality = |model: &GraspModel<'_>, workspace: &mut Workspace| {
        black_box(epsilon(model, workspace).is_ok());
    };
    for name in FAMILIES {
        let grasps = grasps(name);
        let title = |what: &str| format!("families/{name} {what}, 100 grasps");
        measure(c, &title("round 1e-4"), &grasps, round(1e-4), quality);
        measure(c, &title("round 1e-8"), &grasps, round(1e-8), quality);
        measure(c, &title("8 edges"), &grasps, Edges::Polygon(8), quality);
        measure(c, &title("robust"), &grasps, round(1e-4), |model, work| {
            let known = Uncertainty {
                position: 3e-4,
                normal: 0.1,
            };
            let known = vec![known; model.contacts.len()];
            black_box(robust_quality(model, &known, work).is_ok());
        });
        measure(
            c,
            &title("friction needed"),
            &grasps,
            round(1e-4),
            |model, work| {
                black_box(friction_needed(model, 100.0, work).is_ok());
            },
        );
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = families
}
criterion_main!(benches);
