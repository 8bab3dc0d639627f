//! Heat on a fitted surface: the weighted harmonics of the paper's reference 13.

use crate::common::pebble;
use shape::fit::{FitError, fit};
use shape::{FitSettings, PointCloud, Surface};
use sph::direction::even_directions;

#[test]
fn heat_takes_details_keeps_the_mean_and_measures_residuals_anew() {
    let truth = pebble();
    let points = even_directions(2000)
        .iter()
        .map(|p| truth.point(p))
        .collect();
    let cloud = PointCloud::new(points).unwrap();
    let settings = FitSettings {
        degree: 10,
        lambda: Some(0.0),
    };
    let fitted = fit(&cloud, &settings).unwrap();
    let same = fitted.smoothed(&cloud, 0.0).unwrap();
    assert_eq!(same.shape.coefficients(), fitted.shape.coefficients());
    assert!((same.rms - fitted.rms).abs() <= 1e-15);

    let smooth = fitted.smoothed(&cloud, 0.01).unwrap();
    let power = |of: &shape::Fit| of.shape.coefficients().power_spectrum();
    for (l, (before, after)) in power(&fitted).iter().zip(power(&smooth)).enumerate() {
        let kept = (-2.0 * (l * (l + 1)) as f64 * 0.01).exp();
        assert!(
            (after - kept * before).abs() <= 1e-12 * before.max(1e-12),
            "degree {l}"
        );
    }
    // What the heat took is what is missed now, so the residual is not that of the fit.
    assert!(
        smooth.rms >= 1e-4 && fitted.rms <= 1e-5,
        "{} {}",
        smooth.rms,
        fitted.rms
    );
    assert_eq!(smooth.centre_in_cloud, fitted.centre_in_cloud);
    let other = PointCloud::new(cloud.points()[..500].to_vec()).unwrap();
    let refused = fitted.smoothed(&other, 0.01);
    assert!(matches!(refused, Err(FitError::OtherCloud)));
    for wrong in [-0.1, f64::NAN, f64::INFINITY] {
        let refused = fitted.smoothed(&cloud, wrong);
        assert!(matches!(refused, Err(FitError::Heat { .. })), "{wrong}");
    }
}
