//! Grasp quality: from contacts to wrenches to the largest ball, for closed and random grasps.
//!
//! Random grasps have contacts uniform in the ball of radius 2, inward normals uniform on the
//! sphere and the centre at the origin. Every measurement is the total time of a set of grasps:
//! read it as microseconds per 100 grasps.

use criterion::{Criterion, criterion_group, criterion_main};
use grasp::{
    ActiveFacet, Contact, Convention, Edges, FrameRule, Gradient, GraspModel, Workspace, epsilon,
    epsilon_linf, facet_gradient, margin, near_active_facets, volume,
};
use nalgebra::{Point3, Unit, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::hint::black_box;

const GRASPS: usize = 100;

fn in_ball(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        if v.norm_squared() <= 1.0 && v.norm_squared() > 1e-6 {
            return v;
        }
    }
}

fn random_grasp(rng: &mut ChaCha8Rng) -> Vec<Contact> {
    (0..3)
        .map(|_| Contact {
            position: Point3::from(in_ball(rng) * 2.0),
            inward_normal: Unit::new_normalize(in_ball(rng)),
        })
        .collect()
}

fn convention(edges: Edges) -> Convention {
    Convention {
        edges,
        ..Convention::unit()
    }
}

/// Random grasps; with `closed`, only those that are closed with eight edges.
fn grasps(closed: bool) -> Vec<Vec<Contact>> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let eight = convention(Edges::Polygon(8));
    let centre = Point3::origin();
    let mut workspace = Workspace::new();
    let mut out = Vec::new();
    while out.len() < GRASPS {
        let contacts = random_grasp(&mut rng);
        let model = GraspModel::new(&contacts, &centre, &eight);
        let found = epsilon(&model, &mut workspace);
        if !closed || found.is_ok_and(|e| e.closed) {
            out.push(contacts);
        }
    }
    out
}

fn quality(c: &mut Criterion, name: &str, grasps: &[Vec<Contact>], edges: Edges) {
    let convention = convention(edges);
    let centre = Point3::origin();
    let mut workspace = Workspace::new();
    c.bench_function(name, |b| {
        b.iter(|| {
            for contacts in grasps {
                let model = GraspModel::new(contacts, &centre, &convention);
                black_box(epsilon(&model, &mut workspace).is_ok());
            }
        });
    });
}

fn epsilons(c: &mut Criterion) {
    let closed = grasps(true);
    let random = grasps(false);
    for edges in [4, 8, 10, 16] {
        let name = format!("grasp/epsilon closed 3x{edges}, 100 grasps");
        quality(c, &name, &closed, Edges::Polygon(edges));
    }
    let name = "grasp/epsilon random 3x8, 100 grasps";
    quality(c, name, &random, Edges::Polygon(8));
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-6, 1e-9] {
        let name = format!("grasp/epsilon closed round {tolerance:e}, 100 grasps");
        quality(c, &name, &closed, Edges::Round { tolerance });
    }
}

/// A contact on an object of ten centimetres with inward normal −`outward`.
fn on(position: Vector3<f64>, outward: Vector3<f64>) -> Contact {
    Contact {
        position: position.into(),
        inward_normal: Unit::new_normalize(-outward),
    }
}

/// Contacts spaced evenly on a circle.
fn ring(count: usize) -> Vec<Contact> {
    (0..count)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / count as f64).sin_cos();
            let p = Vector3::new(cos, sin, 0.0);
            on(p * 0.05, p)
        })
        .collect()
}

/// Families that random sampling does not produce: symmetric, coplanar and axis-aligned grasps.
fn families() -> Vec<(&'static str, Vec<Vec<Contact>>)> {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let on_box = |rng: &mut ChaCha8Rng| {
        let axis = rng.random_range(0..3);
        let mut p = Vector3::from_fn(|_, _| 0.01 * f64::from(rng.random_range(-3..4)));
        let mut n = Vector3::zeros();
        n[axis] = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        p[axis] = 0.05 * n[axis];
        on(p, n)
    };
    let coplanar = |rng: &mut ChaCha8Rng| {
        let v = in_ball(rng);
        let p = Vector3::new(v.x, v.y, 0.0);
        on(p * 0.05, p)
    };
    let boxes = (0..GRASPS)
        .map(|_| (0..4).map(|_| on_box(&mut rng)).collect())
        .collect();
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let planes = (0..GRASPS)
        .map(|_| (0..4).map(|_| coplanar(&mut rng)).collect())
        .collect();
    vec![
        ("ring of 3", vec![ring(3); GRASPS]),
        ("ring of 4", vec![ring(4); GRASPS]),
        ("box, 4 contacts", boxes),
        ("coplanar, 4 contacts", planes),
    ]
}

fn structured(c: &mut Criterion) {
    for (name, grasps) in families() {
        for tolerance in [1e-4, 1e-8] {
            let convention = convention(Edges::Round { tolerance }).with_torque_length(0.05);
            let centre = Point3::origin();
            let mut workspace = Workspace::new();
            let name = format!("grasp/epsilon {name}, round {tolerance:e}, 100 grasps");
            c.bench_function(&name, |b| {
                b.iter(|| {
                    for contacts in &grasps {
                        let model = GraspModel::new(contacts, &centre, &convention);
                        black_box(epsilon(&model, &mut workspace).is_ok());
                    }
                });
            });
        }
    }
}

fn others(c: &mut Criterion) {
    let closed = grasps(true);
    let convention = convention(Edges::Polygon(8));
    let centre = Point3::origin();
    let models: Vec<GraspModel<'_>> = closed
        .iter()
        .map(|contacts| GraspModel::new(contacts, &centre, &convention))
        .collect();
    let mut workspace = Workspace::new();
    let mut gradient = Gradient::default();
    c.bench_function("grasp/margin and gradient 3x8, 100 grasps", |b| {
        b.iter(|| {
            for model in &models {
                if let Ok(found) = margin(model, &mut workspace) {
                    let done =
                        facet_gradient(model, &found.facet, FrameRule::Tangent, &mut gradient);
                    black_box(done.is_ok());
                }
            }
        });
    });
    let mut facets: Vec<ActiveFacet> = Vec::new();
    c.bench_function("grasp/near-active facets 3x8, band 0.01, 100 grasps", |b| {
        b.iter(|| {
            for model in &models {
                let done = near_active_facets(model, 0.01, &mut workspace, &mut facets);
                black_box(done.is_ok());
            }
        });
    });
    c.bench_function("grasp/epsilon L-infinity 3x8, 100 grasps", |b| {
        b.iter(|| {
            for model in &models {
                black_box(epsilon_linf(model, &mut workspace).is_ok());
            }
        });
    });
    c.bench_function("grasp/full hull and volume 3x8, 10 grasps", |b| {
        b.iter(|| {
            for model in &models[..10] {
                black_box(volume(model).is_ok());
            }
        });
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).warm_up_time(std::time::Duration::from_millis(500)).measurement_time(std::time::Duration::from_secs(2));
    targets = epsilons, structured, others
}
criterion_main!(benches);
