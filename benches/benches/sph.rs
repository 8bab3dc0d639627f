//! Functions on the sphere: fits, certified ranges, and evaluation as in an ascent, at L = 50.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use sph::direction::even_directions;
use sph::regression::{Gram, Method, Penalty, Samples, gram};
use sph::rotation::rotate;
use sph::{Basis, Coefficients, Direction, Field, batch, bounds, index};

const DEGREE: usize = 50;

/// A surface with the decay of a real object's: β ~ 1/l², metres.
fn surface() -> Coefficients {
    let mut beta = Coefficients::constant(DEGREE, 0.05);
    for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
        let (l, _) = index::degree_order(i);
        *b = 0.01 * (1.7 * i as f64).sin() / (l * l) as f64;
    }
    beta
}

/// 25,000 noisy samples, twice as dense at the equator as a uniform cloud.
fn samples() -> (Vec<Direction>, Vec<f64>) {
    let directions: Vec<Direction> = even_directions(25_000)
        .iter()
        .map(|p| Direction::new_normalize(Vector3::new(p.x, p.y, 2.0 * p.z)))
        .collect();
    let mut values = batch::evaluate(&surface(), &directions);
    for (i, v) in values.iter_mut().enumerate() {
        *v += 3e-4 * (i as f64 * 78.233).sin();
    }
    (directions, values)
}

fn regression(c: &mut Criterion) {
    let (directions, values) = samples();
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    let mut group = c.benchmark_group("fit 25,000 points, L = 50");
    group.sample_size(10);
    group.bench_function("no penalty", |b| {
        b.iter(|| gram::fit(black_box(samples), DEGREE, Penalty::NONE));
    });
    group.bench_function("automatic penalty", |b| {
        b.iter(|| {
            let gram = Gram::new(black_box(samples), DEGREE)?;
            let penalty = gram.choose_penalty(2)?;
            gram.coefficients(samples, penalty, Method::Automatic)
        });
    });
    group.finish();
}

fn reading(c: &mut Criterion) {
    let beta = surface();
    let points = even_directions(1000);
    let field = Field::new(&beta);
    let mut at = 0;
    c.bench_function("field jet, anywhere", |b| {
        b.iter(|| {
            at = (at + 377) % points.len();
            field.jet(black_box(&points[at]))
        });
    });
    ascent(c, "three field jets of an ascent", &points, |p| {
        field.jet(p)
    });
    ascent(c, "three field values of an ascent", &points, |p| {
        field.value(p)
    });
    c.bench_function("batched jets, 1000 points", |b| {
        b.iter(|| batch::jets(black_box(&beta), &points));
    });
    let basis = Basis::new(DEGREE);
    let mut work = basis.workspace();
    c.bench_function("jet by the full sum", |b| {
        b.iter(|| basis.jet(&beta, black_box(&points[7]), &mut work));
    });
    c.bench_function("field set-up", |b| b.iter(|| Field::new(black_box(&beta))));
}

/// Three contacts per step, each displaced slightly from step to step.
fn ascent<T>(
    c: &mut Criterion,
    name: &str,
    points: &[Direction],
    mut read: impl FnMut(&Direction) -> T,
) {
    let mut contacts = [points[100], points[500], points[900]];
    let step = Vector3::new(3e-4, -2e-4, 1e-4);
    c.bench_function(name, |b| {
        b.iter(|| {
            contacts = contacts.map(|p| Direction::new_normalize(p.into_inner() + step));
            contacts.map(|p| read(black_box(&p)))
        });
    });
}

fn whole(c: &mut Criterion) {
    let beta = surface();
    c.bench_function("certified range, 16 times", |b| {
        b.iter(|| bounds::certified_range(black_box(&beta), 16));
    });
    c.bench_function("tight range, 1e-3", |b| {
        b.iter(|| bounds::tight_range(black_box(&beta), 1e-3));
    });
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, 1.2, -2.0);
    c.bench_function("rotation", |b| b.iter(|| rotate(black_box(&beta), &turn)));
}

criterion_group!(benches, regression, reading, whole);
criterion_main!(benches);
