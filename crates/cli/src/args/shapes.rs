//! Options of the commands on clouds and shapes.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{CloudOptions, count_in};

/// The kind of surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SurfaceChoice {
    /// Radial where a radius explains the cloud, spherical otherwise.
    Auto,
    /// A radius per direction from the mean of the cloud; the object must be star-shaped.
    Radial,
    /// A map of the sphere into space, for any closed object; handles are closed and reported.
    Spherical,
}

impl From<SurfaceChoice> for moduli::Model {
    fn from(choice: SurfaceChoice) -> Self {
        match choice {
            SurfaceChoice::Auto => Self::Auto,
            SurfaceChoice::Radial => Self::Radial,
            SurfaceChoice::Spherical => Self::Spherical,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct FitOptions {
    /// Clouds or meshes: PLY, PCD, XYZ, CSV, OBJ, STL, OFF, glTF, GLB, NPY or NPZ; `-` for standard
    /// input. The content decides the format.
    #[arg(required = true)]
    pub(crate) clouds: Vec<PathBuf>,
    /// File for the shape, or folder for the shapes of several clouds.
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Kind of surface.
    #[arg(long, value_enum, default_value_t = SurfaceChoice::Auto)]
    pub(crate) model: SurfaceChoice,
    /// For the spherical model: the direction of each point on the sphere, as unit vectors, N×3 in
    /// .npy. Without it the directions are computed.
    #[arg(long, value_name = "U.npy")]
    pub(crate) directions: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) cloud: CloudOptions,
}

#[derive(Debug, Args)]
pub(crate) struct EvalOptions {
    /// A shape file, as `moduli fit` writes it.
    pub(crate) shape: PathBuf,
    /// Directions from the centre: unit vectors, N×3 in .npy.
    #[arg(long)]
    pub(crate) directions: PathBuf,
    /// File for the result, .npy. Radial shapes, N×7: radius, tangential gradient of the radius (3),
    /// outward unit normal (3). Spherical shapes, N×9: point in the frame of the cloud (3), outward unit
    /// normal (3), mean curvature, the two principal curvatures (1/m, positive where convex).
    #[arg(short, long)]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct MeshOptions {
    /// A shape file, as `moduli fit` writes it.
    pub(crate) shape: PathBuf,
    /// File for the mesh, in the frame of the cloud. Its ending decides the format: `.ply`, `.obj`, `.stl`, `.off`
    /// or `.glb`; PLY without an ending.
    #[arg(short, long)]
    pub(crate) output: PathBuf,
    /// Number of circles of latitude.
    #[arg(long, default_value_t = 100, value_parser = count_in::<3, 4000>)]
    pub(crate) rows: usize,
    /// Number of points on each circle of latitude.
    #[arg(long, default_value_t = 100, value_parser = count_in::<3, 4000>)]
    pub(crate) columns: usize,
}

#[derive(Debug, Args)]
pub(crate) struct DistanceOptions {
    /// Shape files. With several: all pairwise distances; with one: its distances to the objects of the
    /// built-in library.
    #[arg(required = true)]
    pub(crate) shapes: Vec<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct InfoOptions {
    /// A shape, a library, a grasps.json, a cloud or a mesh.
    pub(crate) file: PathBuf,
}
