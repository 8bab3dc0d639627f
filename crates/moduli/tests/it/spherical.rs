//! Objects whose surface is a map of the sphere.

use moduli::nalgebra::Point3;
use moduli::{Error, FitSettings, PointCloud, SphericalObject};

const SETTINGS: FitSettings = FitSettings {
    degree: 4,
    lambda: Some(0.0),
};

fn ball() -> (PointCloud, Vec<sph::Direction>) {
    let directions = sph::direction::even_directions(300);
    let points = directions
        .iter()
        .map(|p| Point3::new(1.0 + 0.04 * p.x, 0.04 * p.y, 0.04 * p.z));
    (PointCloud::new(points.collect()).unwrap(), directions)
}

#[test]
fn a_spherical_object_comes_back_from_its_record() {
    let (cloud, directions) = ball();
    let object = SphericalObject::fit("ball", &cloud, &directions, &SETTINGS).unwrap();
    let bytes = object.to_record().to_bytes().unwrap();
    let stored = moduli::record::SphericalRecord::from_bytes(&bytes).unwrap();
    let again = SphericalObject::from_record(&stored).unwrap();
    for p in &directions {
        assert_eq!(again.at(p), object.at(p));
        assert!((again.at(p).mean_curvature() - 25.0).abs() < 1e-3);
    }
    let wrong = moduli::record::ShapeRecord::from_bytes(&bytes).unwrap_err();
    assert!(wrong.to_string().contains("spherical shape"), "{wrong}");
}

#[test]
fn stored_nonsense_is_refused() {
    let (cloud, directions) = ball();
    let object = SphericalObject::fit("ball", &cloud, &directions, &SETTINGS).unwrap();
    let mut lost = object.to_record();
    lost.centre_in_cloud_m[0] = f64::NAN;
    assert!(SphericalObject::from_record(&lost).is_err());
    let mut flat = object.to_record();
    flat.coordinates[2].fill(0.0);
    assert!(SphericalObject::from_record(&flat).is_err());
    let mut inside_out = object.to_record();
    inside_out.coordinates[0].iter_mut().for_each(|b| *b = -*b);
    assert!(SphericalObject::from_record(&inside_out).is_err());
    let few = SphericalObject::fit("ball", &cloud, &directions[1..], &SETTINGS);
    assert!(matches!(
        few,
        Err(Error::DirectionCount {
            directions: 299,
            points: 300
        })
    ));
}
