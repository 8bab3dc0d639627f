use nalgebra::Point3;
use proptest::prelude::*;

use crate::clouds::{blob, branches};
use crate::shapes::wrapped_and_mapped;

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn random_blobs_are_mapped_one_to_one(
        waves in prop::collection::vec((-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64, 0.0..0.12_f64), 4),
        stretch in 0.4..1.0_f64,
    ) {
        let points: Vec<Point3<f64>> = blob(2500, |p| {
            let wave = |(x, y, z, size): &(f64, f64, f64, f64)| {
                size * (x * p.x + y * p.y + z * p.z).sin()
            };
            1.0 + waves.iter().map(wave).sum::<f64>()
        })
        .iter()
        .map(|p| Point3::new(p.x, stretch * p.y, p.z))
        .collect();
        let (wrap, _) = wrapped_and_mapped(&points);
        prop_assert!(wrap.mesh.volume() > 0.0);
    }

    #[test]
    fn random_branches_are_mapped_one_to_one(
        ends in prop::collection::vec((-2.5..2.5_f64, -2.5..2.5_f64, -2.5..2.5_f64, 0.3..0.6_f64), 2..5),
    ) {
        let rods: Vec<_> = ends
            .iter()
            .map(|(x, y, z, r)| (Point3::origin(), Point3::new(*x, *y, *z), *r))
            .collect();
        let points = branches(120.0, &rods);
        let (wrap, _) = wrapped_and_mapped(&points);
        prop_assert!(wrap.mesh.volume() > 0.0);
    }
}
