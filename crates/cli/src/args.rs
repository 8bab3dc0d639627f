//! The command line.

mod grasps;
mod hands;
mod shapes;

use clap::{Args, Parser, Subcommand, ValueEnum};

pub(crate) use grasps::{
    AscendOptions, AscentScheme, ContactOption, LimitOptions, Metric, MoveOptions, QualityOptions,
    TransferOptions, TransferScheme,
};
pub(crate) use hands::{
    GraspOptions, HandCheckOptions, HandCommand, HandOptions, SynthesizeOptions,
};
pub(crate) use shapes::{
    DistanceOptions, EvalOptions, FitOptions, InfoOptions, MeshOptions, Model,
};

/// From a scan to grasps: smooth surfaces, certified quality, transfer between objects.
#[derive(Debug, Parser)]
#[command(name = "moduli", version, about, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) common: Common,
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// Options of every command.
#[derive(Debug, Args)]
pub(crate) struct Common {
    /// Print results as JSON on standard output.
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Threads to use; all cores by default.
    #[arg(long, global = true, value_parser = count_in::<1, 1024>)]
    pub(crate) threads: Option<usize>,
    /// Seed of everything random; the same seed gives the same bytes.
    #[arg(long, global = true, default_value_t = 0)]
    pub(crate) seed: u64,
    /// No progress on standard error.
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Fit smooth surfaces to clouds and prove them valid.
    Fit(FitOptions),
    /// Radius, gradient and normal of a shape at given directions.
    Eval(EvalOptions),
    /// Write a shape as a triangle mesh.
    Mesh(MeshOptions),
    /// Distances between shapes in the space of radial functions.
    Distance(DistanceOptions),
    /// Quality of given grasps.
    Quality(QualityOptions),
    /// Improve grasps on their object.
    Ascend(AscendOptions),
    /// Carry grasps from one object to another.
    Transfer(TransferOptions),
    /// Grasps of a hand on a shape, found afresh.
    Synthesize(SynthesizeOptions),
    /// Hands of your own.
    #[command(subcommand)]
    Hand(HandCommand),
    /// All of it: a cloud of an object never seen before, ranked grasps and a picture.
    Grasp(GraspOptions),
    /// What a file of ours holds.
    Info(InfoOptions),
}

/// A whole number between LOW and HIGH.
fn count_in<const LOW: usize, const HIGH: usize>(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if (LOW..=HIGH).contains(&count) => Ok(count),
        _ => Err(format!("expected a whole number from {LOW} to {HIGH}")),
    }
}

/// How clouds are read and fitted.
#[derive(Clone, Debug, Args)]
pub(crate) struct CloudOptions {
    /// Unit of the coordinates in the file.
    #[arg(long, value_enum, default_value_t = Unit::M)]
    pub(crate) unit: Unit,
    /// Points taken from a mesh, spread by area.
    #[arg(long, default_value_t = 25_000, value_parser = count_in::<100, 10_000_000>)]
    pub(crate) samples: usize,
    /// Highest degree of the harmonics.
    #[arg(long, default_value_t = 50, value_parser = count_in::<0, 150>)]
    pub(crate) degree: usize,
    /// Weight of the penalty; chosen from the data by default.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) lambda: Option<f64>,
    /// Smooth the surface by heat flowing for this time (0.001 softens edges): details narrower than
    /// about its square root, in radians, go.
    #[arg(long, value_name = "SIGMA", allow_negative_numbers = true)]
    pub(crate) heat: Option<f64>,
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

#[derive(Clone, Debug, Args)]
pub(crate) struct ConventionOptions {
    /// paper, graspit, dexnet, frogger, openrave or unit [default: paper; for `quality`, the convention
    /// that the file names].
    #[arg(long)]
    pub(crate) convention: Option<String>,
    /// Friction coefficient in place of the convention's.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) friction: Option<f64>,
    /// Edges of the friction cone: a number, or `round`.
    #[arg(long)]
    pub(crate) edges: Option<String>,
    /// Length that divides torques, in metres, in place of the convention's.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) torque_length: Option<f64>,
    /// Width of the interval for round cones.
    #[arg(long, default_value_t = 1e-4)]
    pub(crate) tolerance: f64,
}
