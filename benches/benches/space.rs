//! The moduli space: one quality, steps of the paper's ascent, and a whole ascent of ours.

use criterion::{Criterion, criterion_group, criterion_main};
use grasp::Convention;
use nalgebra::Point3;
use shape::{RadialField, RadialShape, SphericalField, Surface};
use space::{MonotoneAscent, Objective, PaperAscent};
use sph::{Coefficients, SphericalCoords, index};

fn bench(criterion: &mut Criterion) {
    let mut beta = Coefficients::constant(50, 0.04);
    beta.as_mut_slice()[index::position(2, 0)] = 0.01;
    beta.as_mut_slice()[index::position(3, 1)] = 0.003;
    let shape = RadialShape::new(beta).expect("a positive radius");
    let start = [(1.5, 0.1), (1.7, 2.3), (1.4, 4.0)]
        .map(|(theta, phi)| SphericalCoords { theta, phi }.direction());
    let convention = Convention::named("paper").expect("a known name");
    let mut objective = Objective::new(&convention, &shape, &Point3::origin());
    criterion.bench_function("moduli/quality at three directions L=50", |bencher| {
        bencher.iter(|| objective.quality_at(&shape, &start))
    });
    let ascent = PaperAscent {
        steps: 10,
        ..PaperAscent::PAPER
    };
    criterion.bench_function("moduli/ten steps of the paper's ascent L=50", |bencher| {
        bencher.iter(|| ascent.climb(&shape, &start, &mut objective, |_| {}))
    });
    let map = SphericalField::from_radial(&shape);
    let places = sph::direction::even_directions(1000);
    criterion.bench_function(
        "moduli/1000 reads of a map and its derivatives L=51",
        |bencher| {
            bencher.iter(|| {
                let read = |p| map.differential(p).normal_slope.trace();
                places.iter().map(read).sum::<f64>()
            })
        },
    );
    let field = RadialField::new(shape);
    criterion.bench_function("moduli/ten steps of the paper's ascent, field", |bencher| {
        bencher.iter(|| ascent.climb(&field, &start, &mut objective, |_| {}))
    });
    let ours = MonotoneAscent::default();
    criterion.bench_function("moduli/our ascent, field", |bencher| {
        bencher.iter(|| ours.climb(&field, &start, &mut objective, |_| {}))
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
