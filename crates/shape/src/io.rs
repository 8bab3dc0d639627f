//! Reading clouds and meshes, and writing meshes. Bytes in, values out; no file is opened here.

mod content;
mod error;
mod geometry;
mod load;
mod lzf;
mod obj;
mod off;
mod pcd;
pub mod ply;
mod ply_error;
mod stl;
mod table_header;
mod text;
mod write;
mod xyz;

pub use error::{Format, LoadError};
pub use geometry::{Geometry, Loaded, Warning};
pub use load::read_cloud;
pub use ply::{PlyPoints, read_ply};
pub use ply_error::PlyError;
pub use write::{MeshFormat, write_mesh, write_ply};
