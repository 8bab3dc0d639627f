//! Fits of scans whose true surface is known: the chosen penalty is the right one for it.

use crate::common::SETTINGS;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use shape::PointCloud;
use shape::fit::{FitSettings, fit};

#[test]
fn ten_times_more_or_less_penalty_is_no_nearer_to_the_truth() {
    for id in ["S1", "S6", "S12", "U2"] {
        let object = catalogue::by_id(id).unwrap();
        let scan = PointCloud::new(object.scan(7)).unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(99);
        let truth = object.sample(8_000, &catalogue::ScanNoise::NONE, &mut rng);
        let truth = PointCloud::new(truth).unwrap();
        let fitted = |lambda| {
            let settings = FitSettings { lambda, ..SETTINGS };
            let fit = fit(&scan, &settings).unwrap();
            let samples = truth.seen_from(&fit.centre_in_cloud);
            let radii = fit.shape.radii(&samples.directions);
            let pairs = radii.iter().zip(&samples.radii);
            let squares: f64 = pairs.map(|(a, b)| (a - b).powi(2)).sum();
            let error = (squares / radii.len() as f64).sqrt();
            (error, fit.lambda)
        };
        let (chosen, lambda) = fitted(None);
        let (less, more) = (fitted(Some(0.1 * lambda)).0, fitted(Some(10.0 * lambda)).0);
        assert!(chosen < less, "{id}: {chosen:.2e} {less:.2e}");
        // Round objects bear more: the choice has edges in view.
        assert!(chosen <= 1.1 * more, "{id}: {chosen:.2e} {more:.2e}");
        // The noise of the scan is 0.35 mm and more; most of it averages out.
        assert!(chosen <= 0.35e-3, "{id}: {chosen:.2e}");
    }
}
