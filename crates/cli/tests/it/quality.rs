//! What `moduli quality` says beside a number.

use std::path::Path;

use tempfile::TempDir;

use crate::common::{moduli, stdout};

/// Three contacts at 120° on a ball of 5 cm, as one row.
fn ring() -> Vec<f64> {
    let circle = |scale: f64| {
        (0..3).flat_map(move |i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 3.0).sin_cos();
            [scale * cos, scale * sin, 0.0]
        })
    };
    circle(0.05).chain(circle(-1.0)).chain([0.0; 3]).collect()
}

fn write(folder: &Path, row: &[f64]) {
    let cells: Vec<String> = row.iter().map(f64::to_string).collect();
    std::fs::write(folder.join("g.csv"), cells.join(",")).unwrap();
}

fn say(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let all = [&["quality"], arguments, &["--json"]].concat();
    serde_json::from_str(&stdout(&moduli(folder, &all))).unwrap()
}

#[test]
fn a_certificate_proves_the_interval() {
    let folder = TempDir::new().unwrap();
    write(folder.path(), &ring());
    let said = say(
        folder.path(),
        &[
            "g.csv",
            "--convention",
            "unit",
            "--torque-length",
            "0.05",
            "--edges",
            "round",
            "--certificate",
            "proof.json",
        ],
    );
    assert_eq!(
        (&said["converged"], &said["closed"]),
        (&1.into(), &1.into())
    );
    let quality = said["mean"].as_f64().unwrap();
    assert!((quality - 1.0 / 3.0_f64.sqrt()).abs() <= 1e-4, "{quality}");
    let text = std::fs::read_to_string(folder.path().join("proof.json")).unwrap();
    let proof: serde_json::Value = serde_json::from_str(&text).unwrap();
    let proof = &proof[0];
    let [lower, upper] = ["lower", "upper"].map(|end| proof[end].as_f64().unwrap());
    assert!(lower <= quality && quality <= upper, "{lower} {upper}");
    assert!(proof["facets"].as_array().unwrap().len() > 20);
}

#[test]
fn contacts_with_a_size_close_two_fingers() {
    let folder = TempDir::new().unwrap();
    let pair = "0.03,0,0,-0.03,0,0,-1.001,0,0,1,0,0,0,0,0";
    std::fs::write(folder.path().join("pair.csv"), pair).unwrap();
    let closed =
        |contact: &str| say(folder.path(), &["pair.csv", "--contact", contact])["closed"].clone();
    assert_eq!(closed("point"), 0);
    assert_eq!(closed("soft:0.01"), 1);
    assert_eq!(closed("patch:0.01"), 1);
    let all = say(
        folder.path(),
        &["pair.csv", "--all", "--contact", "soft:0.01"],
    );
    let one = say(folder.path(), &["pair.csv", "--contact", "soft:0.01"]);
    assert_eq!(
        (&all["closed"], &all["mean"]),
        (&one["closed"], &one["mean"])
    );
    assert!(all["rows"][0][4].as_f64().unwrap() > 0.0, "{all}");
    let wrong = moduli(
        folder.path(),
        &["quality", "pair.csv", "--contact", "soft:-1"],
    );
    assert_eq!(wrong.status.code(), Some(2));
}

#[test]
fn metrics_and_frames_of_frogger() {
    let folder = TempDir::new().unwrap();
    let unit: Vec<f64> = ring()
        .iter()
        .enumerate()
        .map(|(k, x)| if k < 9 { x * 20.0 } else { *x })
        .collect();
    write(folder.path(), &unit);
    // The number that FRoGGeR's own code prints for the unit circle.
    let frogger = say(folder.path(), &["g.csv", "--convention", "frogger"]);
    assert!(
        (frogger["mean"].as_f64().unwrap() - 0.254_964).abs() <= 5e-7,
        "{frogger}"
    );
    // The frames belong to the convention, not to its default torque length.
    let named = ["g.csv", "--convention", "frogger", "--torque-length", "1"];
    assert_eq!(say(folder.path(), &named)["mean"], frogger["mean"]);
    let weight = say(folder.path(), &["g.csv", "--metric", "min-weight"]);
    assert_eq!(weight["metric"], "min-weight");
    assert!(weight["mean"].as_f64().unwrap() > 0.0);
    let needed = say(
        folder.path(),
        &["g.csv", "--metric", "friction-needed", "--edges", "round"],
    );
    assert!(needed["mean"].as_f64().unwrap() < 1e-3, "{needed}");
}

#[test]
fn frogger_under_a_foreign_torque_length_has_the_frames_of_every_convention() {
    let folder = tempfile::tempdir().unwrap();
    let row = "0.03,0,0.01,-0.02,0.03,0,-0.01,-0.03,-0.01,-1,0,0,0.6,-0.8,0,0.28,0.96,0,0,0,0\n";
    std::fs::write(folder.path().join("g.csv"), row).unwrap();
    let under = |name: &str, length: &str| {
        let options = [
            "--edges",
            "4",
            "--friction",
            "0.7",
            "--torque-length",
            length,
        ];
        let mut words = vec!["g.csv", "--convention", name];
        words.extend(options);
        say(folder.path(), &words)["mean"].as_f64().unwrap()
    };
    // FRoGGeR's edges have unit length; `openrave` has the same and the usual frames.
    assert_eq!(under("frogger", "0.02"), under("openrave", "0.02"));
    assert!((under("frogger", "1") - under("openrave", "1")).abs() > 1e-6);
}

#[test]
fn a_small_quality_is_not_printed_as_zero() {
    let folder = TempDir::new().unwrap();
    write(folder.path(), &ring());
    let length = ["quality", "g.csv", "--torque-length", "1e5"];
    let text = stdout(&moduli(folder.path(), &length));
    let first = text.lines().next().unwrap();
    assert!(
        first.contains("e-") && !first.contains("0.000000"),
        "{text}"
    );
}
