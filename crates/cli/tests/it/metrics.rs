//! `moduli quality`: every metric in a table with named columns, and the convention of a file.

use tempfile::TempDir;

use crate::common::{fitted, moduli, stdout};

/// Three contacts at 0°, 120° and 240° on the unit circle, pressing to its centre, as a CSV row.
fn symmetric() -> String {
    let around: Vec<f64> = (0..3)
        .map(|i| f64::from(i) * std::f64::consts::TAU / 3.0)
        .flat_map(|a| [a.cos(), a.sin(), 0.0])
        .collect();
    let normals = around.iter().map(|x| -x);
    let cells: Vec<String> = around
        .iter()
        .copied()
        .chain(normals)
        .chain([0.0; 3])
        .map(|x| x.to_string())
        .collect();
    cells.join(",")
}

#[test]
fn all_metrics_stand_in_named_columns() {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("g.csv"), symmetric()).unwrap();
    let run = |more: &[&str]| {
        let mut arguments = vec!["quality", "g.csv", "--all", "--convention", "unit"];
        arguments.extend(more);
        stdout(&moduli(folder.path(), &arguments))
    };
    let line: serde_json::Value = serde_json::from_str(&run(&["--json", "-o", "all.csv"])).unwrap();
    let columns = line["columns"].as_array().unwrap();
    let row = line["rows"][0].as_array().unwrap();
    assert_eq!(columns.len(), row.len());
    let of = |name: &str| {
        let at = columns.iter().position(|c| c == name).unwrap();
        row[at].as_f64().unwrap()
    };
    let quality = of("quality");
    assert!((quality - 0.554_694).abs() < 0.02);
    assert!(of("lower") <= quality && quality <= of("upper"));
    // A bound per contact allows more than a bound on the sum, and at most three times as much.
    assert!(of("linf") >= quality && of("linf") <= 3.0 * quality + 1e-9);
    assert!(of("volume") > 0.0 && of("min_weight") > 0.0);
    assert!(of("smallest_singular_value") > 0.1);
    // Any friction closes this grasp.
    assert!(of("least_friction") < 1e-6);
    // Round cones need 1/√3 N for a load along −x of the first contact; a pyramid needs more.
    let force = of("normal_force_per_load");
    assert!((0.577..0.7).contains(&force), "{force}");

    let text = std::fs::read_to_string(folder.path().join("all.csv")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 2);
    assert!(lines[0].starts_with("quality,lower,upper,volume,linf,"));
    let first: f64 = lines[1].split(',').next().unwrap().parse().unwrap();
    assert_eq!(first, quality);
    assert!(run(&[]).contains("least_friction"));
    // A round cone has no finite list of edges: these two cells are empty.
    let round: serde_json::Value =
        serde_json::from_str(&run(&["--json", "--edges", "round"])).unwrap();
    let absent = |name: &str| {
        let at = columns.iter().position(|c| c == name).unwrap();
        round["rows"][0][at].is_null()
    };
    assert!(absent("volume") && absent("min_weight") && !absent("linf"));
}

#[test]
fn a_file_is_measured_under_its_own_convention() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fitted(here, "egg", [0.035, 0.030, 0.045], [0.5, 0.0, 0.2]);
    let json = |arguments: &[&str]| -> serde_json::Value {
        serde_json::from_str(&stdout(&moduli(here, arguments))).unwrap()
    };
    // Their centres are the mean of the cloud, the centroid, the origin, and the origin.
    for convention in ["paper", "graspit", "openrave", "unit"] {
        let found = json(&[
            "synthesize",
            "egg.shape",
            "--convention",
            convention,
            "--poses",
            "60",
            "--json",
            "-o",
            convention,
        ]);
        assert!(
            found["stable"].as_u64().unwrap() > 0,
            "{convention}: {found}"
        );
        let file = format!("{convention}/grasps.json");
        let measured = json(&["quality", &file, "--json"]);
        assert_eq!(measured["convention"], convention);
        let text = std::fs::read(here.join(&file)).unwrap();
        let written: serde_json::Value = serde_json::from_slice(&text).unwrap();
        let best = written["grasps"][0]["quality"].as_f64().unwrap();
        let again = measured["best"].as_f64().unwrap();
        assert!(
            (again - best).abs() <= 1e-9,
            "{convention}: {again} or {best}"
        );
    }
    let other = json(&[
        "quality",
        "paper/grasps.json",
        "--convention",
        "dexnet",
        "--json",
    ]);
    assert_eq!(other["convention"], "dexnet");
}

/// The edges of many contacts on one ring lie in common planes, on which the full hull does not end.
#[test]
fn thirty_contacts_have_all_metrics_but_perhaps_the_volume() {
    let folder = TempDir::new().unwrap();
    let around = |scale: f64| {
        (0..30).flat_map(move |i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 30.0).sin_cos();
            [scale * cos, scale * sin, 0.0]
        })
    };
    let cells = around(0.05).chain(around(-1.0)).chain([0.0; 3]);
    let cells: Vec<String> = cells.map(|x| x.to_string()).collect();
    std::fs::write(folder.path().join("g.csv"), cells.join(",")).unwrap();
    let said = stdout(&moduli(
        folder.path(),
        &["quality", "g.csv", "--all", "--json"],
    ));
    let line: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert_eq!(line["closed"], 1);
    assert!(line["rows"][0][4].as_f64().unwrap() > line["mean"].as_f64().unwrap());
}
