//! The objects of an experiment: the built-in catalogue, or a folder of clouds.

use std::path::{Path, PathBuf};

use catalogue::CatalogueObject;
use rayon::prelude::*;
use serde::Serialize;
use shape::PointCloud;

use crate::error::ExperimentError;

/// Origin of the objects.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ObjectSource {
    /// S1 to S12 of the catalogue.
    Builtin,
    /// Every .ply file of a folder, in the order of the names.
    Folder(PathBuf),
}

impl std::fmt::Display for ObjectSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Builtin => f.write_str("builtin"),
            Self::Folder(path) => path.display().fmt(f),
        }
    }
}

/// One object as a cloud, in its own frame, metres.
#[derive(Clone, Debug)]
pub struct ObjectCloud {
    /// k for S_k: the position in the whole list, from 1.
    pub number: usize,
    /// "S5", or the file's name without its ending.
    pub id: String,
    /// Readable name; the id for files.
    pub name: String,
    /// Its points.
    pub cloud: PointCloud,
    /// The true surface of a built-in object.
    pub truth: Option<&'static CatalogueObject>,
}

/// An object that could not be used.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refused {
    /// Its id.
    pub id: String,
    /// The cause.
    pub reason: String,
}

/// The usable clouds, and the objects that could not be read.
#[derive(Clone, Debug)]
pub struct Objects {
    /// Origin of the objects.
    pub source: ObjectSource,
    /// Usable clouds, in order.
    pub clouds: Vec<ObjectCloud>,
    /// Objects that could not be read.
    pub refused: Vec<Refused>,
}

impl Objects {
    /// Generates scans of the catalogue from a seed, or reads a folder.
    ///
    /// A file that cannot be read or is not a cloud is listed among the refused.
    ///
    /// # Errors
    /// The folder cannot be listed.
    pub fn load(source: &ObjectSource, seed: u64) -> Result<Self, ExperimentError> {
        let found: Vec<Result<ObjectCloud, Refused>> = match source {
            ObjectSource::Builtin => catalogue::library_objects()
                .par_iter()
                .map(|object| scan(object, seed))
                .collect(),
            ObjectSource::Folder(folder) => ply_files(folder)?
                .par_iter()
                .map(|path| read(path))
                .collect(),
        };
        let mut objects = Self {
            source: source.clone(),
            clouds: Vec::new(),
            refused: Vec::new(),
        };
        for (index, item) in found.into_iter().enumerate() {
            match item {
                Ok(cloud) => objects.clouds.push(ObjectCloud {
                    number: index + 1,
                    ..cloud
                }),
                Err(refused) => objects.refused.push(refused),
            }
        }
        Ok(objects)
    }

    /// Keeps the objects with the given ids, with their numbers unchanged; keeps all if there are
    /// no ids.
    ///
    /// # Errors
    /// An id belongs neither to a cloud nor to a refused object.
    pub fn only(mut self, ids: &[String]) -> Result<Self, ExperimentError> {
        let all = self.clouds.iter().map(|c| &c.id);
        let known: Vec<String> = all
            .chain(self.refused.iter().map(|r| &r.id))
            .cloned()
            .collect();
        if let Some(id) = ids.iter().find(|id| !known.contains(id)) {
            return Err(ExperimentError::UnknownObject {
                id: id.clone(),
                source_name: self.source.to_string(),
                known: known.join(", "),
            });
        }
        if !ids.is_empty() {
            self.clouds.retain(|c| ids.contains(&c.id));
            self.refused.retain(|r| ids.contains(&r.id));
        }
        Ok(self)
    }

    /// Keeps the objects S_k of the given numbers; where some of them do not exist, the first
    /// objects, as many as numbers.
    pub fn select(mut self, numbers: &[usize]) -> Self {
        let exists = |k: &usize| self.clouds.iter().any(|c| c.number == *k);
        if numbers.iter().all(exists) {
            self.clouds.retain(|c| numbers.contains(&c.number));
        } else {
            self.clouds.truncate(numbers.len());
        }
        self
    }
}

fn scan(object: &'static CatalogueObject, seed: u64) -> Result<ObjectCloud, Refused> {
    let id = object.id.to_owned();
    match PointCloud::new(object.scan(seed)) {
        Ok(cloud) => Ok(ObjectCloud {
            number: 0,
            id,
            name: object.name.to_owned(),
            cloud,
            truth: Some(object),
        }),
        Err(error) => Err(Refused {
            id,
            reason: error.to_string(),
        }),
    }
}

fn ply_files(folder: &Path) -> Result<Vec<PathBuf>, ExperimentError> {
    let failed = |reason| ExperimentError::Folder {
        path: folder.to_owned(),
        reason,
    };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let ending = path.extension().unwrap_or_default();
        if ending.eq_ignore_ascii_case("ply") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn read(path: &Path) -> Result<ObjectCloud, Refused> {
    let id = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let cloud = std::fs::read(path)
        .map_err(|error| error.to_string())
        .and_then(|bytes| shape::io::read_ply(&bytes).map_err(|error| error.to_string()))
        .and_then(|ply| PointCloud::new(ply.points).map_err(|error| error.to_string()));
    match cloud {
        Ok(cloud) => Ok(ObjectCloud {
            number: 0,
            name: id.clone(),
            id,
            cloud,
            truth: None,
        }),
        Err(reason) => Err(Refused { id, reason }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n\
        property float y\nproperty float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

    #[test]
    fn folders_are_read_in_the_order_of_names_and_bad_files_are_listed() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.ply", "a.PLY"] {
            std::fs::write(folder.path().join(name), TETRAHEDRON).unwrap();
        }
        std::fs::write(folder.path().join("aa.ply"), "no cloud at all").unwrap();
        std::fs::write(folder.path().join("notes.txt"), "not looked at").unwrap();
        let source = ObjectSource::Folder(folder.path().to_owned());
        let objects = Objects::load(&source, 0).unwrap();
        let ids: Vec<_> = objects
            .clouds
            .iter()
            .map(|c| (c.id.as_str(), c.number))
            .collect();
        assert_eq!(ids, [("a", 1), ("b", 3)]);
        assert_eq!(objects.refused.len(), 1);
        assert_eq!(objects.refused[0].id, "aa");
        assert!(!objects.refused[0].reason.is_empty());
        let only = objects.clone().only(&["b".to_owned()]).unwrap();
        assert_eq!((only.clouds.len(), only.refused.len()), (1, 0));
        assert_eq!(
            (only.clouds[0].id.as_str(), only.clouds[0].number),
            ("b", 3)
        );
        let error = objects.only(&["c".to_owned()]).unwrap_err();
        assert_eq!(error.exit_code(), 3);
        assert!(error.to_string().contains("a, b, aa"), "{error}");
    }

    #[test]
    fn a_missing_folder_is_an_input_error() {
        let source = ObjectSource::Folder(PathBuf::from("no/such/folder"));
        assert_eq!(Objects::load(&source, 0).unwrap_err().exit_code(), 3);
    }

    #[test]
    fn selects_by_number_or_takes_the_first() {
        let objects = Objects::load(&ObjectSource::Builtin, 3).unwrap();
        assert_eq!(objects.clouds.len(), 12);
        let ids = |o: Objects| o.clouds.into_iter().map(|c| c.id).collect::<Vec<_>>();
        assert_eq!(
            ids(objects.clone().select(&[2, 5, 12])),
            ["S2", "S5", "S12"]
        );
        assert_eq!(ids(objects.select(&[2, 13])), ["S1", "S2"]);
    }
}
