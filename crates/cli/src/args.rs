//! The command line.

mod contact;
mod grasps;
mod hands;
mod library;
mod scene;
mod shapes;
mod support;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

pub(crate) use grasps::{
    AscendOptions, AscentScheme, LimitOptions, Metric, MoveOptions, QualityOptions,
    TransferOptions, TransferScheme,
};
pub(crate) use hands::{
    ExportKind, ExportOptions, GraspOptions, HandCheckOptions, HandCommand, HandInitOptions,
    HandOptions, SynthesizeOptions,
};
pub(crate) use library::{
    LibraryAddOptions, LibraryCommand, LibraryListOptions, LibraryRemoveOptions,
};
pub(crate) use scene::SceneOptions;
pub(crate) use shapes::{
    DistanceOptions, EvalOptions, FitOptions, InfoOptions, MeshOptions, SurfaceChoice,
};

/// Grasps from scans: smooth surfaces with proofs, certified grasp quality, transfer between objects.
///
/// Every point, pose and mesh that is read or written is in the frame of the user's cloud, in metres.
/// Exit codes: 0 done, 2 wrong usage, 3 bad input, 4 refused on numerical grounds, 1 anything else.
#[derive(Debug, Parser)]
#[command(
    name = "moduli",
    version,
    about,
    arg_required_else_help = true,
    after_help = "Example: moduli grasp scan.ply -o out    (then open out/index.html)"
)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) common: Common,
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// Options of every command.
#[derive(Debug, Args)]
pub(crate) struct Common {
    /// Print the result on standard output as JSON.
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Number of threads; by default one per core.
    #[arg(long, global = true, value_parser = count_in::<1, 1024>)]
    pub(crate) threads: Option<usize>,
    /// Seed of all random numbers. The same seed gives the same files, byte for byte, on any number of
    /// threads.
    #[arg(long, global = true, default_value_t = 0)]
    pub(crate) seed: u64,
    /// Do not show progress on standard error.
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Fit a smooth surface to each cloud or mesh and prove it valid.
    #[command(
        after_help = "Example: moduli fit scan.ply -o scan.shape\nExample: moduli fit mug.ply -o mug.shape\nExample: moduli fit bent.xyz --model spherical --directions U.npy -o bent.shape"
    )]
    Fit(FitOptions),
    /// Evaluate a surface at given directions.
    #[command(after_help = "Example: moduli eval scan.shape --directions U.npy -o V.npy")]
    Eval(EvalOptions),
    /// Write a surface as a triangle mesh.
    #[command(after_help = "Example: moduli mesh scan.shape -o scan_mesh.ply")]
    Mesh(MeshOptions),
    /// Print the distances between surfaces, in the space of radial functions.
    #[command(after_help = "Example: moduli distance mug.shape bottle.shape")]
    Distance(DistanceOptions),
    /// Compute the quality of given grasps.
    #[command(
        after_help = "Example: moduli quality out/grasps.json --all\nExample: moduli quality grasps.npy --convention dexnet -o Q.npy"
    )]
    Quality(QualityOptions),
    /// Improve the quality of grasps by moving their contacts over the surface.
    #[command(after_help = "Example: moduli ascend scan.shape out/grasps.json -o better.json")]
    Ascend(AscendOptions),
    /// Transfer grasps from one object to another.
    #[command(
        after_help = "Example: moduli transfer --from mug.shape --to cup.shape mug_grasps.json -o cup_grasps.json"
    )]
    Transfer(TransferOptions),
    /// Sample hand poses around an object, close the hand from each, and rank the grasps.
    #[command(after_help = "Example: moduli synthesize scan.shape --poses 1400 -o out")]
    Synthesize(SynthesizeOptions),
    /// Work with a custom hand.
    #[command(
        subcommand,
        after_help = "Example: moduli hand check gripper.urdf gripper.toml"
    )]
    Hand(HandCommand),
    /// Do everything: fit the cloud, transfer and synthesize grasps, and write a page of the results.
    #[command(
        after_help = "Example: moduli grasp scan.ply -o out\nExample: moduli grasp scan.ply --unit mm --convention openrave -o out\nExample: moduli grasp mug.ply bottle.ply --library mine -o out"
    )]
    Grasp(GraspOptions),
    /// Manage a library of your own known objects, from which `moduli grasp --library` transfers.
    #[command(
        subcommand,
        after_help = "Example: moduli library add mine mug.ply && moduli grasp scan.ply --library mine"
    )]
    Library(LibraryCommand),
    /// Write the grasps of a grasps.json that have a hand for another program.
    #[command(after_help = "Example: moduli export moveit out/grasps.json -o grasps_moveit.yaml")]
    Export(ExportOptions),
    /// Describe a shape, a library, a grasps.json, a cloud or a mesh.
    #[command(after_help = "Example: moduli info scan.shape")]
    Info(InfoOptions),
    /// Print the completions of a shell.
    #[command(
        after_help = "Example: moduli completions bash > ~/.local/share/bash-completion/completions/moduli"
    )]
    Completions(CompletionOptions),
    /// Write the manual pages, one per command.
    #[command(after_help = "Example: moduli man ~/.local/share/man/man1")]
    Man(ManOptions),
}

#[derive(Debug, Args)]
pub(crate) struct CompletionOptions {
    /// The shell.
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct ManOptions {
    /// Folder for moduli.1, moduli-fit.1 and so on.
    pub(crate) folder: PathBuf,
}

/// Parses a whole number from LOW to HIGH.
fn count_in<const LOW: usize, const HIGH: usize>(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if (LOW..=HIGH).contains(&count) => Ok(count),
        _ => Err(format!("expected a whole number from {LOW} to {HIGH}")),
    }
}

/// How clouds are read.
#[derive(Clone, Debug, Args)]
pub(crate) struct ReadingOptions {
    /// Unit of the coordinates in the file. Default: metres, where an extent above 2 m or below 5 mm is
    /// refused.
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,
    /// Number of points sampled from a mesh, uniformly by area.
    #[arg(long, default_value_t = 25_000, value_parser = count_in::<100, 10_000_000>)]
    pub(crate) samples: usize,
}

/// How clouds are read and fitted.
#[derive(Clone, Debug, Args)]
pub(crate) struct CloudOptions {
    #[command(flatten)]
    pub(crate) reading: ReadingOptions,
    /// Highest degree of the spherical harmonics.
    #[arg(long, default_value_t = 50, value_parser = count_in::<0, 150>)]
    pub(crate) degree: usize,
    /// Weight of the smoothness penalty; by default it is chosen from the data.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) lambda: Option<f64>,
    /// Smooth the surface by heat flow for this time. Details narrower than about its square root, in
    /// radians, disappear; 0.001 rounds edges.
    #[arg(long, value_name = "SIGMA", allow_negative_numbers = true)]
    pub(crate) heat: Option<f64>,
    #[command(flatten)]
    pub(crate) scene: SceneOptions,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Unit {
    /// Metres.
    M,
    /// Centimetres.
    Cm,
    /// Millimetres.
    Mm,
    /// Inches.
    In,
}

impl Unit {
    pub(crate) fn metres(self) -> f64 {
        match self {
            Unit::M => 1.0,
            Unit::Cm => 1e-2,
            Unit::Mm => 1e-3,
            Unit::In => 0.0254,
        }
    }
}

/// The convention of quality.
#[derive(Clone, Debug, Args)]
pub(crate) struct ConventionOptions {
    /// Convention: paper, graspit, dexnet, frogger, openrave or unit. Default: that of the grasps.json
    /// for `quality`, otherwise paper.
    #[arg(long, value_name = "NAME")]
    pub(crate) convention: Option<String>,
    /// Friction coefficient, instead of the convention's.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) friction: Option<f64>,
    /// Number of edges of the friction cone, or `round`, instead of the convention's.
    #[arg(long)]
    pub(crate) edges: Option<String>,
    /// Length by which torques are divided, metres, instead of the convention's.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) torque_length: Option<f64>,
    /// Width to which the interval of a round cone's quality is narrowed.
    #[arg(long, default_value_t = 1e-4)]
    pub(crate) tolerance: f64,
}
