//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

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

#[derive(Debug, Args)]
pub(crate) struct FitOptions {
    /// Clouds or meshes.
    #[arg(required = true)]
    pub(crate) clouds: Vec<PathBuf>,
    /// Where to write the shape; a folder when there are several clouds.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) cloud: CloudOptions,
}

#[derive(Debug, Args)]
pub(crate) struct EvalOptions {
    /// A shape that `fit` wrote.
    pub(crate) shape: PathBuf,
    /// Directions, N×3 in .npy; unit vectors.
    #[arg(long)]
    pub(crate) directions: PathBuf,
    /// Result, N×7 in .npy: radius, tangential gradient of the radius, outward unit normal.
    #[arg(short, long)]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct MeshOptions {
    /// A shape that `fit` wrote.
    pub(crate) shape: PathBuf,
    /// The mesh, as PLY, in the frame of the cloud.
    #[arg(short, long)]
    pub(crate) output: PathBuf,
    /// Circles of latitude.
    #[arg(long, default_value_t = 100, value_parser = count_in::<3, 4000>)]
    pub(crate) rows: usize,
    /// Points on each.
    #[arg(long, default_value_t = 100, value_parser = count_in::<3, 4000>)]
    pub(crate) columns: usize,
}

#[derive(Debug, Args)]
pub(crate) struct DistanceOptions {
    /// Shapes that `fit` wrote; with one, its distances to the built-in library.
    #[arg(required = true)]
    pub(crate) shapes: Vec<PathBuf>,
}

#[derive(Clone, Debug, Args)]
pub(crate) struct ConventionOptions {
    /// paper, graspit, dexnet, frogger, openrave or unit.
    #[arg(long, default_value = "paper")]
    pub(crate) convention: String,
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

#[derive(Debug, Args)]
pub(crate) struct QualityOptions {
    /// Grasps: grasps.json, or .npy / .csv with 21 columns c1 c2 c3 n1 n2 n3 z.
    pub(crate) grasps: PathBuf,
    /// Result, N×3 in .npy: quality, lower, upper.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum AscentScheme {
    /// Monotone, from analytic gradients of all deciding facets.
    Ours,
    /// 1,000 fixed steps along forward differences.
    Paper,
}

#[derive(Debug, Args)]
pub(crate) struct AscendOptions {
    /// A shape that `fit` wrote.
    pub(crate) shape: PathBuf,
    /// grasps.json in the frame of the shape's cloud; contacts are projected to the surface.
    pub(crate) grasps: PathBuf,
    /// The improved grasps, as grasps.json.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Every step of every grasp, as JSON.
    #[arg(long)]
    pub(crate) trace: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = AscentScheme::Ours)]
    pub(crate) scheme: AscentScheme,
    /// Least distance between any two contacts, metres.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) least_separation: Option<f64>,
    /// Largest distance between any two contacts, metres.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) reach: Option<f64>,
    /// Part of the surface that contacts may touch: X,Y,Z,DEGREES, the cone around a direction from
    /// the centre. Several: in all of them.
    #[arg(long, value_name = "X,Y,Z,DEGREES", allow_hyphen_values = true)]
    pub(crate) allow: Vec<String>,
    /// Grasps must be closed under this smaller friction too.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) closed_at_friction: Option<f64>,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TransferScheme {
    /// Adaptive stations, monotone ascents, recovery from poor ends.
    Ours,
    /// Eleven stations with 100 fixed steps each.
    Paper,
    /// The contacts keep their directions.
    Naive,
}

#[derive(Debug, Args)]
pub(crate) struct TransferOptions {
    /// The shape that the grasps are on.
    #[arg(long)]
    pub(crate) from: PathBuf,
    /// The shape that they are carried to.
    #[arg(long)]
    pub(crate) to: PathBuf,
    /// grasps.json in the frame of the first shape's cloud.
    pub(crate) grasps: PathBuf,
    /// The grasps on the second shape, as grasps.json in the frame of its cloud.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Every step of every grasp, as JSON.
    #[arg(long)]
    pub(crate) trace: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = TransferScheme::Ours)]
    pub(crate) scheme: TransferScheme,
    /// Look for better ends even where the first is good; some seven times slower.
    #[arg(long)]
    pub(crate) thorough: bool,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
}

#[derive(Debug, Args)]
pub(crate) struct GraspOptions {
    /// A cloud; by default a built-in object that is in no library.
    pub(crate) cloud: Option<PathBuf>,
    /// Folder for grasps.json and index.html; out/NAME by default.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) fit: CloudOptions,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
    /// Library objects to transfer from, the nearest first.
    #[arg(long, default_value_t = 3, value_parser = count_in::<0, 1000>)]
    pub(crate) neighbours: usize,
    /// Grasps to transfer from each of them.
    #[arg(long, default_value_t = 4, value_parser = count_in::<0, 1000>)]
    pub(crate) transfers: usize,
    /// Hand poses to try afresh.
    #[arg(long, default_value_t = 700, value_parser = count_in::<0, 1_000_000>)]
    pub(crate) poses: usize,
    /// Starts of the search for a hand that reaches a transferred grasp; 0 for none.
    #[arg(long, default_value_t = 12, value_parser = count_in::<0, 10_000>)]
    pub(crate) reach_starts: usize,
    /// Grasps to keep of each kind.
    #[arg(long, default_value_t = 12, value_parser = count_in::<1, 10_000>)]
    pub(crate) keep: usize,
}

#[derive(Debug, Args)]
pub(crate) struct InfoOptions {
    /// A shape, a library, grasps.json or a cloud.
    pub(crate) file: PathBuf,
}
