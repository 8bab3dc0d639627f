//! Scattered points are set aside; small parts of the surface are not taken for them.

use nalgebra::{Point3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use shape::PointCloud;
use shape::fit::{FitSettings, fit};

const RADIUS: f64 = 0.05;
/// The spout: half width and length beyond the ball.
const SPOUT: (f64, f64) = (0.003, 0.02);

/// What a point was made as.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Ball,
    Spout,
    Outlier,
}

/// A ball with a thin spout along x, even by area, with 0.2 mm of noise and a share of outliers in a
/// box of twice its size.
fn jug(count: usize, share_of_outliers: f64) -> Vec<(Kind, Point3<f64>)> {
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    let noise = Normal::new(0.0, 2e-4).unwrap();
    let (width, length) = SPOUT;
    let areas = (
        4.0 * std::f64::consts::PI * RADIUS * RADIUS,
        2.0 * std::f64::consts::PI * width * length,
    );
    let point = |_| {
        let at = |rng: &mut ChaCha8Rng| 2.0 * rng.random::<f64>() - 1.0;
        if rng.random::<f64>() < share_of_outliers {
            let place = Vector3::from_fn(|_, _| 2.0 * RADIUS * at(&mut rng));
            return (Kind::Outlier, Point3::from(place));
        }
        let (sin, cos) = (std::f64::consts::PI * at(&mut rng)).sin_cos();
        let on_spout = rng.random::<f64>() * (areas.0 + areas.1) < areas.1;
        let (kind, place) = if on_spout {
            let x = RADIUS + length * rng.random::<f64>();
            // A cone, so that every ray meets it once.
            let width = width * (1.0 - 0.5 * (x - RADIUS) / length);
            (Kind::Spout, Vector3::new(x, width * cos, width * sin))
        } else {
            let z = at(&mut rng);
            let s = (1.0 - z * z).sqrt();
            (Kind::Ball, Vector3::new(s * cos, s * sin, z) * RADIUS)
        };
        let moved = Vector3::from_fn(|_, _| noise.sample(&mut rng));
        (kind, Point3::from(place + moved))
    };
    (0..count).map(point).collect()
}

#[test]
fn a_thin_spout_stays_and_scattered_points_go() {
    for count in [25_000, 4_000] {
        for share_of_outliers in [0.0, 0.05, 0.2] {
            let name = format!("{count} points, share of outliers {share_of_outliers}");
            let points = jug(count, share_of_outliers);
            let cloud = PointCloud::new(points.iter().map(|p| p.1).collect()).unwrap();
            let settings = FitSettings {
                degree: 25,
                lambda: None,
            };
            let fit = fit(&cloud, &settings).unwrap();
            let mut set_aside = vec![false; points.len()];
            fit.outliers.iter().for_each(|i| set_aside[*i] = true);
            let share = |wanted: &dyn Fn(Kind, &Point3<f64>) -> bool| {
                let hits = points
                    .iter()
                    .zip(&set_aside)
                    .filter(|(p, _)| wanted(p.0, &p.1));
                let hits: Vec<bool> = hits.map(|(_, aside)| *aside).collect();
                hits.iter().filter(|x| **x).count() as f64 / hits.len().max(1) as f64
            };
            let spout = share(&|kind, _| kind == Kind::Spout);
            assert!(spout <= 0.05, "{name}: {spout} of the spout");
            let ball = share(&|kind, _| kind == Kind::Ball);
            assert!(ball <= 1e-3, "{name}: {ball} of the ball");
            // A clean cloud is fitted once, and loses nothing.
            assert!(share_of_outliers > 0.0 || fit.outliers.is_empty(), "{name}");
            // Nearer than the points are to each other an outlier has neighbours too.
            let far = |p: &Point3<f64>| (p.coords.norm() - RADIUS).abs() > 0.01;
            let found = share(&|kind, p| kind == Kind::Outlier && far(p));
            assert!(
                share_of_outliers == 0.0 || found >= 0.9,
                "{name}: {found} found"
            );
            // Away from the spout the surface is the ball.
            let away = points
                .iter()
                .filter(|(kind, p)| *kind == Kind::Ball && p.x < 0.02);
            let squares: Vec<f64> = away
                .map(|(_, p)| {
                    let seen = p - fit.centre_in_cloud;
                    let direction = sph::Direction::new_normalize(seen);
                    (fit.shape.radius(&direction) - seen.norm()).powi(2)
                })
                .collect();
            let error = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            assert!(error <= 1e-3, "{name}: {error:.1e}");
        }
    }
}
