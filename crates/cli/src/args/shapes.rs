//! Options of the commands on clouds and shapes.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{CloudOptions, count_in};

/// The kind of surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Model {
    /// A radius per direction from the mean of the cloud; the object must be star-shaped.
    Radial,
    /// A map of the sphere into space, for given sphere coordinates of the points.
    Spherical,
}

#[derive(Debug, Args)]
pub(crate) struct FitOptions {
    /// Clouds or meshes.
    #[arg(required = true)]
    pub(crate) clouds: Vec<PathBuf>,
    /// Where to write the shape; a folder when there are several clouds.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Kind of surface.
    #[arg(long, value_enum, default_value_t = Model::Radial)]
    pub(crate) model: Model,
    /// For the spherical model: the place of each point on the sphere, as unit vectors, N×3 in .npy.
    #[arg(long, value_name = "U.npy")]
    pub(crate) directions: Option<PathBuf>,
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

#[derive(Debug, Args)]
pub(crate) struct InfoOptions {
    /// A shape, a library, grasps.json or a cloud.
    pub(crate) file: PathBuf,
}
