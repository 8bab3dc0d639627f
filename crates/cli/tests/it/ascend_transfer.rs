//! `ascend` and `transfer` as a user runs them.

use std::path::Path;

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{fitted, moduli, refused, stdout};

/// Two objects and two grasps on the first, which is centred at (1, 0, 0.2).
fn prepared() -> TempDir {
    let folder = TempDir::new().unwrap();
    fitted(folder.path(), "egg", [0.035, 0.030, 0.045], [1.0, 0.0, 0.2]);
    fitted(
        folder.path(),
        "ball",
        [0.04, 0.038, 0.036],
        [0.0, -0.5, 0.0],
    );
    let grasp = |angles: [f64; 3], height: f64| {
        let contacts: Vec<[f64; 3]> = angles
            .iter()
            .map(|a| [1.0 + 0.034 * a.cos(), 0.029 * a.sin(), 0.2 + height])
            .collect();
        json!({
            "rank": 1, "quality": 0.0, "contacts_m": contacts,
            "inward_normals": [[1, 0, 0], [1, 0, 0], [1, 0, 0]],
            "source": {"kind": "synthesis", "from": null, "shape_distance_m": null,
                       "source_quality": null},
            "hand": null,
        })
    };
    let file = json!({
        "version": 1,
        "object": {"name": "egg", "centre_m": [1.0, 0.0, 0.2], "r_min_certified_m": 0.03,
                   "r_max_certified_m": 0.045, "centre_of_mass_m": [1.0, 0.0, 0.2],
                   "volume_m3": 2e-4},
        "convention": {"name": "paper", "edge_norm": "unit_normal_component",
                       "torque_length_m": 0.01, "centre": "cloud_mean", "friction": 1.0,
                       "edges": 10, "not_closed": 0.0},
        "grasps": [grasp([0.2, 2.3, 4.0], 0.004), grasp([0.0, 1.6, 3.9], -0.006)],
    });
    std::fs::write(folder.path().join("grasps.json"), file.to_string()).unwrap();
    folder
}

fn read(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join(name)).unwrap()).unwrap()
}

/// Distances of all contacts of a file from a point.
fn arms(file: &Value, centre: [f64; 3]) -> Vec<f64> {
    let contacts = file["grasps"].as_array().unwrap().iter();
    contacts
        .flat_map(|g| g["contacts_m"].as_array().unwrap())
        .map(|c| {
            let square = |k: usize| (c[k].as_f64().unwrap() - centre[k]).powi(2);
            (square(0) + square(1) + square(2)).sqrt()
        })
        .collect()
}

/// Any two contacts of a grasp are between `least` and `most` metres apart.
fn assert_apart(file: &Value, least: f64, most: f64) {
    for grasp in file["grasps"].as_array().unwrap() {
        let at: Vec<Vec<f64>> = serde_json::from_value(grasp["contacts_m"].clone()).unwrap();
        for (i, a) in at.iter().enumerate() {
            for b in &at[i + 1..] {
                let apart: f64 = a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum();
                assert!((least - 1e-9..=most + 1e-9).contains(&apart.sqrt()));
            }
        }
    }
}

#[test]
fn ascending_improves_and_leaves_a_trace() {
    let folder = prepared();
    let here = folder.path();
    let line = stdout(&moduli(
        here,
        &[
            "ascend",
            "egg.shape",
            "grasps.json",
            "-o",
            "better.json",
            "--trace",
            "trace.json",
            "--json",
        ],
    ));
    let summary: Value = serde_json::from_str(&line).unwrap();
    assert_eq!(summary["grasps"], 2);
    assert_eq!(summary["below_start"], 0);
    assert_eq!(summary["improved"], 2);
    let better = read(here, "better.json");
    let qualities: Vec<f64> = better["grasps"]
        .as_array()
        .unwrap()
        .iter()
        .map(|g| g["quality"].as_f64().unwrap())
        .collect();
    assert!(qualities.is_sorted_by(|a, b| a >= b));
    assert_eq!(summary["best"].as_f64().unwrap(), qualities[0]);
    for arm in arms(&better, [1.0, 0.0, 0.2]) {
        assert!((0.029..0.046).contains(&arm), "{arm} m from the centre");
    }
    let trace = read(here, "trace.json");
    for grasp in trace["grasps"].as_array().unwrap() {
        let steps = grasp["steps"].as_array().unwrap();
        assert!(steps.len() > 2);
        let quality = |s: &Value| s["quality"].as_f64().unwrap();
        assert!(steps.windows(2).all(|w| quality(&w[1]) >= quality(&w[0])));
        assert!(steps.iter().all(|s| s["contacts_m"][2].is_array()));
    }
    // What comes out can go in again, and its quality is what the summary says.
    let again = stdout(&moduli(here, &["quality", "better.json", "--json"]));
    let again: Value = serde_json::from_str(&again).unwrap();
    let (a, b) = (&again["mean"], &summary["mean_final"]);
    assert!((a.as_f64().unwrap() - b.as_f64().unwrap()).abs() <= 1e-9);
}

#[test]
fn limits_of_an_ascent_are_kept_or_refused() {
    let folder = prepared();
    let here = folder.path();
    stdout(&moduli(
        here,
        &[
            "ascend",
            "egg.shape",
            "grasps.json",
            "-o",
            "held.json",
            "--allow",
            "0,0,1,100",
            "--separation",
            "30",
            "--reach",
            "65",
        ],
    ));
    let held = read(here, "held.json");
    assert_apart(&held, 0.03, 0.065);
    let with = |more: &[&'static str]| {
        let mut arguments = vec!["ascend", "egg.shape", "grasps.json"];
        arguments.extend(more);
        moduli(here, &arguments)
    };
    refused(
        &with(&["--separation", "500"]),
        4,
        &["grasp 0", "least separation"],
    );
    refused(&with(&["--reach", "-1"]), 2, &["--reach -1", "millimetres"]);
    refused(&with(&["--allow", "0,0,1"]), 2, &["--allow 0,0,1"]);
    refused(
        &with(&["--scheme", "paper", "--reach", "100"]),
        2,
        &["--scheme ours"],
    );
}

#[test]
fn transfers_end_on_the_target_in_its_own_frame() {
    let folder = prepared();
    let here = folder.path();
    let carry = |scheme: &str| -> Value {
        let line = stdout(&moduli(
            here,
            &[
                "transfer",
                "--from",
                "egg.shape",
                "--to",
                "ball.shape",
                "grasps.json",
                "-o",
                "carried.json",
                "--trace",
                "way.json",
                "--scheme",
                scheme,
                "--json",
            ],
        ));
        for arm in arms(&read(here, "carried.json"), [0.0, -0.5, 0.0]) {
            assert!((0.035..0.041).contains(&arm), "{arm} m from the centre");
        }
        serde_json::from_str(&line).unwrap()
    };
    let naive = carry("naive");
    let ours = carry("ours");
    let q = |v: &Value| v["mean_final"].as_f64().unwrap();
    assert_eq!(ours["unstable"], 0);
    assert!(q(&ours) >= q(&naive));
    assert_eq!(ours["mean_start"], naive["mean_start"]);
    let way = read(here, "way.json");
    let steps = way["grasps"][0]["steps"].as_array().unwrap();
    assert_eq!(steps[0]["t"], 0.0);
    assert_eq!(steps.last().unwrap()["t"], 1.0);
    let carried = read(here, "carried.json");
    assert_eq!(carried["object"]["name"], "ball");
    assert_eq!(carried["grasps"][0]["source"]["from"], "egg");
}

#[test]
fn limits_of_a_transfer_are_kept_or_refused() {
    let folder = prepared();
    let here = folder.path();
    let with = |more: &[&'static str]| {
        let mut arguments = vec!["transfer", "--from", "egg.shape", "--to", "ball.shape"];
        arguments.extend(["grasps.json", "-o", "held.json"]);
        arguments.extend(more);
        moduli(here, &arguments)
    };
    stdout(&with(&["--separation", "35", "--reach", "60"]));
    let held = read(here, "held.json");
    assert_apart(&held, 0.035, 0.060);
    refused(&with(&["--separation", "500"]), 4, &["grasp 0", "limits"]);
    refused(&with(&["--scheme", "naive", "--reach", "60"]), 2, &["ours"]);
}

#[test]
fn pairs_that_would_share_a_file_are_refused() {
    let folder = prepared();
    let here = folder.path();
    for name in ["a", "a-to-b"] {
        std::fs::copy(here.join("egg.shape"), here.join(format!("{name}.shape"))).unwrap();
    }
    for name in ["b-to-c", "c"] {
        std::fs::copy(here.join("ball.shape"), here.join(format!("{name}.shape"))).unwrap();
    }
    let arguments = "transfer --from a.shape --from a-to-b.shape --to b-to-c.shape --to c.shape \
                     grasps.json grasps.json -o all";
    let arguments: Vec<&str> = arguments.split_whitespace().collect();
    refused(&moduli(here, &arguments), 2, &["a-to-b-to-c.json"]);
}

#[test]
fn many_transfers_go_on_where_they_were_interrupted() {
    let folder = prepared();
    let here = folder.path();
    fitted(here, "drop", [0.03, 0.036, 0.04], [0.1, 0.0, 0.0]);
    let whole = |more: &[&str]| -> Value {
        let arguments = "transfer --from egg.shape --to ball.shape --to drop.shape --to egg.shape \
                         grasps.json -o all --scheme naive --json";
        let arguments: Vec<&str> = arguments.split_whitespace().collect();
        let line = stdout(&moduli(here, &[&arguments[..], more].concat()));
        serde_json::from_str(&line).unwrap()
    };
    let first = whole(&[]);
    // Not from the egg to itself.
    assert_eq!(first["pairs"].as_array().unwrap().len(), 2);
    assert_eq!(
        (&first["kept_pairs"], &first["grasps"]),
        (&0.into(), &4.into())
    );
    let (ball, drop) = (
        here.join("all/egg-to-ball.json"),
        here.join("all/egg-to-drop.json"),
    );
    let bytes = [std::fs::read(&ball).unwrap(), std::fs::read(&drop).unwrap()];
    let table = std::fs::read(here.join("all/transfers.json")).unwrap();
    for arm in arms(&read(here, "all/egg-to-ball.json"), [0.0, -0.5, 0.0]) {
        assert!((0.035..0.041).contains(&arm), "{arm} m from the centre");
    }

    std::fs::write(&ball, &bytes[0][..200]).unwrap();
    let second = whole(&["--threads", "1"]);
    assert_eq!(second["kept_pairs"], 1);
    assert_eq!(second["pairs"], first["pairs"]);
    assert_eq!(std::fs::read(&ball).unwrap(), bytes[0]);
    assert_eq!(std::fs::read(&drop).unwrap(), bytes[1]);
    assert_eq!(
        std::fs::read(here.join("all/transfers.json")).unwrap(),
        table
    );
    assert_eq!(whole(&[])["kept_pairs"], 2);
    // A result that somebody has changed is computed again.
    let text = String::from_utf8(bytes[0].clone()).unwrap();
    let quality = read(here, "all/egg-to-ball.json")["grasps"][0]["quality"].to_string();
    std::fs::write(&ball, text.replacen(&quality, "9.9", 1)).unwrap();
    let third = whole(&[]);
    assert_eq!(
        (&third["kept_pairs"], &third["pairs"]),
        (&1.into(), &first["pairs"])
    );
    assert_eq!(std::fs::read(&ball).unwrap(), bytes[0]);
    // What was done under other terms is done again.
    assert_eq!(whole(&["--friction", "0.9"])["kept_pairs"], 0);
    // A pair's file is a grasps.json.
    stdout(&moduli(
        here,
        &["ascend", "drop.shape", "all/egg-to-drop.json"],
    ));

    let with = |more: &[&str]| {
        let arguments = ["transfer", "--from", "egg.shape", "--to", "ball.shape"];
        moduli(here, &[&arguments[..], more].concat())
    };
    refused(
        &with(&["--to", "drop.shape", "grasps.json"]),
        2,
        &["-o DIR"],
    );
    let two = ["grasps.json", "grasps.json", "-o", "all"];
    refused(&with(&two), 2, &["--from: 1, files of grasps: 2"]);
    let twice = ["--to", "ball.shape", "grasps.json", "-o", "all"];
    refused(&with(&twice), 2, &["two shapes are named ball"]);
}

#[test]
fn bad_grasps_are_named() {
    let folder = prepared();
    let here = folder.path();
    std::fs::write(here.join("broken.json"), "{}").unwrap();
    let with = |grasps: &str| moduli(here, &["ascend", "egg.shape", grasps]);
    refused(&with("broken.json"), 3, &["broken.json", "grasps.json"]);
    refused(&with("none.json"), 3, &["none.json"]);
    let mut file = read(here, "grasps.json");
    // Exactly at the centre of the fitted shape no direction is left.
    let line = stdout(&moduli(here, &["info", "egg.shape"]));
    let centre = line.split("centre").nth(1).unwrap();
    let centre: Vec<f64> = centre[centre.find('[').unwrap() + 1..centre.find(']').unwrap()]
        .split(',')
        .map(|n| n.trim().parse().unwrap())
        .collect();
    file["grasps"][1]["contacts_m"][2] = json!(centre);
    std::fs::write(here.join("centre.json"), file.to_string()).unwrap();
    refused(&with("centre.json"), 3, &["grasp 1", "contact 2"]);
    let slippery = moduli(
        here,
        &[
            "transfer",
            "--from",
            "egg.shape",
            "--to",
            "ball.shape",
            "grasps.json",
            "--friction",
            "1e-5",
            "--scheme",
            "naive",
        ],
    );
    refused(&slippery, 4, &["force-closed"]);
}
