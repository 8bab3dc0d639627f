//! `grasps.json`: what is written, and which files can be read.

use record::grasps::{
    AssessmentRecord, CentreRecord, ConventionRecord, EdgeNormRecord, EdgesRecord, GRASPS_VERSION,
    JointRecord, JointUnit, ObjectRecord, SourceRecord, SurfaceModel, TangentRecord,
};
use record::{GraspRecord, GraspsFile, GraspsFileError};
use serde_json::{Value, json};

/// A grasp with two contacts and without a hand.
pub(crate) fn grasp(quality: f64, source: SourceRecord) -> GraspRecord {
    GraspRecord {
        rank: 1,
        quality,
        contacts_m: vec![[0.13, 0.2, 0.3], [0.07, 0.2, 0.3]],
        inward_normals: vec![[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        directions: vec![[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]],
        source,
        hand: None,
        assessment: AssessmentRecord::default(),
    }
}

fn convention() -> ConventionRecord {
    ConventionRecord {
        name: "frogger".to_owned(),
        edge_norm: EdgeNormRecord::UnitLength,
        torque_length_m: Some(1.0),
        centre: CentreRecord::ObjectOrigin,
        friction: 0.7,
        edges: EdgesRecord::Polygon(4),
        not_closed: -1.0,
        tangent: TangentRecord::Projected([1.2, 2.3, 3.4]),
        stable_above: None,
        contact: None,
    }
}

pub(crate) fn file() -> GraspsFile {
    let transfer = SourceRecord::Transfer {
        from: Some("S5 shampoo bottle".to_owned()),
        shape_distance_m: Some(0.02),
        source_quality: Some(0.4),
    };
    GraspsFile {
        version: GRASPS_VERSION,
        object: ObjectRecord {
            name: "ball".to_owned(),
            centre_m: [0.1, 0.2, 0.3],
            r_min_certified_m: 0.03,
            r_max_certified_m: 0.04,
            centre_of_mass_m: [0.1, 0.2, 0.3],
            volume_m3: 1e-4,
            ..ObjectRecord::default()
        },
        convention: convention(),
        grasps: vec![
            grasp(0.5, transfer),
            grasp(0.25, SourceRecord::Synthesis),
            grasp(0.125, SourceRecord::Other("drawn by hand".to_owned())),
        ],
    }
}

fn hand() -> Value {
    json!({
        "name": "jaws",
        "palm_link": "base",
        "object_from_palm": {"translation_m": [0.0, 0.0, 0.1], "quaternion_xyzw": [0.0, 0.0, 0.0, 1.0]},
        "joints_rad": {"slide": 0.0205, "turn": 0.5},
        "pregrasp_joints_rad": {"slide": 0.04, "turn": 0.0},
        "contact_error_m": 0.0,
    })
}

/// The file as JSON after a change.
fn changed(change: impl FnOnce(&mut Value)) -> Result<GraspsFile, GraspsFileError> {
    let mut value = serde_json::to_value(file()).unwrap();
    change(&mut value);
    GraspsFile::from_json(value.to_string().as_bytes())
}

#[test]
fn a_file_reads_back_as_it_was() {
    let read = GraspsFile::from_json(&file().to_json().unwrap()).unwrap();
    assert_eq!(read, file());
}

#[test]
fn the_keys_of_version_1_are_all_written() {
    let value = serde_json::to_value(file()).unwrap();
    let keys =
        |value: &Value| -> Vec<String> { value.as_object().unwrap().keys().cloned().collect() };
    let has = |value: &Value, wanted: &[&str]| {
        let found = keys(value);
        for key in wanted {
            assert!(
                found.contains(&(*key).to_owned()),
                "{key} is not in {found:?}"
            );
        }
    };
    has(&value, &["version", "object", "convention", "grasps"]);
    has(
        &value["convention"],
        &[
            "name",
            "edge_norm",
            "torque_length_m",
            "centre",
            "friction",
            "edges",
            "not_closed",
            "tangent",
            "tangent_axis",
        ],
    );
    assert_eq!(value["convention"]["edge_norm"], "unit_length");
    assert_eq!(value["convention"]["centre"], "object_origin");
    assert_eq!(value["convention"]["tangent"], "projected");
    for grasp in value["grasps"].as_array().unwrap() {
        has(
            grasp,
            &[
                "rank",
                "quality",
                "contacts_m",
                "inward_normals",
                "source",
                "hand",
            ],
        );
        has(
            &grasp["source"],
            &["kind", "from", "shape_distance_m", "source_quality"],
        );
    }
    assert_eq!(value["grasps"][0]["source"]["kind"], "transfer");
    assert_eq!(value["grasps"][1]["source"]["kind"], "synthesis");
    assert_eq!(value["grasps"][1]["source"]["from"], Value::Null);
    assert_eq!(value["grasps"][2]["source"]["kind"], "drawn by hand");
}

#[test]
fn files_from_before_tangents_directions_and_tolerances_are_read() {
    let read = changed(|value| {
        let convention = value["convention"].as_object_mut().unwrap();
        for key in ["tangent", "tangent_axis", "tolerance"] {
            convention.remove(key);
        }
        convention["edges"] = Value::Null;
        for grasp in value["grasps"].as_array_mut().unwrap() {
            grasp.as_object_mut().unwrap().remove("directions");
        }
    })
    .unwrap();
    assert_eq!(read.convention.tangent, TangentRecord::LeastAligned);
    let round = EdgesRecord::Round { tolerance: 1e-4 };
    assert_eq!(read.convention.edges, round);
    assert!(read.grasps[0].directions.is_empty());
}

#[test]
fn the_tolerance_of_a_round_cone_is_kept() {
    let mut round = file();
    round.convention.edges = EdgesRecord::Round { tolerance: 3e-7 };
    let text = round.to_json().unwrap();
    let value: Value = serde_json::from_slice(&text).unwrap();
    assert_eq!(value["convention"]["edges"], Value::Null);
    assert_eq!(value["convention"]["tolerance"], 3e-7);
    assert_eq!(GraspsFile::from_json(&text).unwrap(), round);
}

#[test]
fn joints_have_a_unit_each_and_the_older_keys_stay() {
    let older = changed(|value| value["grasps"][0]["hand"] = hand()).unwrap();
    let mut hand = older.grasps[0].hand.clone().unwrap();
    let bare = JointRecord {
        value: 0.0205,
        unit: None,
        follows: None,
    };
    assert_eq!(hand.joints["slide"], bare);
    hand.joints.get_mut("slide").unwrap().unit = Some(JointUnit::Metres);
    hand.joints.get_mut("turn").unwrap().unit = Some(JointUnit::Radians);
    let value = serde_json::to_value(&hand).unwrap();
    assert_eq!(
        value["joints"]["slide"],
        json!({"value": 0.0205, "unit": "m"})
    );
    assert_eq!(
        value["joints"]["turn"],
        json!({"value": 0.5, "unit": "rad"})
    );
    assert_eq!(value["joints_rad"], json!({"slide": 0.0205, "turn": 0.5}));
    assert_eq!(value["pregrasp_joints_rad"]["slide"], 0.04);
    let read: record::grasps::HandRecord = serde_json::from_value(value).unwrap();
    assert_eq!(read, hand);
}

#[test]
fn a_file_of_version_2_is_read() {
    let read = changed(|value| {
        value["version"] = json!(2);
        value["object"]["model"] = json!("spherical");
        value["object"]["support"] = json!({"normal": [0.0, 0.0, 1.0], "offset_m": -0.04});
        value["object"]["residuals"] = json!({"surface_rms_m": 1e-4});
        value["convention"]["stable_above"] = json!(0.01);
        let grasp = &mut value["grasps"][0];
        grasp["lower"] = json!(0.49);
        grasp["hold_parts"] = json!({"friction_needed": 0.4});
        let contact = json!({
            "point_m": [0.13, 0.2, 0.3], "inward_normal": [-1.0, 0.0, 0.0],
            "direction": [1.0, 0.0, 0.0], "distance_to_cloud_m": 1e-4,
            "normal_spread_deg": 3.0, "seen": true,
        });
        grasp["contacts"] = json!([contact, contact]);
        let mut hand = hand();
        hand["approach_direction"] = json!([0.0, 0.0, -1.0]);
        hand["squeeze_joints"] = json!({"slide": {"value": 0.01, "unit": "m"}});
        grasp["hand"] = hand;
    })
    .unwrap();
    assert_eq!(read.version, 2);
    assert_eq!(read.object.model, Some(SurfaceModel::Spherical));
    assert_eq!(read.object.support.unwrap().offset_m, -0.04);
    assert_eq!(read.convention.stable_above, Some(0.01));
    let grasp = &read.grasps[0];
    let assessment = &grasp.assessment;
    assert_eq!(
        (assessment.lower, assessment.contacts[1].seen),
        (Some(0.49), Some(true))
    );
    let execution = &grasp.hand.as_ref().unwrap().execution;
    assert_eq!(execution.approach_direction, Some([0.0, 0.0, -1.0]));
    assert_eq!(execution.squeeze_joints["slide"].value, 0.01);
    let again = GraspsFile::from_json(&read.to_json().unwrap()).unwrap();
    assert_eq!(again, read);
}

#[test]
fn what_is_wrong_is_named() {
    let error = changed(|value| value["version"] = json!(3)).unwrap_err();
    assert!(matches!(error, GraspsFileError::Version { found: 3 }));
    let error = changed(|value| value["convention"]["tangent_axis"] = Value::Null).unwrap_err();
    assert!(error.to_string().contains("`tangent_axis`"), "{error}");
    let error = changed(|value| value["convention"]["centre"] = json!("middle")).unwrap_err();
    assert!(error.to_string().contains("cloud_mean"), "{error}");
    let error = changed(|value| {
        value["grasps"][1]["inward_normals"]
            .as_array_mut()
            .unwrap()
            .pop();
    })
    .unwrap_err();
    assert!(matches!(
        error,
        GraspsFileError::Lengths {
            grasp: 1,
            contacts: 2,
            key: "inward_normals",
            other: 1,
        }
    ));
    assert!(matches!(
        GraspsFile::from_json(b"{}"),
        Err(GraspsFileError::Json(_))
    ));
}
