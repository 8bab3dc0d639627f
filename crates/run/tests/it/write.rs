//! Whole-file writes: what is replaced, what is written through, and what is refused.

use std::fs;
use std::path::{Path, PathBuf};

use run::{WriteError, check_results, write};
use tempfile::TempDir;

const NO_INPUTS: [&Path; 0] = [];

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Names in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_result_is_all_that_is_left() {
    let folder = folder();
    let path = folder.path().join("new/deep/a.json");
    write(&path, b"first", &NO_INPUTS).unwrap();
    write(&path, b"second", &NO_INPUTS).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"second");
    assert_eq!(names(path.parent().unwrap()), ["a.json"]);
}

#[test]
fn names_that_can_be_no_file_are_refused() {
    let folder = folder();
    for (name, is_folder) in [
        (".", true),
        ("..", true),
        ("none/", false),
        ("none/..", false),
    ] {
        let error = write(&folder.path().join(name), b"", &NO_INPUTS).unwrap_err();
        assert!(error.is_usage(), "{error}");
        assert_eq!(
            matches!(error, WriteError::Folder { .. }),
            is_folder,
            "{error}"
        );
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn an_input_is_never_overwritten() {
    let folder = folder();
    let input = folder.path().join("in.ply");
    fs::write(&input, "the cloud").unwrap();
    let around = folder
        .path()
        .join("../")
        .join(folder.path().file_name().unwrap());
    let mut others = vec![input.clone(), around.join("in.ply")];
    #[cfg(unix)]
    {
        let link = folder.path().join("link.ply");
        std::os::unix::fs::symlink("in.ply", &link).unwrap();
        let hard = folder.path().join("hard.ply");
        fs::hard_link(&input, &hard).unwrap();
        others.extend([link, hard]);
    }
    for path in &others {
        let error = write(path, b"the result", &[&input]).unwrap_err();
        assert!(matches!(error, WriteError::Input { .. }), "{error}");
        assert!(error.is_usage());
        assert!(check_results(&[path], &[&input]).unwrap_err().is_usage());
    }
    assert_eq!(fs::read(&input).unwrap(), b"the cloud");
    write(&folder.path().join("out.ply"), b"the result", &[&input]).unwrap();
}

#[test]
fn two_results_of_one_name_are_bad_usage() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let error = check_results(&[at("o.shape"), at("p.shape"), at("./o.shape")], &NO_INPUTS);
    let error = error.unwrap_err();
    assert!(matches!(&error, WriteError::Twice { path } if path.ends_with("o.shape")));
    assert!(error.is_usage());
    check_results(&[at("o.shape"), at("new/o.shape")], &NO_INPUTS).unwrap();
    let twice = check_results(&[at("new/o.shape"), at("new/./o.shape")], &NO_INPUTS);
    assert!(matches!(twice, Err(WriteError::Twice { .. })));
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_failed_write_leaves_nothing_behind() {
    let folder = folder();
    let file = folder.path().join("file");
    fs::write(&file, "kept").unwrap();
    let error = write(&file.join("a.json"), b"", &NO_INPUTS).unwrap_err();
    assert!(error.to_string().contains("a.json"), "{error}");
    // No file system supports names of this length: the folder is created and removed again.
    let long = folder.path().join("made/too").join("n".repeat(300));
    let error = write(&long, b"", &NO_INPUTS).unwrap_err();
    assert!(matches!(error, WriteError::Io { .. }), "{error}");
    assert_eq!(names(folder.path()), ["file"]);
    assert_eq!(fs::read(&file).unwrap(), b"kept");
}

#[test]
fn a_read_only_file_is_left_as_it_is() {
    let folder = folder();
    let path = folder.path().join("kept.json");
    fs::write(&path, "old").unwrap();
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();
    let error = write(&path, b"new", &NO_INPUTS).unwrap_err();
    assert!(matches!(error, WriteError::ReadOnly { .. }), "{error}");
    assert!(!error.is_usage());
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["kept.json"]);
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};

    fn linked(folder: &Path, name: &str, target: &str) -> PathBuf {
        let link = folder.join(name);
        symlink(target, &link).unwrap();
        link
    }

    fn is_link(path: &Path) -> bool {
        fs::symlink_metadata(path).unwrap().is_symlink()
    }

    #[test]
    fn permissions_of_an_existing_file_are_kept() {
        let folder = folder();
        let path = folder.path().join("private.json");
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        write(&path, b"new", &NO_INPUTS).unwrap();
        let found = fs::metadata(&path).unwrap();
        assert_eq!(found.permissions().mode() & 0o777, 0o640);
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn a_reader_of_the_old_file_keeps_it_whole() {
        let folder = folder();
        let path = folder.path().join("a.json");
        fs::write(&path, "old").unwrap();
        let before = fs::metadata(&path).unwrap().ino();
        let old = fs::File::open(&path).unwrap();
        write(&path, b"a longer text", &NO_INPUTS).unwrap();
        assert_ne!(fs::metadata(&path).unwrap().ino(), before);
        assert_eq!(std::io::read_to_string(old).unwrap(), "old");
    }

    #[test]
    fn a_link_stays_and_its_target_is_written() {
        let folder = folder();
        fs::create_dir(folder.path().join("elsewhere")).unwrap();
        let target = folder.path().join("elsewhere/target.shape");
        fs::write(&target, "old").unwrap();
        let first = linked(folder.path(), "first.shape", "elsewhere/target.shape");
        let second = linked(folder.path(), "second.shape", "first.shape");
        write(&second, b"new", &NO_INPUTS).unwrap();
        assert!(is_link(&first) && is_link(&second));
        assert_eq!(fs::read(&target).unwrap(), b"new");
        let dangling = linked(folder.path(), "dangling.shape", "elsewhere/none.shape");
        write(&dangling, b"made", &NO_INPUTS).unwrap();
        assert!(is_link(&dangling));
        assert_eq!(
            names(&folder.path().join("elsewhere")),
            ["none.shape", "target.shape"]
        );
        let twice = check_results(&[&first, &target], &NO_INPUTS);
        assert!(matches!(twice, Err(WriteError::Twice { .. })));
    }

    #[test]
    fn a_circle_of_links_is_refused() {
        let folder = folder();
        let a = linked(folder.path(), "a", "b");
        linked(folder.path(), "b", "a");
        assert!(write(&a, b"", &NO_INPUTS).is_err());
        assert_eq!(names(folder.path()), ["a", "b"]);
    }

    #[test]
    fn devices_are_written_through() {
        let folder = folder();
        let null = linked(folder.path(), "null", "/dev/null");
        write(&null, b"lost", &NO_INPUTS).unwrap();
        write(Path::new("/dev/null"), b"lost", &NO_INPUTS).unwrap();
        assert!(is_link(&null));
        let device = fs::metadata("/dev/null").unwrap().file_type();
        assert!(device.is_char_device());
        check_results(&[&null, &null], &NO_INPUTS).unwrap();
        let full = linked(folder.path(), "full", "/dev/full");
        let error = write(&full, b"no room", &NO_INPUTS).unwrap_err();
        assert!(matches!(error, WriteError::Io { .. }), "{error}");
        assert_eq!(names(folder.path()), ["full", "null"]);
    }

    #[test]
    fn a_pipe_is_written_through() {
        let folder = folder();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let reader = {
            let pipe = pipe.clone();
            std::thread::spawn(move || fs::read(pipe).unwrap())
        };
        write(&pipe, b"through the pipe", &NO_INPUTS).unwrap();
        assert_eq!(reader.join().unwrap(), b"through the pipe");
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
        assert_eq!(names(folder.path()), ["pipe"]);
    }
}
