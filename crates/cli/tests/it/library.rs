//! A user's own library of known objects.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::{fitted, moduli, refused, stdout};
use serde_json::Value;

/// Options under which an object takes a fraction of a second.
const QUICK: [&str; 5] = ["--degree", "8", "--poses", "120", "-q"];

fn with(words: &[&str], options: &[&str]) -> Vec<String> {
    let all = words.iter().chain(options);
    all.map(|word| (*word).to_owned()).collect()
}

fn run(folder: &Path, words: &[&str]) -> std::process::Output {
    let words = with(words, &QUICK);
    moduli(
        folder,
        &words.iter().map(String::as_str).collect::<Vec<_>>(),
    )
}

/// The lines of a result in JSON.
fn json(text: &str) -> Vec<Value> {
    let parsed = text.lines().map(serde_json::from_str);
    parsed.collect::<Result<_, _>>().unwrap()
}

fn two_objects(folder: &Path) {
    fitted(folder, "egg", [0.028, 0.03, 0.045], [0.0; 3]);
    fitted(folder, "lens", [0.04, 0.038, 0.022], [0.1, 0.0, 0.2]);
}

#[test]
fn objects_are_added_listed_used_and_removed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    two_objects(folder);
    stdout(&run(
        folder,
        &["library", "add", "mine", "egg.xyz", "lens.xyz"],
    ));
    let listed = stdout(&moduli(folder, &["library", "list", "mine", "--json"]));
    let objects = json(&listed);
    assert_eq!(objects.len(), 2);
    assert!(
        objects.iter().all(|o| o["grasps"].as_u64() > Some(0)),
        "{listed}"
    );
    assert_eq!(objects[0]["object"], "egg");
    assert_eq!(objects[1]["hand"], "sdh");

    // The egg's nearest known object is the egg itself.
    let words = [
        "grasp",
        "egg.xyz",
        "--library",
        "mine",
        "-o",
        "out",
        "--json",
    ];
    let line = &json(&stdout(&run(folder, &words)))[0];
    let nearest = line["neighbours"][0].as_str().unwrap();
    assert!(nearest.starts_with("egg egg (0.0 mm)"), "{nearest}");
    let file = std::fs::read_to_string(folder.join("out/grasps.json")).unwrap();
    assert!(
        file.contains("egg egg"),
        "a grasp came from the own library"
    );

    stdout(&moduli(folder, &["library", "remove", "mine", "egg"]));
    let left = json(&stdout(&moduli(
        folder,
        &["library", "list", "mine", "--json"],
    )));
    assert_eq!(left.len(), 1);
    refused(
        &moduli(folder, &["library", "remove", "mine", "egg"]),
        3,
        &["egg.object", "library list"],
    );
    refused(
        &moduli(folder, &["library", "list", "none"]),
        3,
        &["none", "library add"],
    );
}

#[test]
fn a_build_goes_on_where_it_was_and_begins_again_when_something_changes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    two_objects(folder);
    let kept = |words: &[&str]| -> Vec<bool> {
        let text = stdout(&run(folder, words));
        let line = |o: Value| o["kept"].as_bool().unwrap();
        json(&text).into_iter().map(line).collect()
    };
    let build = ["library", "build", "mine", "egg.xyz", "lens.xyz", "--json"];
    assert_eq!(
        kept(
            &build[..4]
                .iter()
                .chain(&["--json"])
                .copied()
                .collect::<Vec<_>>()
        ),
        [false]
    );
    assert_eq!(kept(&build), [true, false]);
    let bytes = std::fs::read(folder.join("mine/lens.object")).unwrap();
    assert_eq!(kept(&build), [true, true]);
    // Another seed, another cloud and a damaged file are made anew.
    let seeded: Vec<&str> = build.iter().chain(&["--seed", "7"]).copied().collect();
    assert_eq!(kept(&seeded), [false, false]);
    assert_eq!(kept(&build), [false, false]);
    assert_eq!(
        std::fs::read(folder.join("mine/lens.object")).unwrap(),
        bytes
    );
    let mut damaged = bytes.clone();
    damaged[200] ^= 1;
    std::fs::write(folder.join("mine/lens.object"), damaged).unwrap();
    assert_eq!(kept(&build), [true, false]);
    assert_eq!(
        std::fs::read(folder.join("mine/lens.object")).unwrap(),
        bytes
    );
}

#[test]
fn a_damaged_object_is_named_and_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    two_objects(folder);
    stdout(&run(
        folder,
        &["library", "add", "mine", "egg.xyz", "lens.xyz"],
    ));
    let path = folder.join("mine/egg.object");
    let mut bytes = std::fs::read(&path).unwrap();
    bytes.truncate(bytes.len() / 2);
    std::fs::write(&path, bytes).unwrap();
    let output = run(
        folder,
        &[
            "grasp",
            "lens.xyz",
            "--library",
            "mine",
            "-o",
            "out",
            "--json",
        ],
    );
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("egg.object") && said.contains("left out"),
        "{said}"
    );
    let line = &json(&stdout(&output))[0];
    assert!(
        line["warnings"].to_string().contains("egg.object"),
        "{line}"
    );
    assert!(
        line["neighbours"][0]
            .as_str()
            .unwrap()
            .starts_with("lens lens (0.0 mm)")
    );
    let listed = stdout(&moduli(folder, &["library", "list", "mine", "--json"]));
    assert_eq!(json(&listed).len(), 1);
}

#[test]
fn two_programs_may_fill_one_folder() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    two_objects(folder);
    let start = |clouds: [&str; 2]| {
        let words = with(&["library", "add", "mine", clouds[0], clouds[1]], &QUICK);
        Command::new(env!("CARGO_BIN_EXE_moduli"))
            .current_dir(folder)
            .args(words)
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    let mut both = [
        start(["egg.xyz", "lens.xyz"]),
        start(["lens.xyz", "egg.xyz"]),
    ];
    assert!(
        both.iter_mut()
            .all(|program| program.wait().unwrap().success())
    );
    let listed = stdout(&moduli(folder, &["library", "list", "mine", "--json"]));
    assert_eq!(json(&listed).len(), 2);
    assert_eq!(std::fs::read_dir(folder.join("mine")).unwrap().count(), 2);
}

#[test]
fn several_clouds_have_a_folder_each() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    two_objects(folder);
    std::fs::write(folder.join("broken.ply"), "ply\n").unwrap();
    let words = [
        "grasp",
        "egg.xyz",
        "broken.ply",
        "lens.xyz",
        "-o",
        "out",
        "--json",
    ];
    let output = run(folder, &words);
    refused(&output, 3, &["broken.ply"]);
    let lines = json(&String::from_utf8(output.stdout.clone()).unwrap());
    assert_eq!(lines.len(), 2, "the other clouds are still worked on");
    for name in ["egg", "lens"] {
        assert!(folder.join("out").join(name).join("grasps.json").exists());
    }
    std::fs::create_dir(folder.join("other")).unwrap();
    std::fs::copy(folder.join("egg.xyz"), folder.join("other/egg.xyz")).unwrap();
    let twice = run(folder, &["grasp", "egg.xyz", "other/egg.xyz", "-o", "out"]);
    refused(&twice, 2, &["egg/grasps.json"]);
}
