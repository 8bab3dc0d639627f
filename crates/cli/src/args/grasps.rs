//! Options of the commands on grasps without a hand.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde::Serialize;

use super::ConventionOptions;

#[derive(Debug, Args)]
pub(crate) struct QualityOptions {
    /// Grasps: grasps.json, or .npy / .csv with 6m+3 columns for m contacts: the positions, the inward
    /// normals, the centre (c1 c2 c3 n1 n2 n3 z for three).
    pub(crate) grasps: PathBuf,
    /// Also compute volume, L-infinity, min-weight, least friction, smallest singular value and the
    /// normal force per load, one named column each.
    #[arg(long, conflicts_with_all = ["metric", "contact", "certificate"])]
    pub(crate) all: bool,
    /// What is measured. `friction-needed` is the least friction under which a grasp is closed.
    #[arg(long, value_enum, default_value_t = Metric::Epsilon)]
    pub(crate) metric: Metric,
    /// Contact model: `point`, `soft:RADIUS` (a disc under even pressure, with torsion 2/3 μ RADIUS) or
    /// `patch:RADIUS` (four point contacts on a square pad). RADIUS in metres.
    #[arg(long, default_value = "point", value_parser = contact_option)]
    pub(crate) contact: ContactOption,
    /// The proof of every interval of epsilon quality, as JSON.
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
    /// The largest ball in the hull of all wrenches, with a proved interval.
    Epsilon,
    /// The same where every contact has a force of its own.
    Linf,
    /// The largest least weight of a balance (polygonal cones).
    MinWeight,
    /// The least friction coefficient under which the grasp is closed.
    FrictionNeeded,
}

/// A contact model and its size in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ContactOption {
    Point,
    Soft(f64),
    Patch(f64),
}

fn contact_option(text: &str) -> Result<ContactOption, String> {
    let radius = |text: &str| {
        let radius = text.parse::<f64>().ok();
        radius
            .filter(|r| r.is_finite() && *r > 0.0)
            .ok_or_else(|| format!("`{text}` is no radius; expected metres above 0"))
    };
    match text.split_once(':') {
        None if text == "point" => Ok(ContactOption::Point),
        Some(("soft", size)) => radius(size).map(ContactOption::Soft),
        Some(("patch", size)) => radius(size).map(ContactOption::Patch),
        _ => Err("expected `point`, `soft:RADIUS` or `patch:RADIUS`".to_owned()),
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum AscentScheme {
    /// Monotone, from analytic gradients of all deciding facets.
    Ours,
    /// 1,000 fixed steps along forward differences.
    Paper,
}

/// Under which convention grasps are moved, and where the result goes.
#[derive(Debug, Args)]
pub(crate) struct MoveOptions {
    /// The grasps where they ended, as grasps.json in the frame of the cloud of their shape.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Every step of every grasp, as JSON.
    #[arg(long)]
    pub(crate) trace: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
}

/// What every grasp must keep.
#[derive(Debug, Args)]
pub(crate) struct LimitOptions {
    /// Least distance between any two contacts, millimetres.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub(crate) separation: Option<f64>,
    /// Largest distance between any two contacts, millimetres.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub(crate) reach: Option<f64>,
    /// Part of the surface that contacts may touch: X,Y,Z,DEGREES, the cone around a direction from
    /// the centre. Several: in all of them.
    #[arg(long, value_name = "X,Y,Z,DEGREES", allow_hyphen_values = true)]
    pub(crate) allow: Vec<String>,
    /// Grasps must be closed under this smaller friction too.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) closed_at_friction: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct AscendOptions {
    /// A shape that `fit` wrote.
    pub(crate) shape: PathBuf,
    /// grasps.json in the frame of the shape's cloud; contacts are projected to the surface.
    pub(crate) grasps: PathBuf,
    #[arg(long, value_enum, default_value_t = AscentScheme::Ours)]
    pub(crate) scheme: AscentScheme,
    #[command(flatten)]
    pub(crate) limits: LimitOptions,
    #[command(flatten)]
    pub(crate) moved: MoveOptions,
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
    /// The shape that the grasps are on. Several, each with its grasps: from every one to every
    /// other shape of --to, and -o is a folder, in which an interrupted run goes on.
    #[arg(long, value_name = "SHAPE", required = true)]
    pub(crate) from: Vec<PathBuf>,
    /// The shape that they are carried to; several as with --from.
    #[arg(long, value_name = "SHAPE", required = true)]
    pub(crate) to: Vec<PathBuf>,
    /// grasps.json in the frame of the cloud of the shape they are on; as many as --from.
    #[arg(required = true)]
    pub(crate) grasps: Vec<PathBuf>,
    #[arg(long, value_enum, default_value_t = TransferScheme::Ours)]
    pub(crate) scheme: TransferScheme,
    /// Look for better ends even where the first is good; some seven times slower.
    #[arg(long)]
    pub(crate) thorough: bool,
    #[command(flatten)]
    pub(crate) limits: LimitOptions,
    #[command(flatten)]
    pub(crate) moved: MoveOptions,
}
