//! `moduli library`: a user's own known objects, from which `moduli grasp` transfers.

use std::path::Path;
use std::time::Instant;

use hand::Hand;
use moduli::{Kept, Library, Poses};
use record::{LibraryObjectRecord, LibraryRecord};
use run::{Digest, Key};
use serde::Serialize;

use crate::args::{
    Common, LibraryAddOptions, LibraryCommand, LibraryListOptions, LibraryRemoveOptions,
};
use crate::failure::Failure;
use crate::library_folder::{self, file_of};
use crate::{files, hands, input, output};

pub(crate) fn run(command: &LibraryCommand, common: &Common) -> Result<(), Failure> {
    match command {
        LibraryCommand::List(options) => list(options, common),
        LibraryCommand::Add(options) => add(options, common, false),
        LibraryCommand::Build(options) => add(options, common, true),
        LibraryCommand::Remove(options) => remove(options, common),
    }
}

/// An object of a library.
#[derive(Serialize)]
struct ObjectLine<'a> {
    object: &'a str,
    name: &'a str,
    hand: &'a str,
    convention: &'a str,
    grasps: usize,
    best: Option<f64>,
    rms_m: f64,
    /// Whether the file was there and up to date; absent in a list.
    #[serde(skip_serializing_if = "Option::is_none")]
    kept: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    seconds: Option<f64>,
}

/// The objects of a record as lines.
fn lines(record: &LibraryRecord) -> impl Iterator<Item = ObjectLine<'_>> {
    record.entries.iter().map(|entry| ObjectLine {
        object: &entry.id,
        name: &entry.name,
        hand: &record.hand,
        convention: &record.convention,
        grasps: entry.grasps.len(),
        best: entry.grasps.first().map(|g| g.quality),
        rms_m: entry.shape.rms_m,
        kept: None,
        seconds: None,
    })
}

impl ObjectLine<'_> {
    fn say(&self, common: &Common) -> Result<(), Failure> {
        if common.json {
            return output::say_json(self);
        }
        let best = self
            .best
            .map_or_else(|| "-".to_owned(), |q| format!("{q:.3}"));
        let made = match (self.kept, self.seconds) {
            (Some(true), _) => "  up to date".to_owned(),
            (_, Some(seconds)) => format!("  {seconds:.1} s"),
            _ => String::new(),
        };
        output::say(format!(
            "{:24} {:24} {:12} {:>3} grasps, best {best:>6}, convention {}{made}",
            self.object.escape_debug().to_string(),
            self.name.escape_debug().to_string(),
            self.hand.escape_debug().to_string(),
            self.grasps,
            self.convention.escape_debug(),
        ));
        Ok(())
    }
}

fn list(options: &LibraryListOptions, common: &Common) -> Result<(), Failure> {
    let Some(folder) = &options.folder else {
        for record in Library::builtin().records().map_err(Failure::library)? {
            lines(record).try_for_each(|line| line.say(common))?;
        }
        return Ok(());
    };
    let found = library_folder::read(folder)?;
    found.warnings.iter().for_each(output::warn);
    for object in &found.objects {
        lines(&object.library).try_for_each(|line| line.say(common))?;
    }
    Ok(())
}

fn remove(options: &LibraryRemoveOptions, common: &Common) -> Result<(), Failure> {
    let mut failures = Vec::new();
    for name in &options.names {
        let file = file_of(&options.folder, name);
        match std::fs::remove_file(&file) {
            Ok(()) if common.json => output::say_json(&serde_json::json!({ "removed": name }))?,
            Ok(()) => output::say(format!("removed {}", file.display())),
            Err(e) => failures.push(Failure::input(
                &file,
                format!("cannot remove the object: {e}; `moduli library list` prints the names"),
            )),
        }
    }
    Failure::all(failures)
}

/// Writes objects to a folder; with `resume`, those that are up to date are kept.
fn add(options: &LibraryAddOptions, common: &Common, resume: bool) -> Result<(), Failure> {
    let targets: Vec<_> = options
        .clouds
        .iter()
        .map(|cloud| file_of(&options.folder, &input::stem(cloud)))
        .collect();
    run::check_results(&targets, &options.clouds)?;
    let maker = Maker::new(options, common)?;
    let bar = output::progress(common.quiet, options.clouds.len(), "fitting and grasping");
    let mut failures = Vec::new();
    for (cloud, target) in options.clouds.iter().zip(&targets) {
        if let Err(failure) = maker.put(cloud, target, resume) {
            failures.push(failure);
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Failure::all(failures)
}

/// The settings that all objects share.
struct Maker<'a> {
    options: &'a LibraryAddOptions,
    common: &'a Common,
    convention: grasp::Convention,
    hand: Hand,
    /// Digest of the files that the hand was read from.
    hand_files: String,
}

impl<'a> Maker<'a> {
    fn new(options: &'a LibraryAddOptions, common: &'a Common) -> Result<Self, Failure> {
        let convention = input::convention(&options.convention)?;
        let hand = hands::load(&options.hand)?;
        let mut digest = Digest::new();
        for file in files::read_so_far() {
            digest.update(&input::read(&file)?);
        }
        Ok(Self {
            options,
            common,
            convention,
            hand,
            hand_files: digest.hex(),
        })
    }

    /// Digest of everything that the object of a cloud depends on.
    fn key(&self, cloud: &Path) -> Result<Key, Failure> {
        let options = self.options;
        let how = format!(
            "{:?} {:?} {} {} {}",
            options.fit, self.convention, options.poses, options.keep, self.common.seed
        );
        let name = input::stem(cloud);
        Key::new(&[
            ("name", name.as_bytes()),
            ("cloud", &input::read(cloud)?),
            ("hand", self.hand.name().as_bytes()),
            ("hand files", self.hand_files.as_bytes()),
            ("how", how.as_bytes()),
        ])
        .map_err(|e| Failure::other(format!("cannot read this program: {e}")))
    }

    /// Makes the object of a cloud and writes it, unless `resume` finds it up to date.
    fn put(&self, cloud: &Path, target: &Path, resume: bool) -> Result<(), Failure> {
        let start = Instant::now();
        let key = self.key(cloud)?;
        let stored = if resume { stored(target, &key) } else { None };
        let kept = stored.is_some();
        let object = match stored {
            Some(object) => object,
            None => {
                let object = self.make(cloud, &key)?;
                let bytes = object
                    .to_bytes()
                    .map_err(|e| Failure::other(e.to_string()))?;
                output::write_file(target, &bytes)?;
                object
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        lines(&object.library).try_for_each(|line| {
            let (kept, seconds) = (Some(kept), Some(seconds));
            ObjectLine {
                kept,
                seconds,
                ..line
            }
            .say(self.common)
        })
    }

    fn make(&self, path: &Path, key: &Key) -> Result<LibraryObjectRecord, Failure> {
        let options = self.options;
        let name = input::stem(path);
        let scan = input::scan(path, &options.fit.reading, self.common.seed)?;
        let object = input::fitted(&scan, &name, &options.fit, moduli::Model::Radial)?.object;
        let refused = |e: moduli::Error| Failure::refused(format!("{name}: {e}"));
        let measure = object.measure(&self.convention).map_err(refused)?;
        let poses = Poses {
            count: options.poses,
            seed: self.common.seed,
            ..Poses::default()
        };
        let found = measure.synthesize(&self.hand, &poses).map_err(refused)?;
        let kept = Kept {
            grasps: options.keep,
            ..Kept::default()
        };
        let entry = object.library_entry(&name, &name, &found, &kept);
        let entry = entry.ok_or_else(|| {
            Failure::refused(format!("{name}: a library holds radial surfaces only"))
        })?;
        if entry.grasps.is_empty() {
            output::warn(format!(
                "{name}: the hand {} finds no stable grasp; the object is stored without grasps",
                self.hand.name()
            ));
        }
        Ok(LibraryObjectRecord {
            made_from: key.as_str().to_owned(),
            library: LibraryRecord {
                seed: self.common.seed,
                convention: self.convention.name.clone(),
                hand: self.hand.name().to_owned(),
                entries: vec![entry],
            },
        })
    }
}

/// The object in a file, if it is undamaged and its key is `key`.
fn stored(target: &Path, key: &Key) -> Option<LibraryObjectRecord> {
    let bytes = std::fs::read(target).ok()?;
    let object = LibraryObjectRecord::from_bytes(&bytes).ok()?;
    (object.made_from == key.as_str()).then_some(object)
}
