//! Options of the commands on libraries of known objects.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::{CloudOptions, ConventionOptions, HandOptions, count_in};

#[derive(Debug, Subcommand)]
pub(crate) enum LibraryCommand {
    /// List the objects of a library with their grasps.
    #[command(after_help = "Example: moduli library list mine")]
    List(LibraryListOptions),
    /// Fit objects, find grasps on them, and put both into a library. An object of the same name is
    /// replaced.
    #[command(after_help = "Example: moduli library add mine mug.ply bottle.ply")]
    Add(LibraryAddOptions),
    /// The same for many objects, except those that are up to date: an interrupted run is resumed.
    #[command(after_help = "Example: moduli library build mine scans/*.ply --poses 700")]
    Build(LibraryAddOptions),
    /// Remove objects from a library.
    #[command(after_help = "Example: moduli library remove mine mug")]
    Remove(LibraryRemoveOptions),
}

#[derive(Debug, Args)]
pub(crate) struct LibraryListOptions {
    /// Folder of the library; the built-in library when absent.
    pub(crate) folder: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct LibraryAddOptions {
    /// Folder of the library; it is created if it does not exist.
    pub(crate) folder: PathBuf,
    /// Clouds or meshes. The name of the file names the object.
    #[arg(required = true)]
    pub(crate) clouds: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) fit: CloudOptions,
    #[command(flatten)]
    pub(crate) hand: HandOptions,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
    /// Number of hand poses to try per object.
    #[arg(long, default_value_t = 1400, value_parser = count_in::<1, 1_000_000>)]
    pub(crate) poses: usize,
    /// Number of grasps to keep per object, the best that differ from each other.
    #[arg(long, default_value_t = 12, value_parser = count_in::<1, 10_000>)]
    pub(crate) keep: usize,
}

#[derive(Debug, Args)]
pub(crate) struct LibraryRemoveOptions {
    /// Folder of the library.
    pub(crate) folder: PathBuf,
    /// Names of the objects, as `moduli library list` prints them.
    #[arg(required = true)]
    pub(crate) names: Vec<String>,
}
