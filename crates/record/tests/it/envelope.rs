//! The header of binary records.

use record::EnvelopeError;
use record::envelope::{Kind, decode, encode, kind_of};

fn wrapped() -> Vec<u8> {
    encode(Kind::Shape, &vec![1.5_f64, -2.0]).unwrap()
}

#[test]
fn comes_back() {
    assert_eq!(
        decode::<Vec<f64>>(Kind::Shape, &wrapped()),
        Ok(vec![1.5, -2.0])
    );
    assert_eq!(kind_of(&wrapped()), Some(Kind::Shape));
    assert_eq!(kind_of(b"ply\nformat ascii 1.0\n and so on"), None);
}

#[test]
fn every_damage_is_named() {
    let good = wrapped();
    let read = |bytes: &[u8]| decode::<Vec<f64>>(Kind::Shape, bytes);
    assert_eq!(read(b"ply"), Err(EnvelopeError::Magic));
    assert!(matches!(
        decode::<Vec<f64>>(Kind::Library, &good),
        Err(EnvelopeError::Kind {
            expected: "library",
            ..
        })
    ));
    let mut newer = good.clone();
    newer[10] = 9;
    assert!(matches!(
        read(&newer),
        Err(EnvelopeError::Version { found: 9, .. })
    ));
    assert!(matches!(
        read(&good[..good.len() - 1]),
        Err(EnvelopeError::Length { .. })
    ));
    let mut flipped = good.clone();
    *flipped.last_mut().unwrap() ^= 1;
    assert_eq!(read(&flipped), Err(EnvelopeError::Checksum));
    assert!(matches!(
        decode::<Vec<Vec<u64>>>(Kind::Shape, &good),
        Err(EnvelopeError::Body { .. })
    ));
}
