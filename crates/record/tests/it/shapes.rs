//! Shape and library files.

use record::{
    ClosedHoleRecord, EnvelopeError, LibraryGrasp, LibraryRecord, ShapeRecord, SphericalRecord,
};

fn shape() -> ShapeRecord {
    ShapeRecord {
        name: "ball".to_owned(),
        coefficients: vec![0.14, 0.0, 0.0, 0.01],
        centre_in_cloud_m: [0.1, 0.2, 0.3],
        lambda: 1e-3,
        rms_m: 1e-4,
        points: 25_000,
        notes: record::ShapeNotes::default(),
    }
}

#[test]
fn a_shape_reads_back_as_it_was() {
    let bytes = shape().to_bytes().unwrap();
    assert_eq!(ShapeRecord::from_bytes(&bytes), Ok(shape()));
    assert!(matches!(
        LibraryRecord::from_bytes(&bytes),
        Err(EnvelopeError::Kind {
            expected: "library",
            ..
        })
    ));
}

#[test]
fn a_shape_keeps_its_notes_and_one_without_them_is_read() {
    let mut noted = shape();
    noted.notes = record::ShapeNotes {
        support: Some(record::grasps::SupportRecord {
            normal: [0.0, 0.0, 1.0],
            offset_m: -0.05,
        }),
        residuals: [("noise_m".to_owned(), 2e-4)].into(),
        warnings: vec!["one side was not seen".to_owned()],
    };
    let bytes = noted.to_bytes().unwrap();
    assert_eq!(ShapeRecord::from_bytes(&bytes), Ok(noted));
    // The layout of version 1: the shape alone.
    let mut old = record::envelope::encode(record::Kind::Shape, &shape()).unwrap();
    old[10] = 1;
    assert_eq!(ShapeRecord::from_bytes(&old), Ok(shape()));
    old[10] = 3;
    assert!(matches!(
        ShapeRecord::from_bytes(&old),
        Err(EnvelopeError::Version { found: 3, .. })
    ));
}

#[test]
fn directions_of_another_length_than_one_are_refused() {
    let mut grasp = LibraryGrasp {
        directions: vec![[0.0, 0.6, 0.8], [1.0, 0.0, 0.0]],
        quality: 0.5,
        palm_translation_m: [0.0, 0.0, 0.1],
        palm_quaternion_xyzw: [0.0; 4],
        joints_rad: Vec::new(),
    };
    assert_eq!(grasp.directions().unwrap().len(), 2);
    assert_eq!(grasp.centred_from_palm().rotation.angle(), 0.0);
    grasp.directions[1][0] = 1.0 + 2e-6;
    assert_eq!(grasp.directions(), None);
    grasp.directions[1][0] = f64::NAN;
    assert_eq!(grasp.directions(), None);
}

#[test]
fn a_spherical_shape_keeps_its_closed_holes_and_one_without_them_is_read() {
    let plain = SphericalRecord {
        name: "mug".to_owned(),
        coordinates: [vec![0.0, 0.01], vec![0.0, 0.02], vec![0.0, 0.03]],
        centre_in_cloud_m: [0.1, 0.2, 0.3],
        lambda: [1e-6; 3],
        rms_m: 3e-4,
        points: 25_000,
        notes: record::ShapeNotes::default(),
        closed_holes: Vec::new(),
    };
    let mut noted = plain.clone();
    noted.notes.warnings = vec!["a hole was closed".to_owned()];
    noted.closed_holes = vec![ClosedHoleRecord {
        places_m: vec![[0.03, 0.0, 0.04], [0.031, 0.0, 0.04]],
        reach_m: 3e-3,
        area_m2: 8e-4,
    }];
    let bytes = noted.to_bytes().unwrap();
    assert_eq!(SphericalRecord::from_bytes(&bytes), Ok(noted));
    // The layout of version 1: the shape alone.
    let mut old = record::envelope::encode(record::Kind::Spherical, &plain).unwrap();
    old[10] = 1;
    assert_eq!(SphericalRecord::from_bytes(&old), Ok(plain));
    old[10] = 3;
    assert!(matches!(
        SphericalRecord::from_bytes(&old),
        Err(EnvelopeError::Version { found: 3, .. })
    ));
}
