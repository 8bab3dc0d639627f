//! Robust quality by the evidence of a cloud.

use moduli::nalgebra::Point3;
use moduli::{Convention, Evidence, Hand, PointCloud, Poses, TipModel};

use crate::common::ellipsoid;

const AXES: [f64; 3] = [0.035, 0.030, 0.045];

/// The points of an ellipsoid in its own frame, up to the height `top`.
fn cloud(top: f64) -> PointCloud {
    let directions = sph::direction::even_directions(20_000);
    let points = directions
        .iter()
        .map(|p| Point3::new(AXES[0] * p.x, AXES[1] * p.y, AXES[2] * p.z));
    PointCloud::new(points.filter(|p| p.z <= top).collect()).unwrap()
}

fn known(distance: f64, degrees: f64) -> Evidence {
    Evidence {
        distance,
        normal_spread: degrees.to_radians(),
        seen: true,
    }
}

#[test]
fn what_the_cloud_leaves_open_lowers_the_quality() {
    let object = ellipsoid(AXES, [0.0; 3]);
    let measure = object.measure(&Convention::paper()).unwrap();
    let points = [
        [0.035, 0.0, 0.0],
        [-0.018, 0.026, 0.0],
        [-0.018, -0.026, 0.0],
    ];
    let grasp = measure.grasp_at(&points).unwrap();
    let lower = grasp.epsilon().lower;
    let robust = |evidence: &[Evidence]| measure.robust(&grasp, evidence).unwrap();
    // With nothing uncertain only the pyramid's loss against the round cone inside it is left.
    let exact = robust(&[known(0.0, 0.0); 3]);
    assert!(exact <= lower && exact >= 0.9 * lower, "{exact} of {lower}");
    let slight = robust(&[known(2e-4, 3.0); 3]);
    assert!(slight > 0.0 && slight < exact, "{slight} of {exact}");
    // Beyond the friction cone's 45° a contact carries nothing.
    assert_eq!(robust(&[known(0.0, 46.0); 3]), 0.0);
    // The cloud itself: smooth within the pads, so that something is certain.
    let evidence = measure.evidence(&grasp, &cloud(1.0));
    assert!(evidence.iter().all(|e| e.seen && e.distance < 1e-3));
    let measured = robust(&evidence);
    assert!(measured > 0.0 && measured < exact, "{measured} of {exact}");
    // An unseen contact carries nothing.
    let unseen = measure.evidence(&grasp, &cloud(-0.02));
    assert!(unseen.iter().all(|e| !e.seen));
    assert_eq!(robust(&unseen), 0.0);
    // One entry per contact.
    assert!(measure.robust(&grasp, &evidence[..2]).is_err());
}

#[test]
fn two_soft_fingers_have_a_robust_quality_and_two_points_have_none() {
    let object = ellipsoid(AXES, [0.0; 3]);
    let measure = object.measure(&Convention::paper()).unwrap();
    let grasp =
        |m: &moduli::Measure<'_>| m.grasp_at(&[[0.0, 0.03, 0.0], [0.0, -0.03, 0.0]]).unwrap();
    let evidence = [known(1e-4, 2.0); 2];
    let points = measure.robust(&grasp(&measure), &evidence).unwrap();
    assert_eq!(points, 0.0);
    let soft = measure.with_tips(TipModel::Soft { radius: 0.01 });
    let held = grasp(&soft);
    let robust = soft.robust(&held, &evidence).unwrap();
    assert!(robust > 0.0 && robust < held.epsilon().lower, "{robust}");
    // All metrics take the contacts as the measure has them.
    assert!(soft.metrics(&held).unwrap().epsilon.closed);
}

#[test]
fn a_grasps_file_has_the_evidence_for_each_contact() {
    let object = ellipsoid(AXES, [0.0; 3]);
    let measure = object.measure(&Convention::paper()).unwrap();
    let hand = Hand::schunk_sdh().unwrap();
    let poses = Poses {
        count: 40,
        ..Poses::default()
    };
    let found = measure.synthesize(&hand, &poses).unwrap();
    let grasps: Vec<moduli::Grasp> = found.iter().cloned().collect();
    let mut file = measure.grasps_file(&hand, &grasps);
    measure
        .add_evidence(&hand, &mut file.grasps, &grasps, &cloud(0.02))
        .unwrap();
    let text = file.to_json().unwrap();
    let json: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let (mut seen, mut unseen) = (0, 0);
    for (record, grasp) in json["grasps"].as_array().unwrap().iter().zip(&grasps) {
        let robust = record["robust_quality"].as_f64().unwrap();
        assert!((0.0..=grasp.epsilon().lower).contains(&robust), "{record}");
        let contacts = record["contacts"].as_array().unwrap();
        assert_eq!(contacts.len(), grasp.contacts().len());
        for contact in contacts {
            assert!(contact["distance_to_cloud_m"].as_f64().unwrap() >= 0.0);
            let spread = contact.get("normal_spread_deg");
            if contact["seen"].as_bool().unwrap() {
                seen += 1;
                assert!((0.0..=90.0).contains(&spread.unwrap().as_f64().unwrap()));
            } else {
                unseen += 1;
                assert!(spread.is_none() && robust == 0.0, "{record}");
            }
        }
    }
    assert!(seen > 0 && unseen > 0, "{seen} seen, {unseen} unseen");
    assert_eq!(record::GraspsFile::from_json(&text).unwrap(), file);
}
