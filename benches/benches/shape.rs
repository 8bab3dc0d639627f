//! Shapes: the certificate, the mesh, and the differential at a point.

use criterion::{Criterion, criterion_group, criterion_main};
use shape::{RadialShape, Surface, algebra};
use sph::direction::even_directions;
use sph::{Coefficients, index};

/// A lumpy surface of the paper's degree.
fn lumpy(phase: f64) -> RadialShape {
    let mut beta = Coefficients::constant(50, 0.05);
    for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
        let (l, _) = index::degree_order(i);
        *b = 0.01 * (i as f64 * 0.7 + phase).sin() / (1.0 + l as f64).powi(3);
    }
    RadialShape::new(beta).expect("a positive radius")
}

fn bench(criterion: &mut Criterion) {
    let (a, b) = (lumpy(0.0), lumpy(1.0));
    let points = even_directions(64);
    let mut next = 0;
    let mut point = || {
        next = (next + 1) % points.len();
        points[next]
    };
    criterion.bench_function("shape/differential L=50", |bencher| {
        bencher.iter(|| a.differential(&point()))
    });
    criterion.bench_function("shape/contact L=50", |bencher| {
        bencher.iter(|| a.contact(&point()))
    });
    criterion.bench_function("shape/certify L=50", |bencher| {
        bencher.iter(|| RadialShape::new(a.coefficients().clone()))
    });
    criterion.bench_function("shape/mesh 100x100 L=50", |bencher| {
        bencher.iter(|| a.mesh(100, 100))
    });
    criterion.bench_function("shape/deformation L=50", |bencher| {
        bencher.iter(|| algebra::deformation(&a, &b, 0.3))
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
