//! Hands: the built-in one, or a URDF with its TOML.

pub(crate) mod findings;
pub(crate) mod page;
pub(crate) mod trial;

use std::path::{Path, PathBuf};

use hand::{Hand, HandModel, HandSpec, load_urdf_with_meshes, urdf_text};

use crate::args::HandOptions;
use crate::failure::Failure;
use crate::input;
use crate::mesh_folders::MeshFolders;

/// The name of the built-in hand.
const BUILT_IN: &str = "sdh";

/// The hand that the options name.
pub(crate) fn load(options: &HandOptions) -> Result<Hand, Failure> {
    if is_built_in(options)? {
        return built_in();
    }
    let urdf = &options.hand;
    let folders = MeshFolders::new(urdf, options.package_root.as_deref())?;
    let bytes = input::read(urdf)?;
    let model: HandModel = load_urdf_with_meshes(&urdf_text(&bytes), |name| folders.bytes(name))
        .map_err(|e| Failure::input(urdf, e))?;
    let path = spec_path(options);
    let spec = HandSpec::from_toml(&spec_text(options)?).map_err(|e| Failure::input(&path, e))?;
    Hand::new(model, &spec).map_err(|e| {
        Failure::input(
            &path,
            format!("{e}; `moduli hand check` lists everything that is wrong"),
        )
    })
}

/// Whether the options ask for the built-in hand, which brings its own spec.
pub(crate) fn is_built_in(options: &HandOptions) -> Result<bool, Failure> {
    if options.hand != Path::new(BUILT_IN) {
        return check_named(&options.hand).map(|()| false);
    }
    if options.spec.is_some() || options.package_root.is_some() {
        return Err(Failure::usage(
            "the built-in hand `sdh` has its own TOML and no meshes; give the URDF that yours belong to",
        ));
    }
    Ok(true)
}

/// A bare word that is no file is the name of a hand that does not exist.
fn check_named(hand: &Path) -> Result<(), Failure> {
    let bare = hand.extension().is_none() && hand.components().count() == 1;
    if bare && !hand.exists() {
        return Err(Failure::usage(format!(
            "no hand is named `{}`; the names are: {BUILT_IN}; for another hand give the path of its URDF",
            hand.display()
        )));
    }
    Ok(())
}

/// The hand inside the program.
pub(crate) fn built_in() -> Result<Hand, Failure> {
    hand::schunk_sdh().map_err(|e| Failure::other(format!("the built-in hand: {e}")))
}

/// The TOML given, or the one beside the URDF.
pub(crate) fn spec_path(options: &HandOptions) -> PathBuf {
    let beside = || options.hand.with_extension("toml");
    options.spec.clone().unwrap_or_else(beside)
}

/// The text of the TOML.
pub(crate) fn spec_text(options: &HandOptions) -> Result<String, Failure> {
    let path = spec_path(options);
    if options.spec.is_none() && !path.exists() {
        return Err(Failure::input(
            &path,
            "no such file; a hand needs a TOML beside its URDF, or --spec TOML (docs/bring-your-own-hand.md)",
        ));
    }
    text(&path)
}

/// The text of a TOML file.
fn text(path: &Path) -> Result<String, Failure> {
    String::from_utf8(input::read(path)?).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let reason = format!("byte {at} is not UTF-8, which TOML needs; save the file as UTF-8");
        Failure::input(path, reason)
    })
}
