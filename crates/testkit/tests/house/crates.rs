//! Dependencies between crates, and what every crate must have.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::sources::{crate_folders, root, rust_files, sources};

/// Every crate of the workspace, and the workspace crates that it may use.
const ARROWS: &[(&str, &[&str])] = &[
    ("sph", &[]),
    ("fixtures", &[]),
    ("catalogue", &[]),
    ("report", &[]),
    ("record", &[]),
    ("run", &[]),
    ("testkit", &[]),
    ("grasp", &[]),
    ("sphere-map", &[]),
    ("shape", &["sph", "sphere-map"]),
    ("space", &["sph", "shape", "grasp"]),
    ("hand", &["sph", "shape", "grasp", "fixtures"]),
    (
        "moduli",
        &[
            "sph",
            "sphere-map",
            "shape",
            "grasp",
            "space",
            "hand",
            "record",
            "fixtures",
        ],
    ),
    (
        "experiments",
        &[
            "sph",
            "sphere-map",
            "shape",
            "grasp",
            "space",
            "hand",
            "record",
            "fixtures",
            "moduli",
            "catalogue",
            "report",
            "run",
        ],
    ),
    (
        "cli",
        &[
            "sph",
            "sphere-map",
            "shape",
            "grasp",
            "space",
            "hand",
            "record",
            "fixtures",
            "moduli",
            "catalogue",
            "report",
            "run",
        ],
    ),
];

/// Foreign crates that only one module may name: the crate, and that module.
const DOORS: &[(&str, &str, &str)] = &[
    ("faer", "sph", "regression"),
    ("parry3d_f64", "hand", "collision"),
    ("urdf_rs", "hand", "urdf"),
    ("bincode", "record", "envelope"),
];

fn metadata() -> Value {
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--format-version",
            "1",
            "--no-deps",
            "--offline",
        ])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The name of a package in ARROWS.
fn short(package: &str) -> &str {
    package.strip_prefix("moduli-").unwrap_or(package)
}

#[test]
fn crates_use_only_what_lies_below_them() {
    let allowed: BTreeMap<&str, &[&str]> = ARROWS.iter().copied().collect();
    let metadata = metadata();
    let packages = metadata["packages"].as_array().unwrap();
    let mut wrong = Vec::new();
    let mut seen = BTreeSet::new();
    for package in packages {
        let name = short(package["name"].as_str().unwrap());
        if name == "benches" {
            continue;
        }
        seen.insert(name);
        let Some(may) = allowed.get(name) else {
            wrong.push(format!("{name} is not in the list of crates"));
            continue;
        };
        for dependency in package["dependencies"].as_array().unwrap() {
            let of_tests = dependency["kind"] == "dev";
            let other = short(dependency["name"].as_str().unwrap());
            if !of_tests && dependency["path"].is_string() && !may.contains(&other) {
                wrong.push(format!("{name} uses {other}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(seen.len(), ARROWS.len(), "{seen:?}");
}

#[test]
fn foreign_crates_have_one_door() {
    let mut wrong = Vec::new();
    for (name, folder) in crate_folders() {
        for source in sources(&folder) {
            for (foreign, home, module) in DOORS {
                let inside = name == *home && source.module.first().is_some_and(|m| m == module);
                let names_it = source
                    .shipped
                    .lines()
                    .filter(|line| !line.trim_start().starts_with("//"))
                    .any(|line| line.contains(&format!("{foreign}::")));
                if names_it && !inside {
                    wrong.push(format!("{} names {foreign}", source.path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_paper_s_constants_live_with_the_experiments() {
    for (name, folder) in crate_folders() {
        let paper = folder.join("src/paper.rs");
        assert_eq!(
            paper.is_file(),
            name == "experiments",
            "{}",
            paper.display()
        );
    }
}

#[test]
fn every_crate_has_a_first_page_with_a_program() {
    let mut wrong = Vec::new();
    for (name, folder) in crate_folders() {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        if !manifest.contains("\ndescription = ") || !manifest.contains("\nkeywords = ") {
            wrong.push(format!("{name}: no description or keywords"));
        }
        let readme = fs::read_to_string(folder.join("README.md")).unwrap_or_default();
        if readme.lines().count() < 10 {
            wrong.push(format!("{name}: the README says next to nothing"));
        }
        let library = folder.join("src/lib.rs");
        if name == "cli" || !library.is_file() {
            continue;
        }
        let first_page: String = fs::read_to_string(&library)
            .unwrap()
            .lines()
            .take_while(|line| line.starts_with("//!") || line.trim().is_empty())
            .collect::<Vec<_>>()
            .join("\n");
        if !first_page.contains("//! ```\n") {
            wrong.push(format!(
                "{name}: no program on the first page of the library"
            ));
        }
        let fences: usize = rust_files(&folder.join("src"))
            .iter()
            .map(|file| fs::read_to_string(file).unwrap())
            .map(|text| {
                text.lines()
                    .filter(|l| ["/// ```", "//! ```"].contains(&l.trim()))
                    .count()
                    / 2
            })
            .sum();
        if fences < 2 {
            wrong.push(format!(
                "{name}: {fences} doctests, at least 2 are expected"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn libraries_do_not_print_or_read_files() {
    let programs = ["cli", "experiments", "run", "testkit"];
    let words = [
        "println!",
        "eprintln!",
        "fs::read",
        "File::open",
        "from_os_rng",
        "ThreadPoolBuilder",
    ];
    let mut wrong = Vec::new();
    for (name, folder) in crate_folders() {
        if programs.contains(&name.as_str()) {
            continue;
        }
        for source in sources(&folder) {
            for (number, line) in source.shipped.lines().enumerate() {
                let code = line.split("//").next().unwrap_or("");
                if let Some(word) = words.iter().find(|word| code.contains(*word)) {
                    wrong.push(format!("{}:{}: {word}", source.path.display(), number + 1));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
