//! Options of the commands with a hand.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use hand::TipModel;

use super::contact::contact_option;
use super::shapes::SurfaceChoice;
use super::support::SupportOptions;
use super::{CloudOptions, ConventionOptions, count_in};

/// Which hand.
#[derive(Clone, Debug, Args)]
pub(crate) struct HandOptions {
    /// A built-in hand (`sdh`, the Schunk SDH; `panda`, a parallel gripper of the Franka kind;
    /// `robotiq_2f85`, a gripper of the 2F-85 kind), or the URDF of another hand.
    #[arg(long, value_name = "NAME|URDF", default_value = "sdh")]
    pub(crate) hand: PathBuf,
    /// TOML spec of the hand; by default the one beside the URDF, with the same name.
    #[arg(long, value_name = "TOML")]
    pub(crate) spec: Option<PathBuf>,
    /// Folder in which `package://` meshes are found; by default the folder of the URDF and the
    /// packages that contain it or are next to it.
    #[arg(long, value_name = "DIR")]
    pub(crate) package_root: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct SynthesizeOptions {
    /// A shape file, as `moduli fit` writes it.
    pub(crate) shape: PathBuf,
    /// Folder for grasps.json, grasps.yaml and index.html; out/NAME by default.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) hand: HandOptions,
    /// Number of hand poses to try.
    #[arg(long, default_value_t = 1400, value_parser = count_in::<1, 1_000_000>)]
    pub(crate) poses: usize,
    /// Number of grasps to keep, the best.
    #[arg(long, default_value_t = 50, value_parser = count_in::<1, 1_000_000>)]
    pub(crate) keep: usize,
    /// Quality that a stable grasp must exceed. By default the convention decides: 0.01 under `paper`;
    /// under the others every force-closed grasp is stable.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) least_quality: Option<f64>,
    /// Power grasps: close until every link of a finger touches the object or its joints reach their
    /// limits. Every link that touches is a contact.
    #[arg(long)]
    pub(crate) power: bool,
    /// Range of the distance between the surface and the hand's approach point, millimetres. Default: the
    /// range of the hand's TOML; for power grasps, from 0.7 times its lower end to its lower end.
    #[arg(long, value_name = "MIN,MAX", allow_hyphen_values = true, value_parser = standoff)]
    pub(crate) standoff: Option<(f64, f64)>,
    /// Preshape from which the fingers close; can be given several times. By default all preshapes of
    /// the hand.
    #[arg(long, value_name = "NAME")]
    pub(crate) preshape: Vec<String>,
    /// Contact model of the tips: `point`, `soft:RADIUS` or `patch:RADIUS`, RADIUS in metres. By default
    /// soft fingers of the TOML's pad radius for a hand of two fingers, points for others.
    #[arg(long, value_parser = contact_option)]
    pub(crate) contact: Option<TipModel>,
    #[command(flatten)]
    pub(crate) support: SupportOptions,
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
    /// Check the URDF and the TOML of a hand, and write a page with pictures of it.
    #[command(after_help = "Example: moduli hand check gripper.urdf gripper.toml -o gripper.html")]
    Check(HandCheckOptions),
    /// Write a first TOML for the URDF of a hand: fingers, tips, closing joints with their signs, line of
    /// approach, pre-shapes and exempt pairs, all found from the geometry.
    #[command(
        after_help = "Example: moduli hand init gripper.urdf && moduli grasp scan.ply --hand gripper.urdf"
    )]
    Init(HandInitOptions),
}

#[derive(Debug, Args)]
pub(crate) struct HandInitOptions {
    /// The URDF.
    pub(crate) urdf: PathBuf,
    /// File for the TOML; by default beside the URDF, with the same name, where `--hand` finds it. One that
    /// exists there already is kept.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// The link on which the fingers hang. Default: the link from which the ways to the fingers part.
    #[arg(long, value_name = "LINK")]
    pub(crate) palm: Option<String>,
    /// Folder in which `package://` meshes are found; by default that of the URDF and the packages that
    /// hold it or lie beside it.
    #[arg(long, value_name = "DIR")]
    pub(crate) package_root: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct HandCheckOptions {
    /// The URDF, or the name of a built-in hand: `sdh`, `panda` or `robotiq_2f85`.
    pub(crate) urdf: PathBuf,
    /// TOML spec of the hand; by default the one beside the URDF, with the same name.
    pub(crate) spec: Option<PathBuf>,
    /// Folder in which `package://` meshes are found; by default the folder of the URDF and the
    /// packages that contain it or are next to it.
    #[arg(long, value_name = "DIR")]
    pub(crate) package_root: Option<PathBuf>,
    /// File for the page; out/NAME/hand.html by default.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Contact model of the tips: `point`, `soft:RADIUS` or `patch:RADIUS`, RADIUS in metres. By default
    /// soft fingers of the TOML's pad radius for a hand of two fingers, points for others.
    #[arg(long, value_parser = contact_option)]
    pub(crate) contact: Option<TipModel>,
    /// Diameter of the ball on which the hand is tried, millimetres.
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
    /// Clouds or meshes; by default a built-in object that is not in the library.
    pub(crate) clouds: Vec<PathBuf>,
    /// Folder for grasps.json, grasps.yaml and index.html, out/NAME by default; with several clouds, the
    /// folder that holds a folder per cloud, out by default.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Folder with your own known objects, as `moduli library add` makes it. They are used in
    /// addition to the built-in ones.
    #[arg(long, value_name = "DIR")]
    pub(crate) library: Option<PathBuf>,
    /// Kind of surface.
    #[arg(long, value_enum, default_value_t = SurfaceChoice::Auto)]
    pub(crate) model: SurfaceChoice,
    #[command(flatten)]
    pub(crate) fit: CloudOptions,
    #[command(flatten)]
    pub(crate) hand: HandOptions,
    /// Contact model of the tips: `point`, `soft:RADIUS` or `patch:RADIUS`, RADIUS in metres. By default
    /// soft fingers of the TOML's pad radius for a hand of two fingers, points for others.
    #[arg(long, value_parser = contact_option)]
    pub(crate) contact: Option<TipModel>,
    #[command(flatten)]
    pub(crate) convention: ConventionOptions,
    /// Number of library objects to transfer from, the nearest ones.
    #[arg(long, default_value_t = 3, value_parser = count_in::<0, 1000>)]
    pub(crate) neighbours: usize,
    /// Number of grasps to transfer from each of them.
    #[arg(long, default_value_t = 4, value_parser = count_in::<0, 1000>)]
    pub(crate) transfers: usize,
    /// Number of hand poses to try in the synthesis.
    #[arg(long, default_value_t = 700, value_parser = count_in::<0, 1_000_000>)]
    pub(crate) poses: usize,
    /// Number of random starts of the search for a hand pose that meets the contacts of a transferred
    /// grasp; 0 for no search.
    #[arg(long, default_value_t = 12, value_parser = count_in::<0, 10_000>)]
    pub(crate) reach_starts: usize,
    /// Number of grasps to keep of each kind, transferred and synthesized.
    #[arg(long, default_value_t = 12, value_parser = count_in::<1, 10_000>)]
    pub(crate) keep: usize,
}

/// A format of grasps for other programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportKind {
    /// `isaac_grasp` YAML of Isaac Sim.
    Isaac,
    /// YAML in the fields of the message moveit_msgs/Grasp.
    Moveit,
    /// Arrays of NumPy in one archive.
    Npz,
}

#[derive(Debug, Args)]
pub(crate) struct ExportOptions {
    /// The format.
    pub(crate) kind: ExportKind,
    /// A grasps.json.
    pub(crate) grasps: PathBuf,
    /// File to write.
    #[arg(short, long)]
    pub(crate) output: PathBuf,
}
