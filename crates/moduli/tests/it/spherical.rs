//! Objects whose surface is a map of the sphere.

use moduli::nalgebra::Point3;
use moduli::{
    Convention, Error, FitSettings, Hand, HandContacts, NoContact, Object, PointCloud, Poses,
};

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
    let object = Object::from_directions("ball", &cloud, &directions, &SETTINGS).unwrap();
    let bytes = object.to_spherical_record().unwrap().to_bytes().unwrap();
    let stored = moduli::record::SphericalRecord::from_bytes(&bytes).unwrap();
    let again = Object::from_spherical_record(&stored).unwrap();
    for p in &directions {
        assert_eq!(again.at(p), object.at(p));
        assert!((again.at(p).mean_curvature() - 25.0).abs() < 1e-3);
    }
    let wrong = moduli::record::ShapeRecord::from_bytes(&bytes).unwrap_err();
    assert!(wrong.to_string().contains("spherical shape"), "{wrong}");
}

#[test]
fn closed_holes_are_kept_and_no_contact_climbs_onto_them() {
    let (cloud, directions) = ball();
    let object = Object::from_directions("ball", &cloud, &directions, &SETTINGS).unwrap();
    let centre = object.frame().centre_in_cloud().coords;
    let mut record = object.to_spherical_record().unwrap();
    record.closed_holes = vec![moduli::record::ClosedHoleRecord {
        places_m: vec![(Point3::new(0.0, 0.0, 0.04) + centre).into()],
        reach_m: 0.03,
        area_m2: 1e-3,
    }];
    let file = record.to_bytes().unwrap();
    let object = Object::from_shape_file(&file).unwrap();
    assert_eq!(object.to_shape_file().unwrap(), file);
    assert_eq!(object.object_record().closed_holes.len(), 1);
    let patch = object.shape().closed_patches()[0].clone();
    let measure = object.measure(&Convention::paper()).unwrap();
    let start = [
        [0.039, 0.0, 0.01],
        [-0.02, 0.034, 0.0],
        [-0.02, -0.034, 0.0],
    ]
    .map(|p| (Point3::from(p) + centre).into());
    let grasp = measure.grasp_at(&start).unwrap();
    let better = measure.ascend(&grasp).unwrap();
    assert!(better.quality() >= grasp.quality());
    for contact in better.contacts() {
        assert!(patch.distance(&contact.position) >= 0.0);
    }
    record.closed_holes[0].reach_m = f64::NAN;
    assert!(Object::from_spherical_record(&record).is_err());
}

#[test]
fn a_finger_on_a_closed_hole_has_no_contact() {
    let (cloud, directions) = ball();
    let object = Object::from_directions("ball", &cloud, &directions, &SETTINGS).unwrap();
    let hand = Hand::schunk_sdh().unwrap();
    let poses = Poses {
        count: 60,
        ..Poses::default()
    };
    let measure = object.measure(&Convention::paper()).unwrap();
    let grasps = measure.synthesize(&hand, &poses).unwrap();
    let grasp = &grasps.best(1)[0];
    let placed = grasp.hand().unwrap();
    let pose = object.frame().pose_to_cloud(&placed.centred_from_palm);
    let contacts = |object: &Object| {
        let hands = HandContacts::new(object, &hand).unwrap();
        hands.of(&pose, &placed.joints).unwrap()
    };
    let open = contacts(&object);
    assert!(open.without.is_empty(), "{:?}", open.without);
    let mut record = object.to_spherical_record().unwrap();
    record.closed_holes = vec![moduli::record::ClosedHoleRecord {
        places_m: vec![open.contacts[1].position.into()],
        reach_m: 0.01,
        area_m2: 1e-4,
    }];
    let closed = contacts(&Object::from_spherical_record(&record).unwrap());
    assert_eq!(closed.contacts.len(), open.contacts.len() - 1);
    assert_eq!(closed.without[0].1, NoContact::ClosedHole);
}

#[test]
fn stored_nonsense_is_refused() {
    let (cloud, directions) = ball();
    let object = Object::from_directions("ball", &cloud, &directions, &SETTINGS).unwrap();
    let mut lost = object.to_spherical_record().unwrap();
    lost.centre_in_cloud_m[0] = f64::NAN;
    assert!(Object::from_spherical_record(&lost).is_err());
    let mut flat = object.to_spherical_record().unwrap();
    flat.coordinates[2].fill(0.0);
    assert!(Object::from_spherical_record(&flat).is_err());
    let mut inside_out = object.to_spherical_record().unwrap();
    inside_out.coordinates[0].iter_mut().for_each(|b| *b = -*b);
    assert!(Object::from_spherical_record(&inside_out).is_err());
    let few = Object::from_directions("ball", &cloud, &directions[1..], &SETTINGS);
    assert!(matches!(
        few,
        Err(Error::DirectionCount {
            directions: 299,
            points: 300
        })
    ));
}
