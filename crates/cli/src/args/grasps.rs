//! Options of the commands on grasps without a hand.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use hand::TipModel;
use serde::Serialize;

use super::contact::contact_option;
use super::{ConventionOptions, HandOptions, ReadingOptions};

#[derive(Debug, Args)]
pub(crate) struct QualityOptions {
    /// The grasps: a grasps.json; rows of 6m+3 numbers in .npy or .csv for m contacts: the positions, the
    /// inward unit normals, and the point about which torques are taken; or an isaac_grasp YAML, with
    /// --shape and --hand. `-` for standard input.
    pub(crate) grasps: PathBuf,
    /// Also compute volume, L-infinity, min-weight, least friction, smallest singular value and the
    /// normal force per load, one named column each.
    #[arg(long, conflicts_with_all = ["metric", "certificate"])]
    pub(crate) all: bool,
    /// The measure of quality.
    #[arg(long, value_enum, default_value_t = Metric::Epsilon)]
    pub(crate) metric: Metric,
    /// Contact model: `point`, `soft:RADIUS` (a disc under uniform pressure, with torsion 2/3 μ RADIUS) or
    /// `patch:RADIUS` (four point contacts on a square pad). RADIUS in metres. By default the model of
    /// the file, `point` where it has none.
    #[arg(long, value_parser = contact_option)]
    pub(crate) contact: Option<TipModel>,
    /// The object of an isaac_grasp YAML: a shape file, as `moduli fit` writes it. The contacts are the
    /// points of its surface within 5 mm of the tips of the hand.
    #[arg(long)]
    pub(crate) shape: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) hand: HandOptions,
    /// A scan of the object, in the frame of the grasps. With `--all` it adds the columns
    /// robust_quality, distance_to_cloud_m and normal_spread_deg, measured within 5 mm of each contact.
    #[arg(long, value_name = "SCAN", requires = "all")]
    pub(crate) cloud: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) reading: ReadingOptions,
    /// File for the proofs of the intervals of epsilon quality, as JSON.
    #[arg(long, value_name = "FILE")]
    pub(crate) certificate: Option<PathBuf>,
    /// File for the result, one row per grasp: quality, lower and upper bound, or all columns with
    /// `--all`. A name that ends in .csv gives a table with a header, any other one an .npy array.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
}

/// What `quality` measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Metric {
    /// Radius of the largest ball about 0 in the hull of all wrenches, with a proved interval.
    Epsilon,
    /// The same if the force of each contact is bounded separately instead of their sum.
    Linf,
    /// The largest weight that every edge can have in an equilibrium (polygonal cones only).
    MinWeight,
    /// The least friction coefficient at which the grasp is force-closed.
    FrictionNeeded,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum AscentScheme {
    /// A bundle method with analytic gradients, which never lowers the quality.
    Ours,
    /// The paper's scheme: 1,000 fixed steps along forward differences.
    Paper,
}

/// The convention and the files of the result.
#[derive(Debug, Args)]
pub(crate) struct MoveOptions {
    /// File for the resulting grasps, as grasps.json in the frame of the cloud of their shape.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// File for every step of every grasp, as JSON.
    #[arg(long)]
    pub(crate) trace: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
}

/// Constraints on every grasp.
#[derive(Debug, Args)]
pub(crate) struct LimitOptions {
    /// Least distance between any two contacts, millimetres.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub(crate) separation: Option<f64>,
    /// Largest distance between any two contacts, millimetres.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub(crate) reach: Option<f64>,
    /// Region of the surface that contacts may touch: those seen from the centre within DEGREES of the
    /// direction X,Y,Z. If given several times, contacts must lie in all regions.
    #[arg(long, value_name = "X,Y,Z,DEGREES", allow_hyphen_values = true)]
    pub(crate) allow: Vec<String>,
    /// Grasps must stay force-closed under this smaller friction coefficient.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) closed_at_friction: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct AscendOptions {
    /// A shape file, as `moduli fit` writes it.
    pub(crate) shape: PathBuf,
    /// A grasps.json in the frame of the shape's cloud. Contacts are projected to the surface along
    /// their direction from the centre.
    pub(crate) grasps: PathBuf,
    /// Method of the ascent.
    #[arg(long, value_enum, default_value_t = AscentScheme::Ours)]
    pub(crate) scheme: AscentScheme,
    #[command(flatten)]
    pub(crate) limits: LimitOptions,
    #[command(flatten)]
    pub(crate) moved: MoveOptions,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TransferScheme {
    /// Adaptive stations, monotone ascents, and a second search if the final quality is low.
    Ours,
    /// The paper's scheme: eleven stations with 100 fixed steps each.
    Paper,
    /// Keep the directions of the contacts, without an ascent.
    Naive,
}

#[derive(Debug, Args)]
pub(crate) struct TransferOptions {
    /// The shape that the grasps are on. Given several times, with one grasps.json per shape, grasps go
    /// from every shape to every other shape of --to; then -o is a folder, and an interrupted run is
    /// resumed.
    #[arg(long, value_name = "SHAPE", required = true)]
    pub(crate) from: Vec<PathBuf>,
    /// The shape that the grasps are transferred to; can be given several times.
    #[arg(long, value_name = "SHAPE", required = true)]
    pub(crate) to: Vec<PathBuf>,
    /// A grasps.json per --from, in the frame of the cloud of that shape.
    #[arg(required = true)]
    pub(crate) grasps: Vec<PathBuf>,
    /// Method of the transfer.
    #[arg(long, value_enum, default_value_t = TransferScheme::Ours)]
    pub(crate) scheme: TransferScheme,
    /// Search for better results even if the first one is good; about seven times slower.
    #[arg(long)]
    pub(crate) thorough: bool,
    #[command(flatten)]
    pub(crate) limits: LimitOptions,
    #[command(flatten)]
    pub(crate) moved: MoveOptions,
}
