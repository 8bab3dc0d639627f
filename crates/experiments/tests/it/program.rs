//! The files of the programs: keys of the JSON, refused objects, and no partial files.

use std::path::Path;

use experiments::args::Args;
use experiments::program::{Experiment, execute};
use experiments::sections::{
    eigenfunctions, gradient_ascent, initial_grasps, sampling, scattered_starts, shape_space,
    transfer,
};
use serde_json::Value;
use shape::TriangleMesh;
use shape::io::write_ply;

fn folder_of_clouds(folder: &Path) {
    for id in ["S4", "S11"] {
        let object = catalogue::by_id(id).unwrap();
        let mesh = TriangleMesh {
            vertices: object.scan(1).into_iter().step_by(10).collect(),
            triangles: Vec::new(),
        };
        let mut bytes = Vec::new();
        write_ply(&mesh, &mut bytes).unwrap();
        std::fs::write(folder.join(format!("{id}.ply")), bytes).unwrap();
    }
    std::fs::write(folder.join("broken.ply"), "ply\nnonsense").unwrap();
}

fn run(name: &'static str, section: Experiment, folder: &Path, out: &Path) -> (String, Value) {
    let words = [
        "test",
        "--objects",
        folder.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--degree",
        "8",
        "--lambda",
        "1e-4",
        "--threads",
        "2",
        "-q",
    ];
    let args = Args::read("test", "about", words).unwrap();
    let text = execute(name, "about", &args, section).unwrap();
    let json = std::fs::read(out.join(format!("{name}.json"))).unwrap();
    (text, serde_json::from_slice(&json).unwrap())
}

#[test]
fn every_program_writes_its_keys_and_its_page() {
    let folder = tempfile::tempdir().unwrap();
    let out = tempfile::tempdir().unwrap();
    folder_of_clouds(folder.path());
    let sections: [(&str, Experiment, &[&str]); 7] = [
        (
            "fig1",
            eigenfunctions::run,
            &["orthonormality_error", "laplacian_error"],
        ),
        (
            "sec4a",
            shape_space::run,
            &["distances_m", "places", "spheres", "explained"],
        ),
        ("sec4b", sampling::run, &["noise"]),
        ("sec4c", initial_grasps::run, &["grasps", "conventions"]),
        (
            "sec4d",
            gradient_ascent::run,
            &["overall", "by_object", "steps"],
        ),
        ("sec4e", transfer::run, &["counts", "transfers", "stations"]),
        (
            "starts",
            scattered_starts::run,
            &["at_least_the_best_run", "transfers"],
        ),
    ];
    for (name, section, keys) in sections {
        let (text, value) = run(name, section, folder.path(), out.path());
        for key in ["objects", "paper", "ours", "convention"] {
            assert!(value[key].is_object(), "{name}: {key}");
        }
        assert!(value["seconds"].as_f64().is_some_and(|s| s > 0.0), "{name}");
        assert_eq!(value["experiment"], name);
        assert_eq!(value["convention"]["name"], "paper");
        for key in keys {
            assert!(!value["ours"][key].is_null(), "{name}: ours.{key}");
        }
        if name != "fig1" {
            assert_eq!(
                value["objects"]["fitted"].as_array().unwrap().len(),
                2,
                "{name}"
            );
            assert_eq!(value["objects"]["refused"][0]["id"], "broken", "{name}");
            assert!(text.contains("refused broken"), "{name}: {text}");
        }
        let page = std::fs::read_to_string(out.path().join(format!("{name}.html"))).unwrap();
        assert!(page.contains("<h1>") && page.len() > 1_000_000, "{name}");
    }
    assert_eq!(std::fs::read_dir(out.path()).unwrap().count(), 14);
}

#[test]
fn an_object_that_does_not_exist_is_bad_input() {
    let out = tempfile::tempdir().unwrap();
    let words = ["test", "--only", "S4,S44", "-q"];
    let mut args = Args::read("test", "about", words).unwrap();
    args.out = out.path().join("results");
    let error = execute("sec4b", "about", &args, sampling::run).unwrap_err();
    assert_eq!(error.exit_code(), 3);
    assert!(error.to_string().contains("S44"), "{error}");
}

#[test]
fn too_few_objects_are_bad_input_with_the_reasons() {
    let folder = tempfile::tempdir().unwrap();
    let out = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("broken.ply"), "ply\nnonsense").unwrap();
    let words = ["test", "--objects", folder.path().to_str().unwrap(), "-q"];
    let mut args = Args::read("test", "about", words).unwrap();
    args.out = out.path().join("results");
    let error = execute("sec4e", "about", &args, transfer::run).unwrap_err();
    assert_eq!(error.exit_code(), 3);
    assert!(error.to_string().contains("broken"), "{error}");
    assert!(!args.out.exists());
}
