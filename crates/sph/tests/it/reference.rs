//! Values of Y_{l,m} and its gradient against independent high-precision ones.
#![allow(clippy::print_stderr, reason = "says what was measured or left out")]

use sph::{Basis, Direction, Harmonic, SphericalCoords};

/// e_θ and e_φ at θ, φ.
fn chart_frame(c: SphericalCoords) -> [nalgebra::Vector3<f64>; 2] {
    let (st, ct) = c.theta.sin_cos();
    let (sp, cp) = c.phi.sin_cos();
    [
        nalgebra::Vector3::new(ct * cp, ct * sp, -st),
        nalgebra::Vector3::new(-sp, cp, 0.0),
    ]
}

#[test]
fn every_reference_row_to_1e_12() {
    let bases: Vec<usize> = vec![4, 10, 20, 50, 70, 86, 87, 90, 100, 150, 200, 300];
    let bases: Vec<Basis> = bases.into_iter().map(Basis::new).collect();
    let blank = Harmonic {
        value: 0.0,
        gradient: nalgebra::Vector3::zeros(),
    };
    let mut rows = 0;
    let mut worst = 0.0_f64;
    for line in testkit::reference::YLM.lines().skip(1) {
        let cells: Vec<f64> = line.split(',').map(|c| c.parse().unwrap()).collect();
        let (l, m) = (cells[0] as usize, cells[1] as isize);
        let coords = SphericalCoords {
            theta: cells[2],
            phi: cells[3],
        };
        let p: Direction = coords.direction();
        let basis = bases.iter().find(|b| b.degree() >= l).unwrap();
        let mut harmonics = vec![blank; basis.len()];
        basis.values_and_gradients(&p, &mut basis.workspace(), &mut harmonics);
        let ours = harmonics[sph::index::position(l, m)];
        let [e_theta, e_phi] = chart_frame(coords);
        let found = [
            ours.value,
            ours.gradient.dot(&e_theta),
            ours.gradient.dot(&e_phi),
        ];
        let scale = cells[4..7].iter().fold(0.0_f64, |s, v| s.max(v.abs()));
        for (a, b) in found.iter().zip(&cells[4..7]) {
            let error = (a - b).abs();
            assert!(a.is_finite());
            // Subnormal numbers are not compared.
            assert!(
                error <= 1e-12 * scale || scale < 1e-280 && error <= 1e-290,
                "l={l} m={m} θ={} φ={}: {found:?} against {:?}",
                cells[2],
                cells[3],
                &cells[4..7]
            );
            if scale > 1e-280 {
                worst = worst.max(error / scale);
            }
        }
        rows += 1;
    }
    assert!(rows > 900, "{rows} rows");
    eprintln!("{rows} rows, worst error {worst:.2e} of the row's scale");
}
