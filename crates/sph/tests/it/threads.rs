//! Fits do not depend on the number of threads, to the last bit.

use nalgebra::Vector3;
use rayon::ThreadPoolBuilder;
use sph::direction::even_directions;
use sph::regression::{Gram, Method, Penalty, Samples, gram};
use sph::{Coefficients, Direction, batch, bounds};

fn samples(count: usize, degree: usize) -> (Vec<Direction>, Vec<f64>) {
    let directions: Vec<Direction> = even_directions(count)
        .iter()
        .map(|p| Direction::new_normalize(Vector3::new(p.x, p.y, 1.6 * p.z)))
        .collect();
    let mut beta = Coefficients::constant(degree, 0.05);
    for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
        *b = 0.01 * (i as f64 * 0.7).sin() / (1.0 + i as f64);
    }
    let mut values = batch::evaluate(&beta, &directions);
    for (i, v) in values.iter_mut().enumerate() {
        *v += 1e-3 * (i as f64 * 78.233).sin();
        if i % 97 == 5 {
            *v += 0.05;
        }
    }
    (directions, values)
}

/// The bits of the result of `run` in pools of 1, 2 and 4 threads.
fn bits(run: impl Fn() -> Vec<f64> + Sync) -> [Vec<u64>; 3] {
    [1, 2, 4].map(|threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let numbers = pool.expect("a pool of threads").install(&run);
        numbers.iter().map(|x| x.to_bits()).collect()
    })
}

fn assert_same(name: &str, run: impl Fn() -> Vec<f64> + Sync) {
    let [one, two, four] = bits(run);
    assert!(one.len() > 1, "{name}");
    assert!(one == two && one == four, "{name} depends on threads");
}

#[test]
fn fits_are_the_same_bits_with_one_two_and_four_threads() {
    let degree = 24;
    let (directions, values) = samples(9000, degree);
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    for (name, penalty, method) in [
        ("automatic penalty", None, Method::Automatic),
        (
            "conjugate gradients",
            Some(Penalty::NONE),
            Method::Conjugate,
        ),
        ("Cholesky", Some(Penalty::NONE), Method::Cholesky),
    ] {
        assert_same(name, || {
            let gram = Gram::new(samples, degree).expect("equations");
            let penalty = penalty.unwrap_or_else(|| gram.choose_penalty(2).expect("a penalty"));
            let found = gram.coefficients(samples, penalty, method).expect("a fit");
            let mut numbers = found.as_slice().to_vec();
            numbers.push(penalty.lambda);
            numbers
        });
    }
}

#[test]
fn what_follows_a_fit_is_the_same_bits_too() {
    let degree = 14;
    let (directions, values) = samples(3000, degree);
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    let penalty = Penalty {
        lambda: 0.01,
        power: 2,
    };
    let beta = gram::fit(samples, degree, penalty).expect("a fit");
    assert_same("range", || {
        let range = bounds::tight_range(&beta, 1e-3);
        vec![range.lower, range.upper, range.seen_lower, range.seen_upper]
    });
    assert_same("jets", || {
        let jets = batch::jets(&beta, &directions);
        jets.iter()
            .flat_map(|j| [j.value, j.gradient.x, j.hessian[(0, 1)]])
            .collect()
    });
}
