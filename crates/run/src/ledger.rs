//! Stored results of long computations, so that an interrupted run can continue.
//!
//! A stored result is used again only if
//! - its [`Key`] is equal: the digest of all inputs and options, and of the program itself, and
//! - its checksum is correct: the result has not changed since it was written.
//!
//! All other results are recomputed.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value, json};

use crate::digest::{self, Digest};

/// Digest of everything that a result depends on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key(String);

impl Key {
    /// The key of named parts, together with the running program.
    ///
    /// A part is the content of an input file, or options in a form that changes with every option,
    /// such as their JSON text.
    ///
    /// # Errors
    /// The file of the running program cannot be read.
    pub fn new(parts: &[(&str, &[u8])]) -> io::Result<Self> {
        Ok(Self::with_program(parts, &digest::of_this_program()?))
    }

    /// The key of named parts, together with a program of this digest.
    pub fn with_program(parts: &[(&str, &[u8])], program: &Digest) -> Self {
        let mut digest = Digest::new();
        let named = parts
            .iter()
            .map(|(name, content)| (name.as_bytes(), *content));
        let program = program.hex();
        for (name, content) in named.chain([(&b"program"[..], program.as_bytes())]) {
            // Lengths separate the parts.
            for part in [name, content] {
                digest.update(&(part.len() as u64).to_le_bytes());
                digest.update(part);
            }
        }
        Self(digest.hex())
    }

    /// The key as hexadecimal digits.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// The checksum of a result under a key; an error if the result cannot be written as JSON.
fn checksum(key: &Key, result: &impl Serialize) -> serde_json::Result<String> {
    let mut digest = Digest::of(key.0.as_bytes());
    digest.update(&serde_json::to_vec(result)?);
    Ok(digest.hex())
}

/// Why a result cannot be stored.
#[derive(Debug, thiserror::Error)]
pub enum LedgerError {
    /// The file cannot be created, read or written.
    #[error("cannot keep results in `{}`: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A result cannot be written as JSON.
    #[error("cannot keep a result: {0}")]
    Json(#[from] serde_json::Error),
}

/// A file of results, one line of JSON per job.
///
/// The first line holds the key. Every other line holds a job's index, its result and its checksum.
/// Many threads may append at once.
///
/// ```
/// use run::{Key, Ledger};
///
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("squares.jsonl");
/// let key = Key::new(&[("exponent", b"2")])?;
///
/// let (ledger, kept) = Ledger::open::<u64>(&file, &key, 3)?;
/// assert_eq!(kept, [None, None, None]);
/// ledger.append(1, &1_u64)?;
/// drop(ledger);
///
/// let (_, kept) = Ledger::open::<u64>(&file, &key, 3)?;
/// assert_eq!(kept, [None, Some(1), None]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Ledger {
    path: PathBuf,
    key: Key,
    file: Mutex<File>,
}

impl Ledger {
    /// Opens a file of results; creates it and its folder if they do not exist.
    ///
    /// Returns the stored results, one entry per job. If the file has another key, it is emptied. A
    /// line that is truncated, changed or not of this type is discarded with everything after it.
    ///
    /// # Errors
    /// The file cannot be created, read or written.
    pub fn open<R: DeserializeOwned>(
        path: &Path,
        key: &Key,
        jobs: usize,
    ) -> Result<(Self, Vec<Option<R>>), LedgerError> {
        let failed = |source| LedgerError::Io {
            path: path.to_owned(),
            source,
        };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        let mut file = OpenOptions::new()
            .create(true)
            .read(true)
            .append(true)
            .open(path)
            .map_err(failed)?;
        let mut text = Vec::new();
        file.read_to_end(&mut text).map_err(failed)?;
        let (kept, good) = good_lines(&text, key, jobs);
        file.set_len(good as u64).map_err(failed)?;
        let ledger = Self {
            path: path.to_owned(),
            key: key.clone(),
            file: Mutex::new(file),
        };
        if good == 0 {
            ledger.write(&json!({ "key": key.as_str() }))?;
        }
        Ok((ledger, kept))
    }

    /// Adds the result of a job.
    ///
    /// # Errors
    /// The result cannot be written as JSON, or the file cannot be written.
    pub fn append<R: Serialize>(&self, job: usize, result: &R) -> Result<(), LedgerError> {
        let entry = json!({ "job": job, "result": serde_json::to_value(result)? });
        let checksum = checksum(&self.key, &entry)?;
        self.write(&json!({ "entry": entry, "checksum": checksum }))
    }

    fn write(&self, line: &Value) -> Result<(), LedgerError> {
        let mut text = serde_json::to_string(line)?;
        text.push('\n');
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(text.as_bytes())
            .map_err(|source| LedgerError::Io {
                path: self.path.clone(),
                source,
            })
    }
}

/// The results of all valid lines, and the number of bytes of these lines.
fn good_lines<R: DeserializeOwned>(text: &[u8], key: &Key, jobs: usize) -> (Vec<Option<R>>, usize) {
    let mut results: Vec<Option<R>> = Vec::new();
    results.resize_with(jobs, || None);
    let mut lines = text.split_inclusive(|byte| *byte == b'\n');
    let first = lines.next().unwrap_or_default();
    let head: Option<Value> = serde_json::from_slice(first).ok();
    if !first.ends_with(b"\n") || head.is_none_or(|head| head["key"] != key.as_str()) {
        return (results, 0);
    }
    let mut good = first.len();
    for line in lines {
        let Some((job, result)) = good_line(line, key) else {
            break;
        };
        let Some(slot) = results.get_mut(job) else {
            break;
        };
        *slot = Some(result);
        good += line.len();
    }
    (results, good)
}

fn good_line<R: DeserializeOwned>(line: &[u8], key: &Key) -> Option<(usize, R)> {
    if !line.ends_with(b"\n") {
        return None;
    }
    let mut value: Value = serde_json::from_slice(line).ok()?;
    let mut entry = value["entry"].take();
    if value["checksum"] != checksum(key, &entry).ok()?.as_str() {
        return None;
    }
    let job = usize::try_from(entry["job"].as_u64()?).ok()?;
    let result = serde_json::from_value(entry["result"].take()).ok()?;
    Some((job, result))
}

/// Adds a seal to a result that is a JSON object, so that [`is_sealed`] can detect changes.
///
/// The seal is the object `value[name]`, to which `key` and `checksum` are added.
///
/// # Errors
/// The value cannot be written as JSON.
pub fn seal(value: &mut Map<String, Value>, name: &str, key: &Key) -> serde_json::Result<()> {
    let mut mark = match value.remove(name) {
        Some(Value::Object(mark)) => mark,
        _ => Map::new(),
    };
    mark.insert("key".to_owned(), Value::from(key.as_str()));
    value.insert(name.to_owned(), Value::Object(mark.clone()));
    let checksum = checksum(key, value)?;
    mark.insert("checksum".to_owned(), Value::from(checksum));
    value.insert(name.to_owned(), Value::Object(mark));
    Ok(())
}

/// Whether a result was sealed under this key and has not been changed since.
///
/// ```
/// use run::{Key, ledger};
/// use serde_json::{Map, Value};
///
/// let key = Key::new(&[("input", b"content of the input")])?;
/// let mut result = Map::from_iter([("quality".to_owned(), Value::from(0.7))]);
/// ledger::seal(&mut result, "made_by", &key)?;
/// assert!(ledger::is_sealed(&result, "made_by", &key));
/// result.insert("quality".to_owned(), Value::from(9.9));
/// assert!(!ledger::is_sealed(&result, "made_by", &key));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn is_sealed(value: &Map<String, Value>, name: &str, key: &Key) -> bool {
    let mut bare = value.clone();
    let Some(mark) = bare.get_mut(name).and_then(Value::as_object_mut) else {
        return false;
    };
    let found = mark.remove("checksum");
    let same_key = mark.get("key").is_some_and(|found| found == key.as_str());
    let right = checksum(key, &bare).ok().map(Value::from);
    same_key && found.is_some() && found == right
}
