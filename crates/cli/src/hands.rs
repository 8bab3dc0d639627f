//! Hands: a built-in hand, or a URDF with its TOML.

pub(crate) mod findings;
pub(crate) mod page;
pub(crate) mod trial;

use std::path::{Path, PathBuf};

use hand::{Hand, HandModel, HandSpec, load_urdf_with_meshes, urdf_text};

use crate::args::HandOptions;
use crate::failure::Failure;
use crate::input;
use crate::mesh_folders::MeshFolders;

/// The hand that the options name.
pub(crate) fn load(options: &HandOptions) -> Result<Hand, Failure> {
    if let Some(hand) = built_in(options)? {
        return Ok(hand);
    }
    let model = model(&options.hand, options.package_root.as_deref())?;
    let path = spec_path(options);
    let spec = HandSpec::from_toml(&spec_text(options)?).map_err(|e| Failure::input(&path, e))?;
    Hand::new(model, &spec).map_err(|e| {
        Failure::input(
            &path,
            format!("{e}; `moduli hand check` lists everything that is wrong"),
        )
    })
}

/// The URDF with its meshes.
pub(crate) fn model(urdf: &Path, package_root: Option<&Path>) -> Result<HandModel, Failure> {
    let folders = MeshFolders::new(urdf, package_root)?;
    let bytes = input::read(urdf)?;
    load_urdf_with_meshes(&urdf_text(&bytes), |name| folders.bytes(name))
        .map_err(|e| Failure::input(urdf, e))
}

/// The built-in hand that the options name; it brings its own spec.
pub(crate) fn built_in(options: &HandOptions) -> Result<Option<Hand>, Failure> {
    let found = options.hand.to_str().and_then(Hand::built_in);
    let Some(hand) = found else {
        return check_named(&options.hand).map(|()| None);
    };
    if options.spec.is_some() || options.package_root.is_some() {
        return Err(Failure::usage(format!(
            "the built-in hand `{}` has its own TOML and no meshes; give the URDF that yours belong to",
            options.hand.display()
        )));
    }
    let hand = hand.map_err(|e| Failure::other(format!("the built-in hand: {e}")))?;
    Ok(Some(hand))
}

/// A word that is not the name of a file or of a built-in hand.
fn check_named(hand: &Path) -> Result<(), Failure> {
    let bare = hand.extension().is_none() && hand.components().count() == 1;
    if bare && !hand.exists() {
        return Err(Failure::usage(format!(
            "no hand is named `{}`; the names are {}; for another hand give the path of its URDF",
            hand.display(),
            Hand::BUILT_IN.join(", ")
        )));
    }
    Ok(())
}

/// The TOML given, or the one beside the URDF.
pub(crate) fn spec_path(options: &HandOptions) -> PathBuf {
    let beside = || options.hand.with_extension("toml");
    options.spec.clone().unwrap_or_else(beside)
}

/// The text of the TOML.
pub(crate) fn spec_text(options: &HandOptions) -> Result<String, Failure> {
    let path = spec_path(options);
    if let Some(text) = carried_spec(&path) {
        return Ok(text.to_owned());
    }
    if options.spec.is_none() && !path.exists() {
        return Err(Failure::input(
            &path,
            format!(
                "no such file; a hand needs a TOML beside its URDF, or --spec TOML; `moduli hand init {}` writes a first one",
                options.hand.display()
            ),
        ));
    }
    text(&path)
}

/// The TOML that moduli carries under a name, unless there is a file of that name.
fn carried_spec(path: &Path) -> Option<&'static str> {
    if path.exists() {
        return None;
    }
    let found = fixtures::HAND_SPECS
        .iter()
        .find(|(name, _)| Path::new(name) == path);
    found.map(|(_, text)| *text)
}

/// The text of a TOML file.
fn text(path: &Path) -> Result<String, Failure> {
    String::from_utf8(input::read(path)?).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let reason = format!("byte {at} is not UTF-8, which TOML needs; save the file as UTF-8");
        Failure::input(path, reason)
    })
}
