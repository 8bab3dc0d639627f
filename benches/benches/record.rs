//! Records: writing and reading a library of twelve shapes.

use criterion::{Criterion, criterion_group, criterion_main};
use record::{LibraryEntry, LibraryRecord, ShapeRecord};
use sph::Coefficients;

fn bench(criterion: &mut Criterion) {
    let entries = (0..12)
        .map(|k| LibraryEntry {
            id: format!("S{}", k + 1),
            name: "ball".to_owned(),
            shape: ShapeRecord {
                name: "ball".to_owned(),
                coefficients: Coefficients::constant(50, 0.03 + 0.001 * f64::from(k))
                    .as_slice()
                    .to_vec(),
                centre_in_cloud_m: [0.0; 3],
                lambda: 1e-3,
                rms_m: 1e-4,
                points: 25_000,
                notes: record::ShapeNotes::default(),
            },
            grasps: Vec::new(),
        })
        .collect();
    let library = LibraryRecord {
        seed: 0,
        convention: "paper".to_owned(),
        hand: "sdh".to_owned(),
        entries,
    };
    let bytes = library.to_bytes().expect("a small library");
    criterion.bench_function("record/write twelve shapes L=50", |bencher| {
        bencher.iter(|| library.to_bytes())
    });
    criterion.bench_function("record/read twelve shapes L=50", |bencher| {
        bencher.iter(|| LibraryRecord::from_bytes(&bytes))
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
