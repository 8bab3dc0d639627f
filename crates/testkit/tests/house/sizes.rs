//! Files of at most 500 lines, functions of at most 80.

use std::fs;
use std::path::Path;

use crate::sources::{crate_folders, root, rust_files};

const FILE: usize = 500;
const FUNCTION: usize = 80;

/// Name, first line and number of lines of every function, by the layout of rustfmt: a function ends
/// with a closing brace at the indentation of its first line.
fn functions(text: &str) -> Vec<(String, usize, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (first, line) in lines.iter().enumerate() {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        let Some(name) = function_name(code) else {
            continue;
        };
        let end = format!("{indent}}}");
        let one_line = code.ends_with('}') || code.ends_with(';');
        if let (false, Some(length)) = (one_line, lines[first..].iter().position(|l| **l == end)) {
            found.push((name, first + 1, length + 1));
        }
    }
    found
}

fn function_name(code: &str) -> Option<String> {
    let (before, after) = code.split_once("fn ")?;
    let qualifiers = [
        "pub",
        "pub(crate)",
        "pub(super)",
        "const",
        "async",
        "unsafe",
        "extern",
        "\"C\"",
    ];
    if !before
        .split_whitespace()
        .all(|word| qualifiers.contains(&word))
    {
        return None;
    }
    let name: String = after
        .chars()
        .take_while(|c| c.is_alphanumeric() || *c == '_')
        .collect();
    (!name.is_empty()).then_some(name)
}

fn each_file(mut check: impl FnMut(&Path, &str)) {
    let root = root();
    let mut folders: Vec<_> = crate_folders()
        .into_iter()
        .map(|(_, folder)| folder)
        .collect();
    folders.push(root.join("benches"));
    for file in folders.iter().flat_map(|folder| rust_files(folder)) {
        let text = fs::read_to_string(&file).unwrap();
        check(file.strip_prefix(&root).unwrap_or(&file), &text);
    }
}

#[test]
fn no_file_is_long() {
    let mut long = Vec::new();
    let mut files = 0;
    each_file(|path, text| {
        files += 1;
        let lines = text.lines().count();
        if lines > FILE {
            long.push(format!("{}: {lines} lines", path.display()));
        }
    });
    assert!(files > 100, "only {files} files were found");
    assert!(
        long.is_empty(),
        "more than {FILE} lines:\n{}",
        long.join("\n")
    );
}

#[test]
fn no_function_is_long() {
    let mut long = Vec::new();
    let mut count = 0;
    each_file(|path, text| {
        for (name, line, length) in functions(text) {
            count += 1;
            if length > FUNCTION {
                long.push(format!("{}:{line}: {name}, {length} lines", path.display()));
            }
        }
    });
    assert!(count > 1000, "only {count} functions were found");
    assert!(
        long.is_empty(),
        "more than {FUNCTION} lines:\n{}",
        long.join("\n")
    );
}

#[test]
fn lengths_are_counted() {
    let text =
        "impl A {\n    pub(crate) const fn b() {\n        c();\n    }\n}\nfn d() {}\n// fn e\n";
    assert_eq!(functions(text), [("b".to_owned(), 2, 3)]);
}
