//! `moduli fit --model spherical`, and the commands that read its result.

use std::path::Path;

use tempfile::TempDir;

use crate::common::{moduli, npy, read_npy, refused, stdout};

/// Writes u.npy with 900 directions, and NAME.xyz with their images under `map`.
fn mapped(folder: &Path, name: &str, map: impl Fn(&sph::Direction) -> [f64; 3]) {
    let directions = sph::direction::even_directions(900);
    let flat: Vec<f64> = directions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    std::fs::write(folder.join("u.npy"), npy(3, &flat)).unwrap();
    let line = |p| {
        let [x, y, z] = map(p);
        format!("{x} {y} {z}\n")
    };
    let text: String = directions.iter().map(line).collect();
    std::fs::write(folder.join(format!("{name}.xyz")), text).unwrap();
}

/// A bent rod that is not star-shaped about its mean.
fn rod(p: &sph::Direction) -> [f64; 3] {
    [
        1.0 + 0.012 * p.x + 0.05 * p.z * p.z,
        2.0 + 0.012 * p.y,
        3.0 + 0.07 * p.z,
    ]
}

fn fit(folder: &Path, name: &str) -> serde_json::Value {
    let (cloud, shape) = (format!("{name}.xyz"), format!("{name}.shape"));
    let arguments = ["fit", &cloud, "--model", "spherical", "--directions"];
    let more = [
        "u.npy", "--degree", "4", "--lambda", "0", "-o", &shape, "--json",
    ];
    let line = stdout(&moduli(folder, &[&arguments[..], &more[..]].concat()));
    serde_json::from_str(&line).unwrap()
}

#[test]
fn a_bent_rod_is_fitted_evaluated_meshed_and_described() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    mapped(here, "rod", rod);
    let line = fit(here, "rod");
    assert_eq!(
        (&line["model"], &line["embedding"]),
        (&"spherical".into(), &"immersion".into())
    );
    assert_eq!(
        (&line["points"], &line["in_m_sph"]),
        (&900.into(), &true.into())
    );
    assert!(line["rms_m"].as_f64().unwrap() < 1e-9);
    assert!(line["area_element_certified_m2"].as_f64().unwrap() > 0.0);

    let arguments = ["eval", "rod.shape", "--directions", "u.npy", "-o", "v.npy"];
    stdout(&moduli(here, &arguments));
    let values = read_npy(&here.join("v.npy"), 9);
    for (row, p) in values.chunks(9).zip(sph::direction::even_directions(900)) {
        for (found, expected) in row.iter().zip(rod(&p)) {
            assert!(
                (found - expected).abs() <= 1e-9,
                "in the frame of the cloud"
            );
        }
    }
    stdout(&moduli(here, &["mesh", "rod.shape", "-o", "rod.ply"]));
    let mesh = shape::io::read_ply(&std::fs::read(here.join("rod.ply")).unwrap()).unwrap();
    assert!(mesh.points.iter().all(|p| (p.y - 2.0).abs() <= 0.0121));
    assert!(stdout(&moduli(here, &["info", "rod.shape"])).contains("immersion   proved"));
}

/// A tube bent by half a turn: 32 mm thick, open towards the middle of its circle.
fn tube(p: &sph::Direction) -> [f64; 3] {
    let (sin, cos) = (1.5 * p.z).sin_cos();
    let (out, along) = (0.06 + 0.016 * p.x, 0.006 * p.z);
    [
        0.5 + out * cos - along * sin,
        0.016 * p.y,
        0.2 + out * sin + along * cos,
    ]
}

fn write_cloud(folder: &Path, name: &str, points: impl Iterator<Item = [f64; 3]>) {
    let text: String = points.map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    std::fs::write(folder.join(name), text).unwrap();
}

#[test]
fn a_bent_tube_is_grasped_where_it_is_and_as_the_shape_that_was_stored() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let directions = sph::direction::even_directions(4000);
    write_cloud(here, "tube.xyz", directions.iter().map(tube));
    let arguments = [
        "grasp", "tube.xyz", "-o", "out", "--degree", "12", "--json", "-q",
    ];
    let fewer = ["--poses", "120", "--transfers", "1", "--reach-starts", "3"];
    let run = moduli(here, &[&arguments[..], &fewer[..]].concat());
    let line: serde_json::Value = serde_json::from_str(&stdout(&run)).unwrap();
    assert_eq!(line["model"], "spherical");
    assert_eq!(line["embedding"], "proved");
    assert_eq!(line["closed_holes"].as_array().unwrap().len(), 0);
    assert!(line["grasps"].as_u64().unwrap() >= 3, "{line}");
    assert!(line["surface_rms_m"].as_f64().unwrap() < 3e-4, "{line}");
    let file = std::fs::read(here.join("out/grasps.json")).unwrap();
    let file = record::GraspsFile::from_json(&file).unwrap();
    assert_eq!(
        file.object.model,
        Some(record::grasps::SurfaceModel::Spherical)
    );
    let cloud: Vec<[f64; 3]> = directions.iter().map(tube).collect();
    for contact in file.grasps.iter().flat_map(|g| &g.contacts_m) {
        let squared = cloud
            .iter()
            .map(|p| (0..3).map(|k| (p[k] - contact[k]).powi(2)).sum::<f64>());
        assert!(
            squared.fold(f64::INFINITY, f64::min).sqrt() < 2.5e-3,
            "{contact:?}"
        );
    }
    let page = std::fs::read_to_string(here.join("out/index.html")).unwrap();
    assert!(page.contains("proved to be smooth and not to touch itself"));

    // No radius describes it, and half of it is no surface of anything.
    let radial = moduli(
        here,
        &["grasp", "tube.xyz", "--degree", "12", "--model", "radial"],
    );
    refused(&radial, 4, &["tube: ", "not star-shaped"]);
    let shell = directions.iter().map(tube).filter(|x| x[1] > 0.004);
    write_cloud(here, "shell.xyz", shell);
    let shell = moduli(here, &["grasp", "shell.xyz", "--degree", "12"]);
    refused(&shell, 4, &["shell: ", "map of the sphere"]);

    let fit = [
        "fit",
        "tube.xyz",
        "--model",
        "spherical",
        "--degree",
        "12",
        "-o",
        "tube.shape",
    ];
    stdout(&moduli(here, &fit));
    let poses = [
        "synthesize",
        "tube.shape",
        "--poses",
        "120",
        "--json",
        "-o",
        "made",
    ];
    let line: serde_json::Value = serde_json::from_str(&stdout(&moduli(here, &poses))).unwrap();
    assert_eq!(line["model"], "spherical");
    assert!(line["stable"].as_u64().unwrap() >= 3, "{line}");
    let ascend = [
        "ascend",
        "tube.shape",
        "out/grasps.json",
        "-o",
        "up.json",
        "--json",
    ];
    let line: serde_json::Value = serde_json::from_str(&stdout(&moduli(here, &ascend))).unwrap();
    assert!(line["grasps"].as_u64().unwrap() >= 3, "{line}");
}

#[test]
fn a_cloud_without_directions_is_wrapped_and_fitted() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let text: String = sph::direction::even_directions(2500)
        .iter()
        .map(|p| {
            let [x, y, z] = rod(p);
            format!("{x} {y} {z}\n")
        })
        .collect();
    std::fs::write(here.join("rod.xyz"), text).unwrap();
    let arguments = ["fit", "rod.xyz", "--model", "spherical", "--degree", "12"];
    let more = ["-o", "rod.shape", "--json"];
    let line = stdout(&moduli(here, &[&arguments[..], &more[..]].concat()));
    let line: serde_json::Value = serde_json::from_str(&line).unwrap();
    assert_eq!(line["model"], "spherical");
    assert_eq!(line["in_m_sph"], true);
    assert_eq!(line["embedding"], "proved");
    assert_eq!(line["closed_holes"].as_array().unwrap().len(), 0);
    assert!(line["surface_rms_m"].as_f64().unwrap() < 3e-4, "{line}");
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.012 * 0.012 * 0.07;
    let volume = line["volume_m3"].as_f64().unwrap();
    assert!((volume / ball - 1.0).abs() < 0.03, "{line}");

    mapped(here, "places", rod);
    stdout(&moduli(
        here,
        &["eval", "rod.shape", "--directions", "u.npy", "-o", "v.npy"],
    ));
    let values = read_npy(&here.join("v.npy"), 9);
    assert!(
        values
            .chunks(9)
            .all(|row| (row[0] - 1.0).abs() < 0.07 && row[8].is_finite())
    );
    stdout(&moduli(here, &["mesh", "rod.shape", "-o", "rod.ply"]));
    assert!(stdout(&moduli(here, &["info", "rod.shape"])).contains("immersion   proved"));
}

#[test]
fn the_curvatures_of_a_ball_are_one_over_its_radius() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    mapped(here, "ball", |p| [0.04 * p.x, 0.04 * p.y, 0.04 * p.z]);
    fit(here, "ball");
    let arguments = ["eval", "ball.shape", "--directions", "u.npy", "-o", "v.npy"];
    stdout(&moduli(here, &arguments));
    let values = read_npy(&here.join("v.npy"), 9);
    for row in values.chunks(9) {
        assert!(row[6..].iter().all(|k| (k - 25.0).abs() < 1e-3), "{row:?}");
        let outward: f64 = (0..3).map(|k| row[k] * row[3 + k]).sum();
        assert!((outward - 0.04).abs() < 1e-9, "the normal points outward");
    }
}

#[test]
fn directions_that_do_not_belong_to_the_cloud_are_refused() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    mapped(here, "rod", rod);
    let run = |more: &[&str]| {
        let mut arguments = vec!["fit", "rod.xyz", "--degree", "4"];
        arguments.extend(more);
        moduli(here, &arguments)
    };
    refused(&run(&["--directions", "u.npy"]), 2, &["--model spherical"]);
    std::fs::write(here.join("one.npy"), npy(3, &[0.0, 0.0, 1.0])).unwrap();
    let one = ["--model", "spherical", "--directions", "one.npy"];
    refused(&run(&one), 2, &["900 points", "1 directions"]);
    std::fs::write(here.join("long.npy"), npy(3, &[0.0, 0.0, 1.1])).unwrap();
    let long = ["--model", "spherical", "--directions", "long.npy"];
    refused(&run(&long), 3, &["long.npy", "row 0", "1.1"]);
    // A map that folds the sphere flat is no immersion.
    mapped(here, "flat", |p| [0.04 * p.x, 0.04 * p.y, 0.0]);
    let flat = ["fit", "flat.xyz", "--degree", "4", "--lambda", "0"];
    let more = ["--model", "spherical", "--directions", "u.npy"];
    let flat = moduli(here, &[&flat[..], &more[..]].concat());
    refused(&flat, 4, &["flat.xyz", "not an immersion"]);
}
