//! Meshes that a URDF names, read from the folders that the user gave and nowhere else.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::files;

/// Larger files are not read.
const MAX_BYTES: u64 = 64 << 20;

/// The folder of a URDF and the root of its packages, with links and `..` resolved.
pub(crate) struct MeshFolders {
    urdf: PathBuf,
    root: PathBuf,
}

impl MeshFolders {
    /// `root` is the folder of the URDF unless given.
    pub(crate) fn new(urdf: &Path, root: Option<&Path>) -> Result<Self, Failure> {
        let beside = match urdf.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let resolve = |folder: &Path| {
            let folder = folder
                .canonicalize()
                .map_err(|e| Failure::input(folder, e))?;
            if folder.is_dir() {
                Ok(folder)
            } else {
                Err(Failure::input(&folder, "expected a folder"))
            }
        };
        Ok(Self {
            urdf: resolve(beside)?,
            root: resolve(root.unwrap_or(beside))?,
        })
    }

    /// The bytes of a mesh by its name in the URDF.
    ///
    /// `package://NAME/REST` is NAME/REST or REST under the root; other names are relative to the
    /// URDF. Errors: a name that leads out of both folders, by `..` or by a link too; no file.
    pub(crate) fn bytes(&self, name: &str) -> Result<Vec<u8>, String> {
        let places = self.places(name);
        let found = places.iter().find_map(|place| place.canonicalize().ok());
        let Some(path) = found else {
            let tried: Vec<_> = places.iter().map(|p| p.display().to_string()).collect();
            return Err(format!("no such file: {}", tried.join(", ")));
        };
        if !(path.starts_with(&self.urdf) || path.starts_with(&self.root)) {
            return Err(format!(
                "it lies outside {}; give the folder that holds it with --package-root",
                self.root.display()
            ));
        }
        let facts = path.metadata().map_err(|e| e.to_string())?;
        if !facts.is_file() {
            return Err(format!("{} is no file", path.display()));
        }
        if facts.len() > MAX_BYTES {
            return Err(format!("{} bytes, more than {MAX_BYTES}", facts.len()));
        }
        files::bytes(&path).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn places(&self, name: &str) -> Vec<PathBuf> {
        let Some(in_package) = name.strip_prefix("package://") else {
            return vec![self.urdf.join(name.strip_prefix("file://").unwrap_or(name))];
        };
        let rest = in_package.split_once('/').map_or("", |(_, rest)| rest);
        // Joining an absolute path would forget the root.
        let under = |path: &str| self.root.join(path.trim_start_matches('/'));
        vec![under(in_package), under(rest)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folders() -> (tempfile::TempDir, MeshFolders) {
        let outer = tempfile::TempDir::new().unwrap();
        let robot = outer.path().join("robot");
        std::fs::create_dir_all(robot.join("urdf")).unwrap();
        std::fs::create_dir_all(robot.join("meshes")).unwrap();
        for (name, content) in [("robot/meshes/a.stl", "a"), ("secret.stl", "s")] {
            std::fs::write(outer.path().join(name), content).unwrap();
        }
        let folders = MeshFolders::new(&robot.join("urdf/hand.urdf"), Some(&robot)).unwrap();
        (outer, folders)
    }

    #[test]
    fn names_are_found_under_the_root_and_beside_the_urdf() {
        let (_outer, folders) = folders();
        for name in [
            "package://meshes/a.stl",
            "package://robot/meshes/a.stl",
            "../meshes/a.stl",
            "package://robot//meshes/../meshes/a.stl",
        ] {
            assert_eq!(folders.bytes(name).unwrap(), b"a", "{name}");
        }
    }

    #[test]
    fn nothing_outside_is_read() {
        let (outer, folders) = folders();
        let absolute = outer.path().join("secret.stl");
        let absolute = absolute.to_str().unwrap();
        for name in [
            "../../secret.stl",
            "package://../secret.stl",
            "package://robot/../secret.stl",
            absolute,
            &format!("file://{absolute}"),
        ] {
            let error = folders.bytes(name).unwrap_err();
            assert!(error.contains("outside"), "{name}: {error}");
        }
        // An absolute path after the mark is looked for under the root, where there is none.
        assert!(folders.bytes(&format!("package://{absolute}")).is_err());
        for name in ["package://", "", ".", "package://robot"] {
            assert!(folders.bytes(name).is_err(), "{name}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_out_are_not_followed() {
        let (outer, folders) = folders();
        let link = |target: &Path, name: &str| {
            std::os::unix::fs::symlink(target, outer.path().join("robot/meshes").join(name))
                .unwrap();
        };
        link(&outer.path().join("secret.stl"), "link.stl");
        link(outer.path(), "up");
        link(&outer.path().join("robot/meshes/a.stl"), "inside.stl");
        for name in ["package://robot/meshes/link.stl", "../meshes/up/secret.stl"] {
            assert!(
                folders.bytes(name).unwrap_err().contains("outside"),
                "{name}"
            );
        }
        assert_eq!(folders.bytes("../meshes/inside.stl").unwrap(), b"a");
    }
}
