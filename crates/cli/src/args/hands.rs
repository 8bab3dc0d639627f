//! Options of the commands with a hand.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::{CloudOptions, ConventionOptions, count_in};

/// Which hand.
#[derive(Clone, Debug, Args)]
pub(crate) struct HandOptions {
    /// `sdh`, the built-in Schunk SDH, or the URDF of another hand.
    #[arg(long, value_name = "sdh|URDF", default_value = "sdh")]
    pub(crate) hand: PathBuf,
    /// How the hand is used; by default the TOML beside the URDF, of the same name.
    #[arg(long, value_name = "TOML")]
    pub(crate) spec: Option<PathBuf>,
    /// Folder of `package://` meshes; by default that of the URDF.
    #[arg(long, value_name = "DIR")]
    pub(crate) package_root: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct SynthesizeOptions {
    /// A shape that `fit` wrote.
    pub(crate) shape: PathBuf,
    /// Folder for grasps.json, grasps.yaml and index.html; out/NAME by default.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) hand: HandOptions,
    /// Hand poses to try.
    #[arg(long, default_value_t = 1400, value_parser = count_in::<1, 1_000_000>)]
    pub(crate) poses: usize,
    /// Grasps to keep, the best.
    #[arg(long, default_value_t = 50, value_parser = count_in::<1, 1_000_000>)]
    pub(crate) keep: usize,
    /// Quality below which a grasp counts as unstable. When absent, the convention decides: 0.01
    /// under `paper`; under the others every force-closed grasp is stable.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) least_quality: Option<f64>,
    /// Power grasps: close past the tips until every link of a finger holds the object or its joints
    /// are at their limits; all links that touch are contacts.
    #[arg(long)]
    pub(crate) power: bool,
    /// Distances from the surface to the hand's approach point to draw from, millimetres; by default
    /// those of the hand's TOML, and for power grasps, which begin nearer, 0.7 of the least to the least.
    #[arg(long, value_name = "MIN,MAX", allow_hyphen_values = true, value_parser = standoff)]
    pub(crate) standoff: Option<(f64, f64)>,
    /// Pre-shape to close from; several: any of them. By default all of the hand.
    #[arg(long, value_name = "NAME")]
    pub(crate) preshape: Vec<String>,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
}

/// MIN,MAX in millimetres, as metres.
fn standoff(text: &str) -> Result<(f64, f64), String> {
    let millimetre = |cell: &str| cell.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    text.split_once(',')
        .and_then(|(low, high)| Some((1e-3 * millimetre(low)?, 1e-3 * millimetre(high)?)))
        .filter(|(low, high)| low <= high)
        .ok_or_else(|| "expected MIN,MAX in millimetres, MIN at most MAX".to_owned())
}

#[derive(Debug, Subcommand)]
pub(crate) enum HandCommand {
    /// What is wrong with a URDF and its TOML, and a page with pictures of the hand.
    Check(HandCheckOptions),
}

#[derive(Debug, Args)]
pub(crate) struct HandCheckOptions {
    /// The URDF, or `sdh`.
    pub(crate) urdf: PathBuf,
    /// The TOML; by default the one beside the URDF, of the same name.
    pub(crate) spec: Option<PathBuf>,
    /// Folder of `package://` meshes; by default that of the URDF.
    #[arg(long, value_name = "DIR")]
    pub(crate) package_root: Option<PathBuf>,
    /// The page; out/NAME/hand.html by default.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Diameter of the ball that the hand is tried on, millimetres.
    #[arg(
        long,
        value_name = "MM",
        default_value_t = 70.0,
        allow_negative_numbers = true
    )]
    pub(crate) ball: f64,
}

#[derive(Debug, Args)]
pub(crate) struct GraspOptions {
    /// A cloud; by default a built-in object that is in no library.
    pub(crate) cloud: Option<PathBuf>,
    /// Folder for grasps.json, grasps.yaml and index.html; out/NAME by default.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) fit: CloudOptions,
    #[command(flatten)]
    pub(crate) hand: HandOptions,
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
