//! The Gram route against dense QR, and what the penalty promises.

use nalgebra::Vector3;
use sph::direction::even_directions;
use sph::regression::{
    Gram, Method, Penalty, RegressionError, Robust, Samples, Settings, fit, gram, qr,
};
use sph::{Basis, Coefficients, Direction, batch};

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
fn outliers_do_not_spoil_a_robust_fit_and_clean_samples_keep_their_weight() {
    let degree = 20;
    let beta = truth(degree);
    let directions = elongated(6000, 2.0);
    let clean: Vec<f64> = batch::evaluate(&beta, &directions)
        .iter()
        .enumerate()
        .map(|(i, v)| v + noise(i))
        .collect();
    let mut spoiled = clean.clone();
    for i in (0..6000).step_by(37) {
        spoiled[i] += 0.03 + 0.02 * (i as f64).sin();
    }
    let robust = Settings {
        robust: Some(Robust::default()),
        ..Settings::of_degree(degree)
    };
    let error = |values: &[f64], settings: &Settings| {
        let samples = Samples {
            directions: &directions,
            values,
        };
        let fitted = fit(samples, settings).unwrap();
        (fitted.coefficients.distance(&beta), fitted.rounds)
    };
    let (untouched, rounds) = error(&clean, &robust);
    assert_eq!(rounds, 0);
    let (spoiled_robust, _) = error(&spoiled, &robust);
    let (spoiled_plain, _) = error(&spoiled, &Settings::of_degree(degree));
    assert!(
        spoiled_robust <= 1.3 * untouched,
        "{spoiled_robust:.1e} {untouched:.1e}"
    );
    assert!(
        spoiled_plain > 3.0 * untouched,
        "{spoiled_plain:.1e} {untouched:.1e}"
    );
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
    for lambda in [0.0, 1e-3] {
        let by = |method: Method| {
            let settings = Settings {
                penalty: Some(Penalty { lambda, power: 2 }),
                weights: Some(&weights),
                method,
                ..Settings::of_degree(degree)
            };
            fit(samples, &settings).unwrap().coefficients
        };
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
    let settings = Settings {
        weights: Some(&negative),
        ..Settings::of_degree(degree)
    };
    assert!(matches!(
        fit(samples, &settings),
        Err(RegressionError::Weight { index: 7, .. })
    ));
}

#[test]
fn the_covariance_inverts_the_normal_equations() {
    let degree = 6;
    let directions = elongated(900, 1.5);
    let values = batch::evaluate(&truth(degree), &directions);
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    let penalty = Penalty {
        lambda: 0.1,
        power: 2,
    };
    let gram = Gram::new(samples, degree).unwrap();
    let covariance = gram.covariance(penalty).unwrap();
    let count = sph::index::count(degree);
    for j in 0..count {
        // A column times the normal equations, applied through the points, is a unit vector.
        let column: Vec<f64> = (0..count).map(|i| covariance[(i, j)]).collect();
        let column = Coefficients::new(column).unwrap();
        let fitted = batch::evaluate(&column, &directions);
        let image = batch::moments(&directions, &fitted, degree);
        for i in 0..count {
            let (l, _) = sph::index::degree_order(i);
            let found = image.as_slice()[i] + penalty.weight(l) * column.as_slice()[i];
            let expected = if i == j { 1.0 } else { 0.0 };
            assert!((found - expected).abs() <= 1e-11);
        }
    }
}

#[test]
fn leverage_is_the_diagonal_of_the_hat_matrix() {
    let degree = 9;
    let directions = elongated(700, 1.8);
    let values = batch::evaluate(&truth(degree), &directions);
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    let weights: Vec<f64> = (0..700).map(|i| 1.0 + 0.9 * f64::from(i).sin()).collect();
    let penalty = Penalty {
        lambda: 0.02,
        power: 2,
    };
    let gram = Gram::weighted(samples, &weights, degree).unwrap();
    let found = gram.leverage(samples, penalty).unwrap();
    let covariance = gram.covariance(penalty).unwrap();
    let basis = Basis::new(degree);
    let mut work = basis.workspace();
    let mut row = vec![0.0; basis.len()];
    for ((p, weight), leverage) in directions.iter().zip(&weights).zip(&found) {
        basis.values(p, &mut work, &mut row);
        let mut expected = 0.0;
        for (i, a) in row.iter().enumerate() {
            for (j, b) in row.iter().enumerate() {
                expected += weight * a * covariance[(i, j)] * b;
            }
        }
        assert!((leverage - expected).abs() <= 1e-12);
        assert!((0.0..=1.0).contains(leverage));
    }
    // Without a penalty the trace counts the coefficients.
    let free = gram.leverage(samples, Penalty::NONE).unwrap();
    assert!((free.iter().sum::<f64>() - 100.0).abs() <= 1e-9);
}
