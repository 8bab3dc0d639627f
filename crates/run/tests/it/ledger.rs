//! Which results are reused, and which are recomputed.

use std::path::Path;

use run::ledger::{is_sealed, seal};
use run::{Digest, Key, Ledger};
use serde_json::{Map, Value, json};

fn key(part: &str) -> Key {
    Key::new(&[("part", part.as_bytes())]).unwrap()
}

/// A file with the results 0, 1/3, 2/3 of the first three of five jobs.
fn three_of_five(file: &Path) {
    let (ledger, kept) = Ledger::open::<f64>(file, &key("a"), 5).unwrap();
    assert_eq!(kept, [None; 5]);
    for job in 0..3 {
        ledger.append(job, &(job as f64 / 3.0)).unwrap();
    }
}

fn kept(file: &Path, key: &Key) -> Vec<Option<f64>> {
    Ledger::open::<f64>(file, key, 5).unwrap().1
}

#[test]
fn what_was_done_is_kept_to_the_last_bit() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("new/results.jsonl");
    three_of_five(&file);
    let expected = [Some(0.0), Some(1.0 / 3.0), Some(2.0 / 3.0), None, None];
    assert_eq!(kept(&file, &key("a")), expected);
}

#[test]
fn other_inputs_begin_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("results.jsonl");
    three_of_five(&file);
    assert_eq!(kept(&file, &key("b")), [None; 5]);
    // The results under the first key are discarded.
    assert_eq!(kept(&file, &key("a")), [None; 5]);
    std::fs::write(&file, "not a ledger").unwrap();
    assert_eq!(kept(&file, &key("a")), [None; 5]);
}

#[test]
fn another_program_begins_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("results.jsonl");
    three_of_five(&file);
    let other = Key::with_program(&[("part", b"a")], &Digest::of(b"another program"));
    assert_eq!(kept(&file, &other), [None; 5]);
    let this = run::digest::of_this_program().unwrap();
    assert_eq!(Key::with_program(&[("part", b"a")], &this), key("a"));
}

#[test]
fn parts_do_not_run_into_each_other() {
    let key = |parts: &[(&str, &[u8])]| Key::with_program(parts, &Digest::new());
    assert_ne!(key(&[("a", b"bc")]), key(&[("ab", b"c")]));
    assert_ne!(key(&[("a", b"b"), ("c", b"d")]), key(&[("a", b"bcd")]));
}

#[test]
fn a_line_that_was_cut_off_is_done_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("results.jsonl");
    three_of_five(&file);
    let text = std::fs::read(&file).unwrap();
    std::fs::write(&file, &text[..text.len() - 1]).unwrap();
    let two = [Some(0.0), Some(1.0 / 3.0), None, None, None];
    assert_eq!(kept(&file, &key("a")), two);
    // Everything after the valid lines is discarded, so that new lines are complete.
    let (ledger, _) = Ledger::open::<f64>(&file, &key("a"), 5).unwrap();
    ledger.append(4, &0.5).unwrap();
    let three = [Some(0.0), Some(1.0 / 3.0), None, None, Some(0.5)];
    assert_eq!(kept(&file, &key("a")), three);
}

#[test]
fn a_result_that_was_edited_is_computed_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("results.jsonl");
    three_of_five(&file);
    let text = std::fs::read_to_string(&file).unwrap();
    let edited = text.replace("0.6666666666666666", "9.9");
    assert_ne!(edited, text);
    std::fs::write(&file, edited).unwrap();
    let two = [Some(0.0), Some(1.0 / 3.0), None, None, None];
    assert_eq!(kept(&file, &key("a")), two);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let error = Ledger::open::<f64>(&file.join("results.jsonl"), &key("a"), 5).unwrap_err();
    assert!(error.to_string().contains("results.jsonl"), "{error}");
}

#[test]
fn a_sealed_result_is_found_until_anything_changes() {
    let object = |value: Value| value.as_object().unwrap().clone();
    let mut result = object(json!({"quality": [0.1, 1.0 / 3.0], "made": {"from": "can"}}));
    assert!(!is_sealed(&result, "made", &key("a")));
    seal(&mut result, "made", &key("a")).unwrap();
    assert_eq!(result["made"]["from"], "can");
    let text = serde_json::to_string_pretty(&result).unwrap();
    let read: Map<String, Value> = serde_json::from_str(&text).unwrap();
    assert!(is_sealed(&read, "made", &key("a")));
    assert!(!is_sealed(&read, "made", &key("b")));
    for edit in [
        ("0.1", "9.9"),
        ("\"can\"", "\"cup\""),
        (key("a").as_str(), key("b").as_str()),
    ] {
        let edited = text.replacen(edit.0, edit.1, 1);
        assert_ne!(edited, text);
        let read: Map<String, Value> = serde_json::from_str(&edited).unwrap();
        assert!(!is_sealed(&read, "made", &key("a")), "{edit:?}");
        assert!(!is_sealed(&read, "made", &key("b")), "{edit:?}");
    }
}
