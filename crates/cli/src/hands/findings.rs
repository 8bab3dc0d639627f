//! All faults of a hand's two files.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;

use hand::{
    Hand, HandModel, HandSpec, Severity, check_hand, load_urdf_with_meshes, mesh_vertices,
    urdf_text,
};
use serde::Serialize;

use super::{built_in, spec_path, spec_text};
use crate::args::HandOptions;
use crate::failure::Failure;
use crate::input;
use crate::mesh_folders::MeshFolders;

/// Distance that parts of a hand should keep from each other, metres (Sec. IV-C of the paper).
const SELF_CLEARANCE: f64 = 5e-3;
/// Replaces a mesh that cannot be read, so that the rest can be checked.
const STAND_IN: &[u8] = b"v 0 0 0\nv 0.001 0 0\nv 0 0.001 0\nv 0 0 0.001\n";

/// A finding.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Finding {
    /// `error`, `warning` or `note`.
    pub(crate) severity: &'static str,
    /// The file.
    pub(crate) place: String,
    pub(crate) text: String,
}

/// The hand, if it can be made, and what was found.
pub(crate) struct Checked {
    pub(crate) hand: Option<Hand>,
    pub(crate) findings: Vec<Finding>,
}

impl Checked {
    pub(crate) fn count(&self, severity: &str) -> usize {
        let of = self.findings.iter().filter(|f| f.severity == severity);
        of.count()
    }

    fn error(&mut self, path: &Path, text: impl ToString) {
        self.findings.push(Finding {
            severity: "error",
            place: path.display().to_string(),
            text: text.to_string(),
        });
    }
}

/// Reads both files and collects all findings; fails only on wrong usage.
pub(crate) fn check(options: &HandOptions) -> Result<Checked, Failure> {
    let mut checked = Checked {
        hand: None,
        findings: Vec::new(),
    };
    checked.hand = built_in(options)?;
    if checked.hand.is_none() {
        let model = model(options, &mut checked);
        let spec = spec(options, &mut checked);
        if let (Some(model), Some(spec)) = (model, spec) {
            join(options, model, &spec, &mut checked);
        }
    }
    if let Some(hand) = &checked.hand {
        let found = check_hand(hand, SELF_CLEARANCE).map_err(|e| Failure::other(e.to_string()))?;
        let place = spec_path(options).display().to_string();
        checked.findings.extend(found.into_iter().map(|f| Finding {
            severity: match f.severity {
                Severity::Note => "note",
                Severity::Warning => "warning",
                Severity::Error => "error",
            },
            place: place.clone(),
            text: f.text,
        }));
    }
    Ok(checked)
}

/// The URDF. All meshes that cannot be read are named, not only the first.
fn model(options: &HandOptions, checked: &mut Checked) -> Option<HandModel> {
    let urdf = &options.hand;
    let read = || -> Result<(Vec<u8>, MeshFolders), Failure> {
        let bytes = input::read(urdf)?;
        let folders = MeshFolders::new(urdf, options.package_root.as_deref())?;
        Ok((bytes, folders))
    };
    let (bytes, folders) = match read() {
        Ok(both) => both,
        Err(failure) => {
            checked.findings.push(bare(failure));
            return None;
        }
    };
    let missing = RefCell::new(BTreeSet::new());
    let model = load_urdf_with_meshes(&urdf_text(&bytes), |name| {
        let usable = folders.bytes(name).and_then(|bytes| {
            mesh_vertices(&bytes, name).map_err(|e| e.to_string())?;
            Ok(bytes)
        });
        Ok::<_, String>(usable.unwrap_or_else(|reason| {
            missing.borrow_mut().insert((name.to_owned(), reason));
            STAND_IN.to_vec()
        }))
    });
    for (name, reason) in missing.into_inner() {
        checked.error(urdf, format!("collision mesh '{name}': {reason}"));
    }
    match model {
        Ok(model) => Some(model),
        Err(e) => {
            checked.error(urdf, e);
            None
        }
    }
}

fn spec(options: &HandOptions, checked: &mut Checked) -> Option<HandSpec> {
    let text = match spec_text(options) {
        Ok(text) => text,
        Err(failure) => {
            checked.findings.push(bare(failure));
            return None;
        }
    };
    match HandSpec::from_toml(&text) {
        Ok(spec) => Some(spec),
        Err(e) => {
            checked.error(&spec_path(options), e.to_string().trim_end());
            None
        }
    }
}

/// A failure whose message names its file already.
fn bare(failure: Failure) -> Finding {
    let (place, text) = failure
        .message
        .split_once(": ")
        .unwrap_or(("", &failure.message));
    Finding {
        severity: "error",
        place: place.to_owned(),
        text: text.to_owned(),
    }
}

fn join(options: &HandOptions, model: HandModel, spec: &HandSpec, checked: &mut Checked) {
    let path = spec_path(options);
    for problem in Hand::problems(&model, spec) {
        checked.error(&path, problem);
    }
    if checked.findings.is_empty() {
        match Hand::new(model, spec) {
            Ok(hand) => checked.hand = Some(hand),
            Err(e) => checked.error(&path, e),
        }
    }
}
