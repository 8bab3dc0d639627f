//! Measures every row of the table in docs/accuracy.md; no row may exceed the stated value.
#![allow(clippy::print_stderr, reason = "says what was measured or left out")]

use std::collections::BTreeMap;

use nalgebra::{Rotation3, Vector3};
use sph::direction::{even_directions, retract};
use sph::grid::RingGrid;
use sph::regression::{Gram, Method, Penalty, Samples};
use sph::rotation::rotate;
use sph::scattered::Scattered;
use sph::{Basis, Coefficients, Direction, Field, Jet, batch, index};

/// A function with the decay of a typical surface: mean 1, β ~ 1/l².
fn surface(degree: usize) -> Coefficients {
    let mut beta = Coefficients::constant(degree, 1.0);
    for (i, b) in beta.as_mut_slice().iter_mut().enumerate().skip(1) {
        let (l, _) = index::degree_order(i);
        *b = 0.2 * (1.7 * i as f64).sin() / (l * l) as f64;
    }
    beta
}

/// Directions spread evenly, then the ends of the axes and points close to them.
fn places(spread: usize) -> Vec<Direction> {
    let mut all = even_directions(spread);
    let near = Vector3::new(2e-9, -1e-9, 3e-9);
    for axis in [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()] {
        all.extend([axis, -axis, retract(&axis, &near), retract(&-axis, &near)]);
    }
    all
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, v| {
        if v.is_finite() {
            most.max(v.abs())
        } else {
            f64::INFINITY
        }
    })
}

/// Worst differences of the fast sums from the plain ones, over the largest value.
fn sums(degree: usize) -> [f64; 2] {
    // The direct sum is slow at high degrees.
    let (beta, points) = (surface(degree), places(150_000 / degree));
    let basis = Basis::new(degree);
    let mut work = basis.workspace();
    let mut harmonics = vec![0.0; basis.len()];
    let plain: Vec<f64> = points
        .iter()
        .map(|p| {
            basis.values(p, &mut work, &mut harmonics);
            let terms = harmonics.iter().zip(beta.as_slice());
            terms.map(|(y, b)| y * b).sum()
        })
        .collect();
    let scale = largest(plain.iter().copied());
    [
        batch::evaluate(&beta, &points),
        Scattered::new(&points).evaluate(&beta),
    ]
    .map(|fast| largest(fast.iter().zip(&plain).map(|(a, b)| (a - b) / scale)))
}

/// Worst errors of value, gradient and Hessian over the largest value, gradient and Hessian.
fn jet_errors(beta: &Coefficients, points: &[Direction], found: &[Jet]) -> [f64; 3] {
    let basis = Basis::new(beta.degree());
    let mut work = basis.workspace();
    let (mut errors, mut scales) = ([0.0_f64; 3], [0.0_f64; 3]);
    for (p, found) in points.iter().zip(found) {
        let exact = basis.jet(beta, p, &mut work);
        let rows = [
            ((found.value - exact.value).abs(), exact.value.abs()),
            (
                (found.gradient - exact.gradient).norm(),
                exact.gradient.norm(),
            ),
            ((found.hessian - exact.hessian).norm(), exact.hessian.norm()),
        ];
        for (k, (error, size)) in rows.into_iter().enumerate() {
            errors[k] = largest([errors[k], error]);
            scales[k] = scales[k].max(size);
        }
    }
    std::array::from_fn(|k| errors[k] / scales[k])
}

fn field(degree: usize) -> [f64; 3] {
    let (beta, points) = (surface(degree), places(3000));
    let field = Field::new(&beta);
    let found: Vec<Jet> = points.iter().map(|p| field.jet(p)).collect();
    jet_errors(&beta, &points, &found)
}

fn batched(degree: usize) -> [f64; 3] {
    let (beta, points) = (surface(degree), places(200));
    jet_errors(&beta, &points, &batch::jets(&beta, &points))
}

/// Distance of the fits by QR and by the Gram operator over the norm of β, noisy samples.
fn regression(degree: usize, aspect: f64, method: Method) -> f64 {
    let count = 4 * index::count(degree);
    let directions: Vec<Direction> = even_directions(count)
        .iter()
        .map(|p| Direction::new_normalize(Vector3::new(p.x, p.y, p.z * aspect)))
        .collect();
    let values: Vec<f64> = batch::evaluate(&surface(degree), &directions)
        .iter()
        .enumerate()
        .map(|(i, v)| v + 1e-2 * (i as f64 * 78.233).sin())
        .collect();
    let samples = Samples {
        directions: &directions,
        values: &values,
    };
    let gram = Gram::new(samples, degree).unwrap();
    eprintln!(
        "aspect {aspect}: cond(Y) {:.0}",
        gram.condition(Penalty::NONE).unwrap()
    );
    let by = |method: Method| gram.coefficients(samples, Penalty::NONE, method).unwrap();
    let reference = by(Method::Qr);
    by(method).distance(&reference) / reference.distance(&Coefficients::zeros(0))
}

fn measured() -> BTreeMap<&'static str, f64> {
    let mut rows = BTreeMap::new();
    for (degree, names) in [
        (50, ["direct sums, L = 50", "non-uniform transform, L = 50"]),
        (
            300,
            ["direct sums, L = 300", "non-uniform transform, L = 300"],
        ),
    ] {
        rows.extend(names.into_iter().zip(sums(degree)));
    }
    let names = [
        "field value, L = 50",
        "field gradient, L = 50",
        "field Hessian, L = 50",
    ];
    rows.extend(names.into_iter().zip(field(50)));
    let names = [
        "batched values, L = 300",
        "batched gradients, L = 300",
        "batched Hessians, L = 300",
    ];
    rows.extend(names.into_iter().zip(batched(300)));
    let beta = surface(100);
    let norm = beta.distance(&Coefficients::zeros(0));
    let grid = RingGrid::gauss_legendre(101, 216);
    let back = grid.analysis(&grid.synthesis(&beta), 100);
    rows.insert(
        "synthesis and analysis, L = 100",
        back.distance(&beta) / norm,
    );
    let turn = Rotation3::from_euler_angles(0.4, 1.9, -2.2);
    let back = rotate(&rotate(&beta, &turn), &turn.inverse());
    rows.insert("rotation and back, L = 100", back.distance(&beta) / norm);
    rows.extend([
        (
            "fit against QR, L = 20, even samples",
            regression(20, 1.0, Method::Conjugate),
        ),
        (
            "fit against QR, L = 20, aspect 6",
            regression(20, 6.0, Method::Conjugate),
        ),
        (
            "fit against QR, L = 20, aspect 7",
            regression(20, 7.0, Method::Automatic),
        ),
        (
            "fit against QR, L = 20, aspect 9",
            regression(20, 9.0, Method::Cholesky),
        ),
        (
            "fit against QR, L = 30, aspect 3",
            regression(30, 3.0, Method::Conjugate),
        ),
    ]);
    rows
}

#[test]
fn the_table_states_what_is_measured() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/accuracy.md");
    let text = std::fs::read_to_string(path).expect("docs/accuracy.md");
    let stated: BTreeMap<String, f64> = text
        .lines()
        .filter_map(|line| {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            let bound = cells.get(2)?.parse().ok()?;
            Some((cells[1].to_string(), bound))
        })
        .collect();
    let rows = measured();
    for (name, value) in &rows {
        eprintln!("{name}: {value:.1e}");
    }
    let names: Vec<&str> = stated.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        rows.keys().copied().collect::<Vec<_>>(),
        "rows of docs/accuracy.md"
    );
    for (name, value) in &rows {
        assert!(
            *value <= stated[*name],
            "{name}: {value:.1e} above {:.1e}",
            stated[*name]
        );
    }
}
