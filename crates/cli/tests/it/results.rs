//! Where results go: never over an input, never over each other, never in place of a device.

use std::fs;

use tempfile::TempDir;

use crate::common::{fitted, moduli, refused, stdout};

/// A folder with an egg as a cloud and as a shape.
fn egg() -> TempDir {
    let folder = TempDir::new().unwrap();
    fitted(folder.path(), "egg", [0.035, 0.030, 0.045], [0.0; 3]);
    folder
}

#[test]
fn a_cloud_is_not_overwritten_by_its_shape() {
    let folder = egg();
    let here = folder.path();
    let before = fs::read(here.join("egg.xyz")).unwrap();
    let fit = moduli(here, &["fit", "egg.xyz", "--degree", "4", "-o", "egg.xyz"]);
    refused(&fit, 2, &["egg.xyz", "input"]);
    assert_eq!(fs::read(here.join("egg.xyz")).unwrap(), before);
    let shape = fs::read(here.join("egg.shape")).unwrap();
    // A shape under the name of a mesh, so that only the rule for inputs stands in the way.
    fs::copy(here.join("egg.shape"), here.join("egg.ply")).unwrap();
    let mesh = moduli(here, &["mesh", "egg.ply", "-o", "./egg.ply"]);
    refused(&mesh, 2, &["egg.ply", "input"]);
    assert_eq!(fs::read(here.join("egg.ply")).unwrap(), shape);
}

#[test]
fn two_clouds_of_one_name_are_bad_usage() {
    let folder = egg();
    let here = folder.path();
    for name in ["a", "b"] {
        fs::create_dir(here.join(name)).unwrap();
        fs::copy(here.join("egg.xyz"), here.join(name).join("cloud.xyz")).unwrap();
    }
    let fit = moduli(here, &["fit", "a/cloud.xyz", "b/cloud.xyz", "-o", "shapes"]);
    refused(&fit, 2, &["a/cloud.xyz", "b/cloud.xyz", "cloud.shape"]);
    assert!(fit.stdout.is_empty());
    assert!(!here.join("shapes").exists());
}

#[test]
fn a_mesh_has_the_format_of_its_name() {
    let folder = egg();
    let here = folder.path();
    for name in ["m.ply", "m.obj", "m.stl", "m.OFF"] {
        let rows = ["--rows", "20", "--columns", "20"];
        let arguments = ["mesh", "egg.shape", "-o", name];
        stdout(&moduli(here, &[&arguments[..], &rows].concat()));
        let said = stdout(&moduli(here, &["info", name, "--json"]));
        let info: serde_json::Value = serde_json::from_str(&said).unwrap();
        assert_eq!(info["kind"], "mesh", "{name}");
        let format = name[2..].to_uppercase();
        assert_eq!(info["format"], format.as_str(), "{name}");
    }
    let fbx = moduli(here, &["mesh", "egg.shape", "-o", "m.fbx"]);
    refused(&fbx, 2, &["m.fbx", ".off"]);
    assert!(!here.join("m.fbx").exists());
}

#[cfg(unix)]
#[test]
fn links_stay_and_devices_are_written_through() {
    let folder = egg();
    let here = folder.path();
    std::os::unix::fs::symlink("target.ply", here.join("link.ply")).unwrap();
    std::os::unix::fs::symlink("/dev/null", here.join("null.ply")).unwrap();
    for name in ["link.ply", "null.ply"] {
        stdout(&moduli(here, &["mesh", "egg.shape", "-o", name]));
        assert!(fs::symlink_metadata(here.join(name)).unwrap().is_symlink());
    }
    assert!(
        fs::read(here.join("target.ply"))
            .unwrap()
            .starts_with(b"ply\n")
    );
    // The bytes of the result come before the line that says what was written.
    let piped = moduli(here, &["mesh", "egg.shape", "-o", "/dev/stdout"]);
    assert!(piped.status.success());
    assert!(piped.stdout.starts_with(b"ply\n"));
    let mesh = fs::read(here.join("target.ply")).unwrap();
    assert_eq!(piped.stdout[..mesh.len()], mesh);
}

#[test]
fn a_read_only_result_is_left_as_it_is() {
    let folder = egg();
    let path = folder.path().join("kept.ply");
    fs::write(&path, "old").unwrap();
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();
    let mesh = moduli(folder.path(), &["mesh", "egg.shape", "-o", "kept.ply"]);
    refused(&mesh, 1, &["kept.ply", "read-only"]);
    assert_eq!(fs::read(&path).unwrap(), b"old");
    let names = fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(names, 3);
}
