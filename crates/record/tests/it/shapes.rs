//! Shape and library files.

use record::{EnvelopeError, LibraryGrasp, LibraryRecord, ShapeRecord};

fn shape() -> ShapeRecord {
    ShapeRecord {
        name: "ball".to_owned(),
        coefficients: vec![0.14, 0.0, 0.0, 0.01],
        centre_in_cloud_m: [0.1, 0.2, 0.3],
        lambda: 1e-3,
        rms_m: 1e-4,
        points: 25_000,
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
