//! The crate `hand`: preparing an object, closing the SDH from 100 poses (on the tips, and past
//! them), and solving for a hand at given contacts.

use criterion::{Criterion, criterion_group, criterion_main};
use grasp::Convention;
use hand::{
    ClosingRules, CollisionObject, HandState, Outcome, PoseSampling, ReachParams, Reacher,
    SynthesisParams, evaluate_pose, schunk_sdh,
};
use nalgebra::Point3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use shape::RadialShape;
use sph::Coefficients;

/// A lumpy ball of 4 cm with detail up to degree 50.
fn object() -> RadialShape {
    let mut beta = Coefficients::constant(50, 0.04);
    for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
        let degree = (i as f64).sqrt().floor();
        *b = 0.01 * (i as f64 * 2.3).sin() / (degree * degree);
    }
    RadialShape::new(beta).expect("a lump with a positive radius")
}

fn hand_layer(criterion: &mut Criterion) {
    let surface = object();
    let hand = schunk_sdh().expect("the built-in hand");
    criterion.bench_function("hand/prepare_object_degree_50", |b| {
        b.iter(|| CollisionObject::new(&surface).expect("a grid"));
    });
    let params = SynthesisParams {
        poses: 100,
        sampling: PoseSampling::of_hand(&hand),
        rules: ClosingRules::default(),
        convention: Convention::named("paper").expect("a known convention"),
        centre: Point3::origin(),
        tips: hand::TipModel::Point,
        least_quality: 0.01,
    };
    let object = CollisionObject::new(&surface).expect("a grid");
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let poses = params.sampling.sample(&object, &hand, 100, &mut rng);
    let mut group = criterion.benchmark_group("hand");
    group.sample_size(10);
    group.bench_function("100_poses", |b| {
        b.iter(|| {
            poses
                .iter()
                .filter_map(|pose| evaluate_pose(&object, &hand, pose, &params).ok())
                .count()
        });
    });
    let mut past_tips = params.clone();
    past_tips.rules.past_tips = true;
    group.bench_function("100_poses_past_tips", |b| {
        b.iter(|| {
            poses
                .iter()
                .filter_map(|pose| evaluate_pose(&object, &hand, pose, &past_tips).ok())
                .count()
        });
    });
    let made = poses
        .iter()
        .find_map(|pose| match evaluate_pose(&object, &hand, pose, &params) {
            Ok(Outcome::Stable(grasp)) => Some(grasp),
            _ => None,
        })
        .expect("a grasp");
    let reacher = Reacher::new(&object, &hand);
    let known = [HandState {
        object_from_palm: made.object_from_palm,
        joints: made.joints.clone(),
    }];
    let reach = ReachParams::default();
    group.bench_function("reach_from_known", |b| {
        b.iter(|| reacher.reach(&made.contacts, &reach, &known, &mut rng));
    });
    group.bench_function("reach_from_nothing", |b| {
        b.iter(|| {
            let mut rng = ChaCha8Rng::seed_from_u64(2);
            reacher.reach(&made.contacts, &reach, &[], &mut rng)
        });
    });
    group.finish();
}

criterion_group!(benches, hand_layer);
criterion_main!(benches);
