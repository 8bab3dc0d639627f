//! Meshes that a URDF names, read only from the folders that the user gave.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::files;

/// Larger files are not read.
const MAX_BYTES: u64 = 64 << 20;

/// A package is looked for in this many folders above that of the URDF.
const LEVELS: usize = 6;

/// The folder of a URDF and the root of its packages, with links and `..` resolved.
pub(crate) struct MeshFolders {
    urdf: PathBuf,
    root: PathBuf,
    /// Whether the user gave the root; then packages are looked for only there.
    given: bool,
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
            given: root.is_some(),
        })
    }

    /// The bytes of a mesh by its name in the URDF.
    ///
    ///
    /// `package://NAME/REST` is NAME/REST or REST under the root, or, where no root is given, REST
    /// in the package that holds the URDF or lies beside it; other names are relative to the URDF.
    /// # Errors
    ///
    /// The name leads out of these folders, also by `..` or by a link, or there is no such file.
    pub(crate) fn bytes(&self, name: &str) -> Result<Vec<u8>, String> {
        let places = self.places(name);
        let found = places
            .iter()
            .find_map(|(folder, place)| Some((folder, place.canonicalize().ok()?)));
        let Some((folder, path)) = found else {
            return Err(self.nowhere(name, &places));
        };
        if ![folder, &self.urdf, &self.root]
            .iter()
            .any(|f| path.starts_with(f))
        {
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

    fn nowhere(&self, name: &str, places: &[(PathBuf, PathBuf)]) -> String {
        let tried: Vec<_> = places.iter().map(|p| p.1.display().to_string()).collect();
        let tried = format!("no such file: {}", tried.join(", "));
        match package_of(name) {
            Some((package, _)) => format!(
                "{tried}; give the folder that holds the package '{package}' with --package-root"
            ),
            None => tried,
        }
    }

    /// Where a mesh may be, each with the folder that it must not lead out of.
    fn places(&self, name: &str) -> Vec<(PathBuf, PathBuf)> {
        let Some((package, rest)) = package_of(name) else {
            let path = self.urdf.join(name.strip_prefix("file://").unwrap_or(name));
            return vec![(self.urdf.clone(), path)];
        };
        // Joining an absolute path would discard the folder.
        let under = |folder: &Path| folder.join(rest.trim_start_matches('/'));
        let mut places = vec![
            (self.root.clone(), under(&self.root.join(package))),
            (self.root.clone(), under(&self.root)),
        ];
        let plain = !package.is_empty() && !package.starts_with('.');
        if plain && !self.given {
            let folders = packages(&self.urdf, package);
            places.extend(folders.into_iter().map(|f| (f.clone(), under(&f))));
        }
        places
    }
}

/// NAME and REST of `package://NAME/REST`.
fn package_of(name: &str) -> Option<(&str, &str)> {
    let inside = name.strip_prefix("package://")?;
    Some(inside.split_once('/').unwrap_or((inside, "")))
}

/// Folders that may be the package of a name: those above the URDF that bear its name or hold a
/// package.xml, the one above the URDF's, and packages of that name beside any of these.
fn packages(urdf: &Path, package: &str) -> Vec<PathBuf> {
    let described = |folder: &Path| folder.join("package.xml").is_file();
    let mut found = Vec::new();
    for (level, folder) in urdf.ancestors().skip(1).take(LEVELS).enumerate() {
        let named = folder.file_name().is_some_and(|n| n == package);
        // The root of the file system is no package.
        if folder.parent().is_some() && (level == 0 || named || described(folder)) {
            found.push(folder.to_owned());
        }
        let beside = folder.join(package);
        if described(&beside) {
            found.push(beside);
        }
    }
    found
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

    #[test]
    fn packages_are_found_by_walking_up() {
        let (outer, _) = folders();
        let urdf = outer.path().join("robot/urdf/hand.urdf");
        let folders = MeshFolders::new(&urdf, None).unwrap();
        // The folder above that of the URDF, whatever it is called.
        for name in [
            "package://robot/meshes/a.stl",
            "package://other/meshes/a.stl",
        ] {
            assert_eq!(folders.bytes(name).unwrap(), b"a", "{name}");
        }
        // Farther up only what bears the name or describes itself as a package.
        let deep = outer.path().join("robot/urdf/left/small");
        std::fs::create_dir_all(&deep).unwrap();
        let folders = MeshFolders::new(&deep.join("hand.urdf"), None).unwrap();
        assert_eq!(folders.bytes("package://robot/meshes/a.stl").unwrap(), b"a");
        let error = folders.bytes("package://other/meshes/a.stl").unwrap_err();
        assert!(error.contains("'other' with --package-root"), "{error}");
        std::fs::write(outer.path().join("robot/package.xml"), "<package/>").unwrap();
        assert_eq!(folders.bytes("package://other/meshes/a.stl").unwrap(), b"a");
        // A package beside it.
        let beside = outer.path().join("parts/meshes");
        std::fs::create_dir_all(&beside).unwrap();
        std::fs::write(beside.join("b.stl"), "b").unwrap();
        assert!(folders.bytes("package://parts/meshes/b.stl").is_err());
        std::fs::write(outer.path().join("parts/package.xml"), "<package/>").unwrap();
        assert_eq!(folders.bytes("package://parts/meshes/b.stl").unwrap(), b"b");
        // Out of a package leads nothing.
        for name in [
            "package://parts/../secret.stl",
            "package://robot/meshes/../../secret.stl",
            "package://../secret.stl",
        ] {
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
