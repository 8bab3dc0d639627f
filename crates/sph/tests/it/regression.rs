//! The Gram route against dense QR, and the properties of the penalty.

use nalgebra::Vector3;
use sph::direction::even_directions;
use sph::regression::{Gram, Method, Penalty, RegressionError, Samples, gram, qr};
use sph::{Coefficients, Direction, batch};

/// Directions of points spread by area over an ellipsoid of revolution: dense at the waist.
fn elongated(count: usize, aspect: f64) -> Vec<Direction> {
    even_directions(count)
        .iter()
        .map(|p| Direction::new_normalize(Vector3::new(p.x, p.y, p.z * aspect)))
        .collect()
}

fn truth(degree: usize) -> Coefficients {
    let mut beta = Coefficients::constant(degree, 0.05);
    for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
        *b = 0.01 * (i as f64 * 0.7).sin() / (1.0 + i as f64);
    }
    beta
}

fn noise(i: usize) -> f64 {
    1e-3 * ((i as f64 * 12.9898).sin() * 43758.5453).fract()
}

#[test]
fn gram_agrees_with_qr() {
    for (degree, aspect) in [(4, 1.0), (12, 1.0), (12, 3.0), (18, 2.0)] {
        let directions = elongated(4 * (degree + 1) * (degree + 1) + 200, aspect);
        let mut values = batch::evaluate(&truth(degree), &directions);
        for (i, v) in values.iter_mut().enumerate() {
            *v += noise(i);
        }
        let samples = Samples {
            directions: &directions,
            values: &values,
        };
        for lambda in [0.0, 1e-4, 1.0] {
            let penalty = Penalty { lambda, power: 2 };
            let reference = qr::fit(samples, degree, penalty).unwrap();
            let fast = gram::fit(samples, degree, penalty).unwrap();
            let error = fast.distance(&reference) / reference.distance(&Coefficients::zeros(0));
            assert!(
                error <= 1e-10,
                "L={degree} aspect={aspect} λ={lambda}: {error:.1e}"
            );
        }
    }
}

#[test]
fn exact_data_give_the_truth_back() {
    let beta = truth(10);
    let directions = even_directions(500);
    let values = batch::evaluate(&beta, &directions);
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    for found in [
        qr::fit(samples, 10, Penalty::NONE).unwrap(),
        gram::fit(samples, 10, Penalty::NONE).unwrap(),
    ] {
        assert!(found.distance(&beta) <= 1e-13);
    }
}

#[test]
fn too_few_samples_are_refused_without_a_penalty_and_fitted_with_one() {
    let directions = even_directions(60);
    let values = batch::evaluate(&truth(3), &directions);
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    for refused in [
        qr::fit(samples, 10, Penalty::NONE),
        gram::fit(samples, 10, Penalty::NONE),
    ] {
        assert!(matches!(
            refused,
            Err(RegressionError::RankDeficient {
                samples: 60,
                coefficients: 121,
                degree: 10
            })
        ));
    }
    let penalty = Penalty {
        lambda: 1e-9,
        power: 2,
    };
    let reference = qr::fit(samples, 10, penalty).unwrap();
    let fast = gram::fit(samples, 10, penalty).unwrap();
    assert!(fast.distance(&reference) <= 1e-6);
}

#[test]
fn the_chosen_penalty_is_near_the_best_one() {
    let degree = 16;
    let beta = truth(degree);
    let directions = elongated(700, 2.5);
    let clean = batch::evaluate(&beta, &directions);
    let values: Vec<f64> = clean
        .iter()
        .enumerate()
        .map(|(i, v)| v + 3.0 * noise(i))
        .collect();
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    let gram = Gram::new(samples, degree).unwrap();
    let error = |penalty: Penalty| {
        gram.solve(samples, penalty)
            .unwrap()
            .coefficients
            .distance(&beta)
    };
    let chosen = error(gram.choose_penalty(2).unwrap());
    let best = (-28..8)
        .map(|k| {
            error(Penalty {
                lambda: 10.0_f64.powf(0.5 * f64::from(k)),
                power: 2,
            })
        })
        .fold(f64::INFINITY, f64::min);
    assert!(chosen <= 1.3 * best, "chosen {chosen:.2e}, best {best:.2e}");
    assert!(chosen < error(Penalty::NONE));
}

#[test]
fn bad_samples_are_named() {
    let directions = even_directions(5);
    let values = [1.0, 1.0, f64::NAN, 1.0, 1.0];
    let samples = |values| Samples {
        directions: &directions,
        values,
    };
    assert!(matches!(
        qr::fit(samples(&values), 0, Penalty::NONE),
        Err(RegressionError::NotFinite { index: 2, .. })
    ));
    assert!(matches!(
        gram::fit(samples(&values[..3]), 0, Penalty::NONE),
        Err(RegressionError::Lengths {
            directions: 5,
            values: 3
        })
    ));
    assert!(matches!(
        gram::fit(
            Samples {
                directions: &[],
                values: &[]
            },
            0,
            Penalty::NONE
        ),
        Err(RegressionError::Empty)
    ));
}

#[test]
fn every_method_gives_the_same_weighted_fit() {
    let degree = 18;
    let directions = elongated(2500, 1.7);
    let values: Vec<f64> = batch::evaluate(&truth(degree), &directions)
        .iter()
        .enumerate()
        .map(|(i, v)| v + noise(i))
        .collect();
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    let weights: Vec<f64> = (0..2500).map(|i| 1.0 + 0.9 * f64::from(i).sin()).collect();
    let gram = Gram::weighted(samples, &weights, degree).unwrap();
    for lambda in [0.0, 1e-3] {
        let penalty = Penalty { lambda, power: 2 };
        let by = |method: Method| gram.coefficients(samples, penalty, method).unwrap();
        let reference = by(Method::Qr);
        for method in [Method::Automatic, Method::Conjugate, Method::Cholesky] {
            let error = by(method).distance(&reference);
            assert!(
                error <= 1e-10 * reference.distance(&Coefficients::zeros(0)),
                "{method:?}"
            );
        }
    }
    let negative: Vec<f64> = (0..2500).map(|i| if i == 7 { -1.0 } else { 1.0 }).collect();
    assert!(matches!(
        Gram::weighted(samples, &negative, degree).err(),
        Some(RegressionError::Weight { index: 7, .. })
    ));
}

#[test]
fn a_constant_is_fitted_at_every_degree() {
    // The values differ from their mean by rounding alone, and so do the coefficients from zero.
    let directions = elongated(600, 1.6);
    let values: Vec<f64> = (0..600)
        .map(|i| 0.05 * (1.0 + f64::EPSILON * f64::from(i % 3)))
        .collect();
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    for degree in [0, 1, 5, 10] {
        for penalty in [
            Penalty::NONE,
            Penalty {
                lambda: 1e-3,
                power: 2,
            },
        ] {
            let found = gram::fit(samples, degree, penalty).unwrap();
            let constant = Coefficients::constant(degree, 0.05);
            assert!(found.distance(&constant) <= 1e-14, "L={degree}");
        }
    }
    let noisy: Vec<f64> = (0..600).map(|i| 0.05 + noise(i)).collect();
    let samples = Samples {
        directions: &directions,
        values: &noisy,
    };
    let found = gram::fit(samples, 0, Penalty::NONE).unwrap();
    let mean = noisy.iter().sum::<f64>() / 600.0;
    assert!(found.distance(&Coefficients::constant(0, mean)) <= 1e-15);
}

#[test]
fn other_values_are_fitted_through_the_same_matrix() {
    for degree in [8, 24] {
        let directions = elongated(4000, 1.6);
        let weights: Vec<f64> = (0..4000).map(|i| 1.0 + 0.5 * f64::from(i % 2)).collect();
        let values: Vec<f64> = (0..4000).map(noise).collect();
        let of = |values| Samples {
            directions: &directions,
            values,
        };
        let gram = Gram::weighted(of(&values), &weights, degree).unwrap();
        let other: Vec<f64> = batch::evaluate(&truth(degree), &directions);
        let other: Vec<f64> = other.iter().zip(&values).map(|(a, b)| a + b).collect();
        let penalty = Penalty {
            lambda: 1e-3,
            power: 2,
        };
        let right = gram.right_hand_side(of(&other)).unwrap();
        let found = gram.continued(&right, penalty, None).unwrap();
        let plain = Gram::weighted(of(&other), &weights, degree).unwrap();
        let plain = plain
            .coefficients(of(&other), penalty, Method::Cholesky)
            .unwrap();
        let size = plain.distance(&Coefficients::zeros(degree));
        assert!(found.distance(&plain) <= 1e-5 * size, "L={degree}");
        let again = gram.continued(&right, penalty, Some(&plain)).unwrap();
        assert!(again.distance(&plain) <= 1e-5 * size, "L={degree}");
        let few = Samples {
            directions: &directions[1..],
            values: &other[1..],
        };
        assert!(gram.right_hand_side(few).is_err());
    }
}
