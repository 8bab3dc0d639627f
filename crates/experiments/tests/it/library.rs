//! Building the library reproduces the stored one.

use experiments::library::{LibrarySettings, build};
use grasp::Convention;
use moduli::records::stored_shape;
use record::{LibraryEntry, LibraryRecord};

const STORED: &[u8] = fixtures::LIBRARY;

/// Relative tolerance: the last digits depend on the order in which a processor's vector unit adds.
const RELATIVE: f64 = 1e-6;

/// Each number to 1e-6 of the largest of its list.
fn assert_close(what: &str, built: &[f64], stored: &[f64]) {
    assert_eq!(built.len(), stored.len(), "{what}");
    let scale = stored.iter().fold(0.0_f64, |s, v| s.max(v.abs()));
    for (k, (a, b)) in built.iter().zip(stored).enumerate() {
        assert!(
            (a - b).abs() <= RELATIVE * scale,
            "{what}, {k}: {a} and {b}"
        );
    }
}

fn assert_same_entry(built: &LibraryEntry, stored: &LibraryEntry) {
    let id = &stored.id;
    assert_eq!((&built.id, &built.name), (id, &stored.name));
    assert_eq!(built.shape.points, stored.shape.points);
    assert_close(
        &format!("{id}: β"),
        &built.shape.coefficients,
        &stored.shape.coefficients,
    );
    assert_close(
        &format!("{id}: centre"),
        &built.shape.centre_in_cloud_m,
        &stored.shape.centre_in_cloud_m,
    );
    assert_close(
        &format!("{id}: rms"),
        &[built.shape.rms_m],
        &[stored.shape.rms_m],
    );
    assert_eq!(built.grasps.len(), stored.grasps.len(), "{id}");
    for (k, (a, b)) in built.grasps.iter().zip(&stored.grasps).enumerate() {
        let what = |part: &str| format!("{id}, grasp {k}: {part}");
        let (da, db) = (a.directions.concat(), b.directions.concat());
        assert_close(&what("directions"), &da, &db);
        assert_close(&what("quality"), &[a.quality], &[b.quality]);
        assert_close(&what("palm"), &a.palm_translation_m, &b.palm_translation_m);
        assert_close(
            &what("turn"),
            &a.palm_quaternion_xyzw,
            &b.palm_quaternion_xyzw,
        );
        assert_close(&what("joints"), &a.joints_rad, &b.joints_rad);
    }
}

#[test]
fn building_again_gives_the_stored_library() {
    let stored = LibraryRecord::from_bytes(STORED).unwrap();
    let convention = Convention::named("paper").unwrap();
    let built = build(&LibrarySettings::standard(convention)).unwrap();
    assert_eq!(
        (built.seed, &built.convention, &built.hand),
        (stored.seed, &stored.convention, &stored.hand)
    );
    assert_eq!(built.entries.len(), stored.entries.len());
    for (a, b) in built.entries.iter().zip(&stored.entries) {
        assert_same_entry(a, b);
    }
}

#[test]
fn the_stored_library_is_usable_and_its_grasps_are_spread_out() {
    let stored = LibraryRecord::from_bytes(STORED).unwrap();
    let settings = LibrarySettings::standard(Convention::named("paper").unwrap());
    for entry in &stored.entries {
        let shape = stored_shape(&entry.shape).unwrap();
        let (low, high) = shape.radius_bounds();
        assert!(low > 0.005 && high < 0.2, "{}: {low} to {high}", entry.id);
        assert_eq!(entry.grasps.len(), settings.kept.grasps, "{}", entry.id);
        assert!(entry.grasps.is_sorted_by(|a, b| a.quality >= b.quality));
        let radius = shape.mean_radius();
        let contacts: Vec<_> = entry
            .grasps
            .iter()
            .map(|g| space::point::contacts_on(&shape, &g.directions().unwrap()))
            .collect();
        for (k, a) in contacts.iter().enumerate() {
            for b in &contacts[..k] {
                let apart = moduli::separation(a, b, radius).unwrap();
                assert!(
                    apart >= settings.kept.separation - 1e-9,
                    "{}: {apart}",
                    entry.id
                );
            }
        }
    }
}
