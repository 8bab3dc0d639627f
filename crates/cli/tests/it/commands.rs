//! The program as a user runs it: results, files and exit codes.

use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::common::{moduli, npy, read_npy, refused, stdout};

/// An ellipsoid of 1,500 points away from the origin, as ASCII PLY.
fn ellipsoid_cloud(folder: &Path) -> PathBuf {
    let mut text = String::from(
        "ply\nformat ascii 1.0\nelement vertex 1500\nproperty double x\nproperty double y\nproperty double z\nend_header\n",
    );
    for p in sph::direction::even_directions(1500) {
        text += &format!(
            "{} {} {}\n",
            1.0 + 0.035 * p.x,
            0.030 * p.y,
            0.2 + 0.045 * p.z
        );
    }
    let path = folder.join("egg.ply");
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn fit_writes_a_shape_that_eval_and_mesh_read() {
    let folder = TempDir::new().unwrap();
    ellipsoid_cloud(folder.path());
    let line = stdout(&moduli(
        folder.path(),
        &[
            "fit",
            "egg.ply",
            "--degree",
            "10",
            "-o",
            "egg.shape",
            "--json",
        ],
    ));
    let fit: serde_json::Value = serde_json::from_str(&line).unwrap();
    for key in [
        "cloud",
        "points",
        "degree",
        "lambda",
        "rms_m",
        "max_abs_m",
        "r_min_certified_m",
        "r_max_certified_m",
        "in_m_rad",
        "condition",
        "seconds",
    ] {
        assert!(!fit[key].is_null(), "{key} is missing in {line}");
    }
    assert_eq!(fit["points"], 1500);
    assert_eq!(fit["in_m_rad"], true);
    assert!(fit["rms_m"].as_f64().unwrap() < 1e-4);

    let axes = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    std::fs::write(folder.path().join("u.npy"), npy(3, &axes)).unwrap();
    stdout(&moduli(
        folder.path(),
        &["eval", "egg.shape", "--directions", "u.npy", "-o", "v.npy"],
    ));
    let values = read_npy(&folder.path().join("v.npy"), 7);
    for (row, radius) in values.chunks(7).zip([0.035, 0.030, 0.045]) {
        assert!((row[0] - radius).abs() < 3e-4, "{row:?}");
    }
    assert!(
        (values[4] - 1.0).abs() < 1e-3,
        "the outward normal at +x is +x"
    );

    stdout(&moduli(
        folder.path(),
        &["mesh", "egg.shape", "-o", "egg_mesh.ply"],
    ));
    let mesh = shape::io::read_ply(&std::fs::read(folder.path().join("egg_mesh.ply")).unwrap());
    let points = mesh.unwrap().points;
    assert_eq!(points.len(), 10_000);
    assert!(
        points.iter().all(|p| (p.x - 1.0).abs() < 0.04),
        "the mesh is in the cloud's frame"
    );
    let info = stdout(&moduli(folder.path(), &["info", "egg.shape"]));
    assert!(info.contains("certified"));
    let near = stdout(&moduli(folder.path(), &["distance", "egg.shape", "--json"]));
    assert_eq!(near.lines().count(), 12);
}

#[test]
fn quality_of_a_symmetric_grasp_under_every_convention() {
    let folder = TempDir::new().unwrap();
    let row: Vec<f64> = (0..3)
        .map(|i| f64::from(i) * std::f64::consts::TAU / 3.0)
        .flat_map(|a| [a.cos(), a.sin(), 0.0])
        .collect();
    let normals: Vec<f64> = row.iter().map(|x| -x).collect();
    let table = [row, normals, vec![0.0; 3]].concat();
    std::fs::write(folder.path().join("g.npy"), npy(21, &table)).unwrap();
    let text = table
        .iter()
        .map(f64::to_string)
        .collect::<Vec<_>>()
        .join(",");
    std::fs::write(folder.path().join("g.csv"), text).unwrap();
    for file in ["g.npy", "g.csv"] {
        let line = stdout(&moduli(
            folder.path(),
            &[
                "quality",
                file,
                "--convention",
                "unit",
                "-o",
                "q.npy",
                "--json",
            ],
        ));
        let said: serde_json::Value = serde_json::from_str(&line).unwrap();
        assert_eq!((&said["grasps"], &said["closed"]), (&1.into(), &1.into()));
        assert!(said["us_per_grasp"].as_f64().unwrap() > 0.0);
        let q = read_npy(&folder.path().join("q.npy"), 3);
        // The tangent rule picks another tangent than +z for two of the contacts.
        assert!((q[0] - 0.554_694).abs() < 0.02, "{q:?}");
        assert!(q[1] <= q[0] && q[0] <= q[2]);
    }
    for convention in grasp::Convention::NAMES {
        stdout(&moduli(
            folder.path(),
            &["quality", "g.npy", "--convention", convention],
        ));
    }
    let round = stdout(&moduli(
        folder.path(),
        &[
            "quality",
            "g.npy",
            "--convention",
            "unit",
            "--edges",
            "round",
            "-o",
            "r.npy",
            "--json",
        ],
    ));
    assert!(round.contains("us_per_grasp"));
    let r = read_npy(&folder.path().join("r.npy"), 3);
    assert!(r[2] - r[1] <= 1e-4 && r[1] >= 0.55);
}

#[test]
fn grasp_goes_from_a_cloud_to_grasps_and_a_page() {
    let folder = TempDir::new().unwrap();
    ellipsoid_cloud(folder.path());
    let arguments = [
        "grasp",
        "egg.ply",
        "-o",
        "result",
        "--degree",
        "10",
        "--neighbours",
        "2",
        "--transfers",
        "2",
        "--poses",
        "150",
        "--json",
    ];
    let line = stdout(&moduli(folder.path(), &arguments));
    let said: serde_json::Value = serde_json::from_str(&line).unwrap();
    assert!(said["grasps"].as_u64().unwrap() >= 4);
    assert!(said["contact_to_cloud_max_m"].as_f64().unwrap() < 4e-3);
    let json = std::fs::read_to_string(folder.path().join("result/grasps.json")).unwrap();
    let file: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(file["convention"]["name"], "paper");
    let grasps = file["grasps"].as_array().unwrap();
    // Grasps with a hand come first, and the best first among both kinds.
    let mut before = (0, f64::INFINITY);
    let mut kinds = std::collections::BTreeSet::new();
    for (i, grasp) in grasps.iter().enumerate() {
        assert_eq!(grasp["rank"], i + 1);
        let quality = grasp["quality"].as_f64().unwrap();
        let without_hand = u8::from(grasp["hand"].is_null());
        assert!(quality > 0.0 && without_hand >= before.0);
        assert!(without_hand > before.0 || quality <= before.1);
        before = (without_hand, quality);
        kinds.insert(grasp["source"]["kind"].as_str().unwrap().to_owned());
        for contact in grasp["contacts_m"].as_array().unwrap() {
            // On the ellipsoid, in the frame of the cloud.
            let x: Vec<f64> = contact
                .as_array()
                .unwrap()
                .iter()
                .map(|v| v.as_f64().unwrap())
                .collect();
            let level = ((x[0] - 1.0) / 0.035).powi(2)
                + (x[1] / 0.030).powi(2)
                + ((x[2] - 0.2) / 0.045).powi(2);
            assert!((level - 1.0).abs() < 0.05, "{x:?}");
        }
    }
    assert_eq!(kinds.len(), 2, "grasps of both kinds: {kinds:?}");
    let page = std::fs::read_to_string(folder.path().join("result/index.html")).unwrap();
    assert!(page.contains("Plotly") && page.contains("egg"));

    // The same seed gives the same bytes, whatever the number of threads.
    let mut again = arguments.to_vec();
    again[3] = "again";
    again.extend(["--threads", "1"]);
    stdout(&moduli(folder.path(), &again));
    let repeated = std::fs::read_to_string(folder.path().join("again/grasps.json")).unwrap();
    assert_eq!(repeated, json);
    // Its own result can be measured again.
    let measured = stdout(&moduli(
        folder.path(),
        &["quality", "result/grasps.json", "--json"],
    ));
    let measured: serde_json::Value = serde_json::from_str(&measured).unwrap();
    let qualities = grasps.iter().map(|g| g["quality"].as_f64().unwrap());
    let best = qualities.fold(0.0, f64::max);
    assert!((measured["best"].as_f64().unwrap() - best).abs() < 1e-9);
}

#[test]
fn bad_input_names_the_file_and_the_place() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    refused(&moduli(here, &["fit", "missing.ply"]), 3, &["missing.ply"]);
    std::fs::write(here.join("words.ply"), "not a cloud").unwrap();
    refused(
        &moduli(here, &["fit", "words.ply"]),
        3,
        &["words.ply", "PLY"],
    );
    refused(
        &moduli(here, &["grasp", "words.ply", "-o", "x"]),
        3,
        &["words.ply"],
    );
    assert!(!here.join("x").exists(), "no result of a failure");
    std::fs::write(here.join("bad.shape"), b"MODULI\r\nxxxxxxxxxxxxxxxxxxxxxxx").unwrap();
    refused(
        &moduli(here, &["mesh", "bad.shape", "-o", "m.ply"]),
        3,
        &["bad.shape"],
    );
    let mut row = vec![0.1; 21];
    row[4] = f64::NAN;
    std::fs::write(here.join("nan.npy"), npy(21, &row)).unwrap();
    refused(
        &moduli(here, &["quality", "nan.npy"]),
        3,
        &["row 0", "column 4", "NaN"],
    );
    std::fs::write(here.join("narrow.npy"), npy(3, &[1.0; 3])).unwrap();
    refused(&moduli(here, &["quality", "narrow.npy"]), 3, &["6m+3"]);
    std::fs::write(here.join("short.csv"), "1,2,3\n").unwrap();
    refused(
        &moduli(here, &["quality", "short.csv"]),
        3,
        &["line 1", "21"],
    );
    std::fs::write(here.join("empty.csv"), "").unwrap();
    refused(&moduli(here, &["quality", "empty.csv"]), 3, &["no grasps"]);
}

#[test]
fn a_refused_cloud_does_not_stop_the_others() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    ellipsoid_cloud(here);
    std::fs::write(here.join("broken.ply"), "ply\nnonsense").unwrap();
    let arguments = ["fit", "missing.ply", "egg.ply", "broken.ply", "--json"];
    let mut all = arguments.to_vec();
    all.extend(["--degree", "6", "-o", "shapes"]);
    let output = moduli(here, &all);
    refused(&output, 3, &["missing.ply", "broken.ply"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(here.join("shapes/egg.shape").exists());
}

#[test]
fn heat_smooths_a_surface_and_the_wrong_heat_is_bad_usage() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    ellipsoid_cloud(here);
    let fit = |heat: &str| {
        let arguments = ["fit", "egg.ply", "--degree", "8", "--json", "--heat", heat];
        moduli(here, &arguments)
    };
    let bounds = |heat: &str| -> (f64, f64) {
        let line: serde_json::Value = serde_json::from_str(&stdout(&fit(heat))).unwrap();
        let of = |key: &str| line[key].as_f64().unwrap();
        (of("r_min_certified_m"), of("r_max_certified_m"))
    };
    let (cold, hot) = (bounds("0"), bounds("0.1"));
    assert!(
        hot.0 > cold.0 + 1e-3 && hot.1 < cold.1 - 1e-3,
        "{cold:?} {hot:?}"
    );
    refused(&fit("-1"), 2, &["--heat -1"]);
}

#[test]
fn points_that_surround_nothing_are_refused() {
    let folder = TempDir::new().unwrap();
    let sheet: String = (0..900)
        .map(|i| {
            format!(
                "{} {} 0\n",
                0.003 * f64::from(i % 30),
                0.003 * f64::from(i / 30)
            )
        })
        .collect();
    std::fs::write(folder.path().join("sheet.xyz"), sheet).unwrap();
    refused(
        &moduli(folder.path(), &["fit", "sheet.xyz"]),
        4,
        &["sheet.xyz", "hold no point"],
    );
    std::fs::write(
        folder.path().join("line.csv"),
        "x,y,z\n0,0,0\n0.1,0,0\n0.2,0,0\n0.3,0,0\n0.4,0,0\n",
    )
    .unwrap();
    refused(
        &moduli(folder.path(), &["grasp", "line.csv", "-o", "x"]),
        4,
        &["hold no point"],
    );
}

#[test]
fn bad_usage_is_exit_2() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    ellipsoid_cloud(here);
    refused(&moduli(here, &["fly"]), 2, &["fly"]);
    refused(
        &moduli(here, &["fit", "egg.ply", "--degree", "9999"]),
        2,
        &["degree"],
    );
    refused(
        &moduli(here, &["fit", "egg.ply", "--degree", "4", "--lambda", "-1"]),
        2,
        &["lambda"],
    );
    std::fs::write(here.join("g.npy"), npy(21, &[0.5; 21])).unwrap();
    for (flag, value) in [
        ("--convention", "nobody"),
        ("--friction", "0"),
        ("--edges", "2"),
        ("--edges", "many"),
    ] {
        refused(&moduli(here, &["quality", "g.npy", flag, value]), 2, &[]);
    }
}

#[test]
fn a_crumb_is_left_out_and_a_surface_that_does_not_explain_its_points_refused() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    // A ball of 4 cm, and a crumb beside it.
    let ball = sph::direction::even_directions(4000);
    let ball = ball.iter().map(|p| p.into_inner() * 0.04);
    let crumb = sph::direction::even_directions(80);
    let crumb = crumb
        .iter()
        .map(|p| p.into_inner() * 0.01 + nalgebra::Vector3::new(0.25, 0.0, 0.0));
    let text: String = ball
        .chain(crumb)
        .map(|p| format!("{} {} {}\n", p.x, p.y, p.z))
        .collect();
    std::fs::write(here.join("scene.xyz"), text).unwrap();
    let fit = moduli(here, &["fit", "scene.xyz", "--degree", "20", "--json"]);
    assert!(String::from_utf8_lossy(&fit.stderr).contains("left out"));
    let line: serde_json::Value = serde_json::from_str(&stdout(&fit)).unwrap();
    let warning = line["warnings"][0].as_str().unwrap();
    assert!(
        warning.contains("2 pieces") && warning.contains("left out"),
        "{warning}"
    );
    assert!(line["surface_rms_m"].as_f64().unwrap() <= 1e-5);
    assert_eq!(line["scene"]["pieces"][1]["points"], 80);
    assert_eq!(line["scene"]["support"]["source"], "foot");
    // A needle of 100 : 1, whose fitted surface would be a ball.
    let needle = sph::direction::even_directions(3000);
    let text: String = needle
        .iter()
        .map(|p| format!("{} {} {}\n", 0.2 * p.x, 0.002 * p.y, 0.002 * p.z))
        .collect();
    std::fs::write(here.join("needle.xyz"), text).unwrap();
    let fit = moduli(here, &["fit", "needle.xyz", "--degree", "20"]);
    refused(&fit, 4, &["needle.xyz", "explains", "--accept-misfit"]);
    let kept = [
        "fit",
        "needle.xyz",
        "--degree",
        "20",
        "--accept-misfit",
        "-o",
        "kept.shape",
    ];
    let kept = moduli(here, &kept);
    assert!(kept.status.success());
    assert!(String::from_utf8_lossy(&kept.stderr).contains("explains"));
}

#[test]
fn coordinates_of_no_frame_and_contacts_in_millimetres_are_named() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let text = "1e155 0 0\n0 1e155 0\n0 0 1e155\n-1e155 0 0\n0 -1e155 0\n";
    std::fs::write(here.join("huge.xyz"), text).unwrap();
    refused(
        &moduli(here, &["fit", "huge.xyz"]),
        3,
        &["huge.xyz", "1e155"],
    );
    let row = "40,0,0,-20,34,0,-20,-34,0,-1,0,0,0.5,-0.8660254037844386,0,0.5,0.8660254037844386,0,0,0,0\n";
    std::fs::write(here.join("mm.csv"), row).unwrap();
    let quality = moduli(here, &["quality", "mm.csv", "--json"]);
    let line: serde_json::Value = serde_json::from_str(&stdout(&quality)).unwrap();
    let warnings = line["warnings"].as_array().unwrap();
    let named = |w: &serde_json::Value| w.as_str().unwrap().contains("millimetres");
    assert!(warnings.iter().any(named), "{warnings:?}");
}

#[test]
fn every_command_has_completions_a_manual_page_and_an_example() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let pages = stdout(&moduli(folder, &["man", "man"]));
    let commands = ["fit", "grasp", "hand-check", "library-add", "quality"];
    for command in commands {
        assert!(pages.contains(&format!("moduli-{command}.1")), "{pages}");
    }
    for page in pages.lines() {
        let text = std::fs::read_to_string(folder.join(page)).unwrap();
        assert!(text.contains(".SH NAME"), "{page}");
        let has_commands = text.contains(".SH SUBCOMMANDS");
        assert!(has_commands || text.contains("Example: moduli"), "{page}");
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = stdout(&moduli(folder, &["completions", shell]));
        assert!(
            text.contains("synthesize") && text.contains("library"),
            "{shell}"
        );
    }
}
